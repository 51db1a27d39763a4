// A planned motion as a report needs it, whatever its machine and its blocks are.
#pragma once

#include <cstddef>
#include <span>
#include <vector>

#include "cncplan/core/state.hpp"
#include "cncplan/detail/speed/motion_table.hpp"
#include "cncplan_tools/detail/channel_point.hpp"
#include "cncplan_tools/detail/limited_by.hpp"

namespace cncplan::tools::report {

/// Pieces of a path, and the phases that drive them; mm, rad and s.
class Driven {
 public:
  /// `along` counts from the program's start.
  struct Instant {
    std::size_t piece{};
    State along;
  };

  Driven() = default;
  Driven(const Driven&) = delete;
  Driven& operator=(const Driven&) = delete;
  virtual ~Driven() = default;

  [[nodiscard]] virtual double duration() const = 0;
  [[nodiscard]] virtual double length() const = 0;
  [[nodiscard]] virtual std::span<const BasicPiecePhase<double>> phases() const = 0;
  [[nodiscard]] virtual Instant at(double time) const = 0;
  [[nodiscard]] virtual std::size_t piece_count() const = 0;
  [[nodiscard]] virtual double piece_length(std::size_t piece) const = 0;
  /// From the program's start to a piece's, and whether its length is counted so.
  [[nodiscard]] virtual double piece_start(std::size_t piece) const = 0;
  [[nodiscard]] virtual bool counts(std::size_t piece) const = 0;
  /// Whether its axes are driven directly though the machine has a map: the limits of the tool are there
  /// those of the axes X, Y and Z, not of the tip.
  [[nodiscard]] virtual bool is_direct(std::size_t piece) const = 0;
  /// The speed that the program asks for; not finite where it asks for none.
  [[nodiscard]] virtual double requested_speed(std::size_t piece) const = 0;
  /// What stands in the way of a higher speed, of each phase.
  [[nodiscard]] virtual std::vector<LimitedBy> limited_by() const = 0;
  /// The tool and the axes where a piece has been travelled so far.
  [[nodiscard]] virtual ChannelPoint channels(std::size_t piece, double s) const = 0;
};

}  // namespace cncplan::tools::report
