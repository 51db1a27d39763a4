// Smoothed pieces in a program's coordinates as the limits of a machine behind a map see them (set-up).
#pragma once

#include <algorithm>
#include <cstddef>
#include <span>

#include "cncplan/core/jet.hpp"
#include "cncplan/core/motion_limits.hpp"
#include "cncplan/core/path_jets.hpp"
#include "cncplan/detail/speed/enclosed_cell.hpp"
#include "cncplan/detail/speed/speed_cell.hpp"
#include "cncplan/path/cubic.hpp"
#include "cncplan/path/mapped.hpp"

namespace cncplan::detail {

/// The limits of a machine behind a map are those of its joints, and of the tool's vector. So a cell has an
/// axis for each joint and three more for X Y Z of the tool, or as many as there are. The joints' derivatives
/// at the start of a piece are exact, by jets; the third derivative is enclosed along the piece, by jets of
/// intervals. Pieces are halved until what is not known of it takes a small share of the limits at any speed
/// that the place allows; where that is never so, as next to a singular place, the speed is lowered.
template <path::Map M>
class MappedCells {
 public:
  using S = typename M::Scalar;
  static constexpr int coordinates = path::coordinate_count<M>;
  static constexpr int joints = static_cast<int>(M::axis_count);
  static constexpr int space = coordinates < 3 ? coordinates : 3;
  static constexpr int count = joints + space;
  using Cell = BasicSpeedCell<S, count>;
  using Cubic = path::BasicCubic<S, coordinates>;
  using Limits = BasicMotionLimits<S, count>;

  /// The map of each block of a run, and limits as `limits_of` has them. Both are to stay. `along`: limits
  /// along the path, about, all finite; they only set the sizes of cells.
  MappedCells(std::span<const M* const> maps, const Limits& limits, const BasicLimits<S>& along)
      : maps_(maps), limits_(&limits), along_(along) {}

  /// Limits of the axes of cells, from those of the tool and of the joints.
  template <class JointLimits>
  [[nodiscard]] static Limits limits_of(const BasicLimits<S>& tool, const JointLimits& of_joints) {
    Limits limits;
    limits.tool = tool;
    for (int k = 0; k < 3; ++k) limits.tool_axes[static_cast<std::size_t>(k)] = k < space ? joints + k : -1;
    for (std::size_t i = 0; i < of_joints.size(); ++i) limits.axes[i] = of_joints[i];
    return limits;
  }

  [[nodiscard]] BasicLimits<S> along(const Limits&) const { return along_; }

  [[nodiscard]] BasicMotionLimits<S, coordinates> limits_of_curve(const Limits& limits) const {
    BasicMotionLimits<S, coordinates> result;
    result.tool = limits.tool;
    return result;
  }
  /// Adds the joints: by the map's derivatives in the middle of the piece, and what the cell of the piece has
  /// beside them.
  template <class Rows>
  void add_rows(const Cubic& piece, std::size_t block, Rows& rows) const {
    const Cell cell = this->cell(piece, S(1), block);
    const S length = piece.length();
    const auto middle = jets_of(piece.point_at(length / S(2)));
    const std::size_t first = rows.size();
    rows.resize(first + static_cast<std::size_t>(joints));
    for (int k = 0; k < coordinates; ++k) {
      auto along = middle;
      for (int i = 0; i < coordinates; ++i)
        along[static_cast<std::size_t>(i)] = {middle[static_cast<std::size_t>(i)].value, S(i == k ? 1 : 0),
                                              S(0), S(0)};
      const auto by = maps_[block]->joints(along);
      for (std::size_t i = 0; i < static_cast<std::size_t>(joints); ++i) rows[first + i].row[k] = by[i].first;
    }
    for (std::size_t i = 0; i < static_cast<std::size_t>(joints); ++i) {
      auto& row = rows[first + i];
      const auto joint = static_cast<Eigen::Index>(i);
      row.limits = limits_->axes[i];
      for (std::size_t place = 0; place < 3; ++place) {
        const S at = length * static_cast<S>(place) / S(2);
        const auto point = piece.point_at(at);
        row.beside[place] = {cell.first_at(at)[joint] - row.row.dot(point.first),
                             cell.second_at(at)[joint] - row.row.dot(point.second),
                             cell.third[joint] - row.row.dot(point.third)};
      }
    }
  }

  /// What is limited on a piece, with the third derivative that the joints have in its middle.
  [[nodiscard]] Cell cell(const Cubic& piece, S feed, std::size_t block) const {
    Cell cell = start_of(piece, feed, block);
    const auto middle = maps_[block]->joints(jets_of(piece.point_at(piece.length() / S(2))));
    for (int i = 0; i < joints; ++i) cell.third[i] = middle[static_cast<std::size_t>(i)].third;
    return cell;
  }

  /// The same, with an enclosure of that derivative along the piece.
  [[nodiscard]] Cell proven_cell(const Cubic& piece, S feed, std::size_t block) const {
    Cell cell = start_of(piece, feed, block);
    const auto along = maps_[block]->joints(piece.enclosure(S(0), piece.length()));
    for (int i = 0; i < joints; ++i) {
      const auto& third = along[static_cast<std::size_t>(i)].third;
      cell.third[i] = third.low + (third.high - third.low) / S(2);
      cell.spread[i] = (third.high - third.low) / S(2);
    }
    return cell;
  }

  /// Calls `add(part, cell)` for parts of a piece on which the third derivative is well enough known.
  template <class Add>
  void proven_cells(const Cubic& piece, S feed, std::size_t block, Add&& add,
                    int halvings = most_halvings) const {
    Cell cell = proven_cell(piece, feed, block);
    const S known = known_speed(cell, *limits_, unknown);
    if (known >= place_speed(cell, *limits_) || halvings == 0) {
      // What is no number lets nothing move.
      cell.feed = known > S(0) ? std::min(feed, known) : S(0);
      add(piece, cell);
      return;
    }
    const S half = piece.length() / S(2);
    proven_cells(piece.part(S(0), half), feed, block, add, halvings - 1);
    proven_cells(piece.part(half, piece.length()), feed, block, add, halvings - 1);
  }

 private:
  static constexpr int most_halvings = 12;
  static constexpr S unknown = S(0.03);  // share of the limits that a spread may take

  // Without the third derivative of the joints.
  [[nodiscard]] Cell start_of(const Cubic& piece, S feed, std::size_t block) const {
    const auto& at = piece.start();
    Cell cell{piece.length(), feed};
    const auto start = maps_[block]->joints(jets_of(at));
    for (int i = 0; i < joints; ++i) {
      cell.first[i] = start[static_cast<std::size_t>(i)].first;
      cell.second[i] = start[static_cast<std::size_t>(i)].second;
    }
    for (int k = 0; k < space; ++k) {
      cell.first[joints + k] = at.first[k];
      cell.second[joints + k] = at.second[k];
      cell.third[joints + k] = at.third[k];
    }
    return cell;
  }

  std::span<const M* const> maps_;
  const Limits* limits_;
  BasicLimits<S> along_;
};

}  // namespace cncplan::detail
