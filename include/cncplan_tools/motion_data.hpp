// A planned motion as columns of numbers, from which a page finds where everything is at any instant.
#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <optional>
#include <vector>

#include "cncplan/core/vector.hpp"
#include "cncplan/junction/geometry.hpp"
#include "cncplan_tools/detail/driven.hpp"
#include "cncplan_tools/detail/grids.hpp"
#include "cncplan_tools/detail/limited_by.hpp"
#include "cncplan_tools/detail/packed.hpp"

namespace cncplan::tools::report {

/// Where a motion of the program stands in its text, and what a machine coordinate lacks to a programmed one.
struct Place {
  int line{};
  junction::Kind kind{};
  Vector3 offset = Vector3::Zero();
};

/// States at instants, from the start to the end.
struct SampleData {
  double period{};  ///< s
  double gap{};     ///< mm or degrees, of positions that the page finds half-way between two instants
  std::vector<float> velocity, acceleration, jerk, wanted;
  std::vector<double> travelled;  ///< mm from the program's start
  std::vector<std::uint32_t> line, offset;
  std::vector<junction::Kind> kind;
  std::vector<LimitedBy> limited_by;
  std::vector<std::uint8_t> direct;  ///< see `Driven::is_direct`
  std::vector<float> axes;           ///< position, velocity, acceleration and jerk of the channels

  /// Bytes of one instant.
  [[nodiscard]] static std::size_t size(std::size_t channels) { return 35 + 16 * channels; }
};

/// Phases drive blocks, whose paths are pieces: see `PhaseColumns` and `PathColumns`.
struct MotionData {
  std::vector<Column> columns;       ///< of phases, blocks and pieces
  std::vector<double> phase_starts;  ///< position in the block, speed, acceleration
  std::vector<double> piece_starts;  ///< position and two derivatives of the channels
  double path_error{};               ///< mm or degrees, by which pieces leave the path at most
  PhaseGrid grid;

  std::vector<double> offsets;  ///< X, Y, Z each
  std::vector<double> wanted;   ///< speeds that the program asks for; not finite where it asks for none
  std::size_t channels = 3;
  double duration{};
  double end_length{};                ///< mm
  std::optional<SampleData> samples;  ///< in place of all columns above where these would be too long

  /// Bytes of its columns.
  [[nodiscard]] std::size_t size() const {
    std::size_t bytes = 8 * (phase_starts.size() + piece_starts.size());
    for (const Column& column : columns) bytes += column.bytes.size();
    return bytes;
  }
};

/// Bytes that a plan's columns may take, and how many phases and pieces a page is quick with.
inline constexpr std::size_t most_bytes = 8'500'000, most_phases = 600'000;

/// The columns of a motion. place_of(block index): its place in the text.
[[nodiscard]] MotionData motion_data(const Driven& driven, const std::function<Place(std::size_t)>& place_of);

}  // namespace cncplan::tools::report
