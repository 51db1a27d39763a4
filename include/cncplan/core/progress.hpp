// How far a long work has come, told to whoever waits for it.
#pragma once

#include <optional>

#include "cncplan/core/detail/function_ref.hpp"

namespace cncplan {

/// A part of a long work, by shares of the whole. It tells nobody unless it is given a listener, which must
/// outlive it; what that throws ends the work and goes on to whoever began it.
class Progress {
 public:
  using Listener = FunctionRef<void(double)>;

  Progress() = default;
  explicit Progress(Listener listener) : listener_(listener) {}

  /// So much of the part is done, 0 to 1.
  void reach(double share) const {
    if (listener_) (*listener_)(from_ + share * (to_ - from_));
  }
  /// From one share of it to another one.
  [[nodiscard]] Progress part(double from, double to) const {
    Progress result = *this;
    result.from_ = from_ + from * (to_ - from_);
    result.to_ = from_ + to * (to_ - from_);
    return result;
  }

 private:
  std::optional<Listener> listener_;
  double from_ = 0.0, to_ = 1.0;
};

}  // namespace cncplan
