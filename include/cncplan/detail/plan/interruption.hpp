// Planning that tells how far it is, and ends where it is told to (set-up).
#pragma once

#include <algorithm>
#include <string_view>

#include "cncplan/core/progress.hpp"
#include "cncplan/plan_options.hpp"
#include "cncplan/program_error.hpp"

namespace cncplan::detail {

/// Thrown out of work that is to end; who began it gives the error `interrupted` in its place.
struct Interrupted {
  double share{};  ///< that was done
};

[[nodiscard]] inline ProgramError interrupted(const Interrupted& at, std::string_view work) {
  return {{{ErrorCode::interrupted, work, at.share, 1.0}, 0, 0, {}}};
}

/// Which share of the way from a text to its plan is the reading, about.
[[nodiscard]] constexpr double reading_share(const PlanOptions& options) {
  switch (level_of(options)) {
    case SmoothLevel::exact:
      return 0.7;
    case SmoothLevel::fast:
      return 0.15;
    case SmoothLevel::good:
      return 0.02;
    case SmoothLevel::best:
      return 0.005;
  }
  return 0.0;
}

/// Tells the function of the options of work between two shares of the whole, and throws `Interrupted` where
/// that says so. The options and this are to stay.
class Listening {
 public:
  explicit Listening(const PlanOptions& options, double from = 0.0, double to = 1.0)
      : options_(options), from_(from), to_(to), reached_(from) {}
  Listening(const Listening&) = delete;
  Listening& operator=(const Listening&) = delete;

  /// Work of the same kind begins anew.
  void begin() { reached_ = from_; }

  void operator()(double share) {
    reached_ = std::clamp(share, reached_, 1.0);
    if (!options_.progress(reached_)) throw Interrupted{reached_};
  }
  /// Of the work; tells nobody where the options have no function.
  [[nodiscard]] Progress progress() {
    return options_.progress ? Progress(*this).part(from_, to_) : Progress();
  }

 private:
  const PlanOptions& options_;
  double from_, to_, reached_;
};

}  // namespace cncplan::detail
