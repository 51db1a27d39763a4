// The worst of each error in a run of random cases, with the case that caused it.
#pragma once

#include <cstdio>
#include <span>

namespace cncplan::test {

/// One member of `Errors`, its bound, and the largest that was seen.
template <class Errors, class Case>
struct Worst {
  const char* name;
  double Errors::*member;
  double bound;
  double value = -1.0;
  Case where{};

  void take(const Errors& errors, const Case& here) {
    if (errors.*member <= value) return;
    value = errors.*member;
    where = here;
  }
};

/// Prints a line for each, the case as `literal` says it; whether all bounds hold.
template <class Errors, class Case, class Literal>
bool report(std::span<const Worst<Errors, Case>> all, Literal&& literal) {
  bool held = true;
  for (const auto& worst : all) {
    const bool within = worst.value <= worst.bound;
    held = held && within;
    std::printf("%-32s worst %-10.3g bound %-8.3g %s  %s\n", worst.name, worst.value, worst.bound,
                within ? "ok    " : "BROKEN", literal(worst.where).c_str());
  }
  return held;
}

}  // namespace cncplan::test
