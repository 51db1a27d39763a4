// The register of an output port: what a timer's interrupt writes to step a machine.
#pragma once

#include <array>
#include <concepts>
#include <cstddef>
#include <cstdint>

#include "cncplan/step/drive.hpp"
#include "cncplan/step/fixed_tick.hpp"

namespace cncplan::step {

/// Levels of the pins of N axes: step signals in bits 0 to N-1, direction signals in bits N to 2N-1. Edges
/// know forward and backward only; here is where a drive with `inverted` gets its direction the other way
/// round.
template <std::size_t N>
  requires(N >= 1 && N <= 16)
class PortRegister {
 public:
  template <std::floating_point S>
  explicit PortRegister(const std::array<BasicDrive<S>, N>& drives) {
    for (std::size_t i = 0; i < N; ++i) inverted_ |= std::uint32_t{drives[i].inverted} << i;
  }

  /// To be written at the tick, a direction set-up time ahead of `high`: directions alone. The same word ends
  /// the pulse.
  [[nodiscard]] std::uint32_t low(const Tick& tick) const {
    return ((tick.directions ^ inverted_) & axes) << N;
  }
  /// The directions and the pulses of the tick.
  [[nodiscard]] std::uint32_t high(const Tick& tick) const { return low(tick) | (tick.steps & axes); }

 private:
  static constexpr std::uint32_t axes = (std::uint32_t{1} << N) - 1;

  std::uint32_t inverted_ = 0;
};

template <std::floating_point S, std::size_t N>
PortRegister(const std::array<BasicDrive<S>, N>&) -> PortRegister<N>;

}  // namespace cncplan::step
