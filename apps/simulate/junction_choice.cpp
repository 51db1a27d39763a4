#include "junction_choice.hpp"

#include <fmt/format.h>

#include <charconv>
#include <cmath>

#include "support/failure.hpp"

namespace simulate {

namespace junction = cncplan::junction;
namespace published = cncplan::published;
using support::Exit;
using support::Failure;

namespace {

[[noreturn]] void refuse(std::string_view item, std::string_view why) {
  throw Failure(Exit::bad_input, fmt::format("--junction: '{}' {}", item, why));
}

double bound(std::string_view item, std::string_view number) {
  double value = 0.0;
  const char* const last = number.data() + number.size();
  const auto [end, code] = std::from_chars(number.data(), last, value);
  if (code != std::errc{} || end != last || !std::isfinite(value))
    refuse(item, "needs a number behind its =");
  if (value < 0.0) refuse(item, "must not be negative");
  return value;
}

JunctionPolicy policy(std::string_view item) {
  const auto equals = item.find('=');
  const std::string_view name = item.substr(0, equals);
  const bool has_number = equals != std::string_view::npos;
  const auto number = [&] { return bound(item, has_number ? item.substr(equals + 1) : std::string_view{}); };
  if (name == "tangent") return junction::TangentStep{number()};
  if (name == "deviation") return junction::Deviation{number()};
  if (name == "acceleration-step") return junction::AccelerationStep{number()};
  if (item == "table") return published::JunctionTable{published::Norm::rotation};
  if (item == "table-absolute") return published::JunctionTable{published::Norm::absolute};
  if (item == "stop") return junction::ExactStop{};
  refuse(item, "is not one of table, table-absolute, stop, tangent=, deviation=, acceleration-step=");
}

}  // namespace

JunctionChoice junction_choice(std::string_view text) {
  JunctionChoice choice;
  for (;;) {
    const auto plus = text.find('+');
    choice.policies.push_back(policy(text.substr(0, plus)));
    if (plus == std::string_view::npos) return choice;
    text.remove_prefix(plus + 1);
  }
}

}  // namespace simulate
