// A planned motion as a report needs it, whatever its machine and its blocks are.
#pragma once

#include <cstddef>
#include <span>
#include <vector>

#include "cncplan/core/state.hpp"
#include "cncplan/plan/motion_table.hpp"
#include "report/channel_point.hpp"
#include "report/limited_by.hpp"

namespace report {

/// Blocks, and the phases that drive them; mm, rad and s.
class Driven {
 public:
  /// `along` counts from the program's start.
  struct Instant {
    std::size_t block{};
    cncplan::State along;
  };

  Driven() = default;
  Driven(const Driven&) = delete;
  Driven& operator=(const Driven&) = delete;
  virtual ~Driven() = default;

  [[nodiscard]] virtual double duration() const = 0;
  [[nodiscard]] virtual double length() const = 0;
  [[nodiscard]] virtual std::span<const cncplan::plan::BasicBlockPhase<double>> phases() const = 0;
  [[nodiscard]] virtual Instant at(double time) const = 0;
  [[nodiscard]] virtual std::size_t block_count() const = 0;
  [[nodiscard]] virtual double block_length(std::size_t block) const = 0;
  /// From the program's start to a block's, or to the end for the block behind the last one.
  [[nodiscard]] virtual double start_length(std::size_t block) const = 0;
  /// The speed that the program asks for; not finite where it asks for none.
  [[nodiscard]] virtual double wanted_speed(std::size_t block) const = 0;
  /// What stands in the way of a higher speed, of each phase.
  [[nodiscard]] virtual std::vector<LimitedBy> limited_by() const = 0;
  /// The tool and the axes where a block has been travelled so far.
  [[nodiscard]] virtual ChannelPoint channels(std::size_t block, double s) const = 0;
};

}  // namespace report
