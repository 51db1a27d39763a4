// How far a motion in a tube can come in a given time at most, by linear programming: what no planner beats.
// The programs that use it know how to make losses of time of it.
#pragma once

#include <Clp_C_Interface.h>

#include <Eigen/Core>
#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <limits>
#include <memory>
#include <numbers>
#include <utility>
#include <vector>

#include "cncplan/core/limits.hpp"

namespace cncplan::test {

/// What is within the tolerance of a stretch between two points; a stretch of no length is a point.
struct Tube {
  Eigen::Vector2d from, to;
};

/// A time in a tube, cut into cells of equal times; or in none.
struct TubePhase {
  Tube tube;
  double time{};  // s
  int cells{};
  bool inside = true;
};

/// Unknown are position, velocity and acceleration at the nodes between cells. All that is asked of them
/// holds for *every* motion within the limits, whatever its jerk does inside a cell:
///  - |v| <= V, |a| <= A and the distance from the tube's line <= tolerance at the nodes;
///  - in a cell, for all weights w of s = (time left in it) / h and all directions d,
///        integral of w d.j ds <= J integral of |w| ds,
///    whose left side is linear in the states at both ends if w is quadratic:
///        1: (a1 - a0) / h    s: (v1 - v0 - h a0) / h^2    s^2: 2 (p1 - p0 - h v0 - h^2 a0 / 2) / h^3;
///  - the same of a and A, with linear w, and of v and V, with w = 1.
/// So the largest distance of the linear program is never below that of a motion. Tangents to the circles,
/// and weights, come in where the last solution breaks them. The value that is given back is a sum over the
/// multipliers that needs no trust in the solver: weak duality, with all that they leave over times its
/// range.
class MotionBound {
 public:
  enum class Of { position, velocity, acceleration };

  MotionBound(const Limits& limits, double tolerance, const std::vector<TubePhase>& phases)
      : model_(Clp_newModel()) {
    Clp_setLogLevel(model_.get(), 0);
    Clp_scaling(model_.get(), 0);  // units do that; with Clp's own it finds possible motions impossible
    double time = 0;
    int cells = 0;
    for (const TubePhase& phase : phases) {
      time += phase.time;
      cells += phase.cells;
    }
    time_unit_ = time / cells;
    length_unit_ = limits.jerk * std::pow(time_unit_, 3);
    tolerance_ = tolerance / length_unit_;
    velocity_ = limits.velocity * time_unit_ / length_unit_;
    acceleration_ = limits.acceleration * time_unit_ * time_unit_ / length_unit_;
    for (const TubePhase& phase : phases) {
      const int first = static_cast<int>(steps_.size());
      for (int i = 0; i < phase.cells; ++i) steps_.push_back(phase.time / phase.cells / time_unit_);
      if (phase.inside)
        for (int i = 0; i <= phase.cells; ++i) stay(first + i, phase.tube);
    }
    add_columns(velocity_ * time / time_unit_ + tolerance_, phases.back().tube.to / length_unit_);
    for (std::size_t cell = 0; cell < steps_.size(); ++cell)
      for (const Rule& rule : rules_of(steps_[cell], {0, 1}))
        for (int i = 0; i < 8; ++i) {
          const double at = std::numbers::pi * i / 4;
          add_cut(cell, rule, {std::cos(at), std::sin(at)});
        }
  }

  [[nodiscard]] int nodes() const { return static_cast<int>(steps_.size()) + 1; }

  /// The node is in a tube, beside that of its phase.
  void stay(int node, const Tube& tube) {
    tubes_.push_back({node, {tube.from / length_unit_, tube.to / length_unit_}});
  }

  /// The component of a state along a direction.
  void fix(int node, Of what, const Eigen::Vector2d& direction, double value) {
    const double unit = length_unit_ / std::pow(time_unit_, static_cast<int>(what));
    const int column = column_of(node, what);
    add_row({{column, direction[0]}, {column + 1, direction[1]}}, value / unit, value / unit);
  }

  /// mm. No motion has its first node farther along a direction; -infinity: no motion does it in this time.
  double farthest_start(const Eigen::Vector2d& direction) {
    constexpr int rounds = 60, patience = 4;
    constexpr double gain = 1e-5;  // of cells that the jerk limit makes, a round
    cost_.assign(static_cast<std::size_t>(columns()), 0);
    cost_[0] = direction[0];
    cost_[1] = direction[1];
    std::vector<double> least_of(cost_);
    for (double& c : least_of) c = -c;
    Clp_chgObjCoefficients(model_.get(), least_of.data());
    double least = infinite;
    for (int round = 0, idle = 0; round < rounds && idle < patience; ++round) {
      send_rows();
      Clp_dual(model_.get(), 0);
      if (Clp_status(model_.get()) == 1 && impossible()) return -std::numeric_limits<double>::infinity();
      const double value = dual_value(Clp_dualRowSolution(model_.get()), -1, cost_);
      idle = value < least - gain ? 0 : idle + 1;
      least = std::min(least, value);
      if (Clp_status(model_.get()) != 0 || !cut()) break;
    }
    return least * length_unit_;
  }

 private:
  /// A sum of the six states at the ends of a cell, no longer than 1 as a vector.
  using Rule = std::array<double, 6>;
  struct Term {
    int column;
    double value;
  };

  int column_of(int node, Of what) const { return 6 * node + 2 * static_cast<int>(what); }
  int columns() const { return 6 * nodes(); }

  // Boxes that hold every motion: of positions round the end, which is within the tolerance of its tube.
  void add_columns(double reach, const Eigen::Vector2d& end) {
    const double far = reach + tolerance_;
    for (int node = 0; node < nodes(); ++node)
      for (int i = 0; i < 6; ++i) {
        const double half = i < 2 ? far : i < 4 ? velocity_ : acceleration_;
        lower_.push_back((i < 2 ? end[i] : 0) - half);
        upper_.push_back((i < 2 ? end[i] : 0) + half);
      }
    const std::vector<double> zero(lower_.size(), 0);
    const std::vector<CoinBigIndex> starts(lower_.size() + 1, 0);
    Clp_addColumns(model_.get(), columns(), lower_.data(), upper_.data(), zero.data(), starts.data(), nullptr,
                   nullptr);
  }

  // Of weights with roots on a grid: where w changes its sign, the jerk that it bounds most tightly does.
  std::vector<Rule> rules_of(double h, const std::vector<double>& roots) const {
    std::vector<Rule> all;
    const auto add = [&](double c0, double c1, double c2, double first, double second) {
      double area = 0;
      const auto integral = [&](double s) { return s * (c0 + s * (c1 / 2 + s * c2 / 3)); };
      const std::array<double, 4> at{0, first, second, 1};
      for (std::size_t i = 0; i < 3; ++i) area += std::abs(integral(at[i + 1]) - integral(at[i]));
      const double j = 1 / area, a = 1 / (area * acceleration_), h2 = h * h, h3 = h2 * h;
      all.push_back({-2 * c2 * j / h3, -(c1 + 2 * c2) * j / h2, -(c0 + c1 + c2) * j / h, 2 * c2 * j / h3,
                     c1 * j / h2, c0 * j / h});
      if (c2 == 0) all.push_back({-c1 * a / h2, -(c0 + c1) * a / h, 0, c1 * a / h2, c0 * a / h, 0});
    };
    all.push_back({-1 / (h * velocity_), 0, 0, 1 / (h * velocity_), 0, 0});
    add(1, 0, 0, 0, 0);
    for (std::size_t i = 0; i < roots.size(); ++i) {
      add(-roots[i], 1, 0, roots[i], roots[i]);
      for (std::size_t k = i; k < roots.size(); ++k)
        add(roots[i] * roots[k], -roots[i] - roots[k], 1, roots[i], roots[k]);
    }
    return all;
  }

  void add_cut(std::size_t cell, const Rule& rule, const Eigen::Vector2d& direction) {
    std::vector<Term> terms;
    for (int i = 0; i < 12; ++i)
      terms.push_back(
          {6 * static_cast<int>(cell) + i, rule[static_cast<std::size_t>(i / 2)] * direction[i % 2]});
    add_row(terms, -infinite, 1);
  }

  void add_row(const std::vector<Term>& terms, double lower, double upper) {
    for (const Term& term : terms) {
      column_.push_back(term.column);
      value_.push_back(term.value);
    }
    start_.push_back(static_cast<CoinBigIndex>(column_.size()));
    row_lower_.push_back(lower);
    row_upper_.push_back(upper);
  }

  void send_rows() {
    const std::size_t known = static_cast<std::size_t>(Clp_numberRows(model_.get()));
    const std::size_t count = row_upper_.size() - known;
    std::vector<CoinBigIndex> starts;
    for (std::size_t i = known; i <= row_upper_.size(); ++i) starts.push_back(start_[i] - start_[known]);
    const auto from = static_cast<std::size_t>(start_[known]);
    Clp_addRows(model_.get(), static_cast<int>(count), row_lower_.data() + known, row_upper_.data() + known,
                starts.data(), column_.data() + from, value_.data() + from);
  }

  // c.x <= y.(A x) + (c - y A).x, each at the worse end of its range, for any y.
  double dual_value(const double* multipliers, double sign, std::vector<double> left) const {
    double sum = 0;
    for (std::size_t i = 0; i < row_upper_.size(); ++i) {
      double y = sign * multipliers[i];
      if (!(row_lower_[i] > -infinite)) y = std::max(y, 0.0);
      sum += y < 0 ? y * row_lower_[i] : y * row_upper_[i];
      for (auto k = static_cast<std::size_t>(start_[i]); k < static_cast<std::size_t>(start_[i + 1]); ++k)
        left[static_cast<std::size_t>(column_[k])] -= y * value_[k];
    }
    for (std::size_t i = 0; i < left.size(); ++i) sum += std::max(left[i] * lower_[i], left[i] * upper_[i]);
    return sum;
  }

  // Multipliers by which 0 <= a negative number.
  bool impossible() {
    const std::vector<double> nothing(cost_.size(), 0);
    double* const ray = Clp_infeasibilityRay(model_.get());
    if (ray == nullptr) return false;
    const bool proven = dual_value(ray, 1, nothing) < 0 || dual_value(ray, -1, nothing) < 0;
    Clp_freeRay(model_.get(), ray);
    return proven;
  }

  // Adds what the solution breaks; false if nothing.
  bool cut() {
    constexpr double enough = 1e-5;  // of each bound
    const double* const x = Clp_primalColumnSolution(model_.get());
    const std::size_t before = row_upper_.size();
    const auto state = [&](int column) { return Eigen::Vector2d(x[column], x[column + 1]); };
    const auto half_plane = [&](int column, const Eigen::Vector2d& away, double bound) {
      const Eigen::Vector2d d = away.normalized();
      add_row({{column, d[0]}, {column + 1, d[1]}}, -infinite, bound);
    };
    for (int node = 0; node < nodes(); ++node)
      for (const auto& [what, bound] :
           {std::pair(Of::velocity, velocity_), std::pair(Of::acceleration, acceleration_)}) {
        const Eigen::Vector2d value = state(column_of(node, what));
        if (value.norm() > bound * (1 + enough)) half_plane(column_of(node, what), value, bound);
      }
    for (const auto& [node, tube] : tubes_) {
      const int column = column_of(node, Of::position);
      const Eigen::Vector2d along = tube.to - tube.from;
      const double part =
          along.squaredNorm() > 0 ? (state(column) - tube.from).dot(along) / along.squaredNorm() : 0;
      const Eigen::Vector2d nearest = tube.from + std::clamp(part, 0.0, 1.0) * along;
      Eigen::Vector2d away = state(column) - nearest;
      if (!(away.norm() > tolerance_ * (1 + enough) + 1e-7)) continue;
      if (part > 0 && part < 1) {  // across, exactly
        const Eigen::Vector2d across = Eigen::Vector2d(-along[1], along[0]).normalized();
        away = (across.dot(away) > 0 ? 1 : -1) * across;
      }
      const Eigen::Vector2d d = away.normalized();
      half_plane(column, away, tolerance_ + std::max(d.dot(tube.from), d.dot(tube.to)));
    }
    double known = 0;
    std::vector<Rule> rules;
    for (std::size_t cell = 0; cell < steps_.size(); ++cell) {
      if (std::exchange(known, steps_[cell]) != steps_[cell])
        rules = rules_of(steps_[cell], {0, 0.125, 0.25, 0.375, 0.5, 0.625, 0.75, 0.875, 1});
      const Rule* worst = nullptr;
      Eigen::Vector2d most = Eigen::Vector2d::Zero();
      for (const Rule& rule : rules) {
        Eigen::Vector2d sum = Eigen::Vector2d::Zero();
        for (int i = 0; i < 6; ++i)
          sum += rule[static_cast<std::size_t>(i)] * state(6 * static_cast<int>(cell) + 2 * i);
        if (sum.norm() > std::max(most.norm(), 1 + enough)) {
          most = sum;
          worst = &rule;
        }
      }
      if (worst != nullptr) add_cut(cell, *worst, most.normalized());
    }
    return row_upper_.size() > before;
  }

  static constexpr double infinite = std::numeric_limits<double>::max();  // Clp's word for none
  struct Free {
    void operator()(Clp_Simplex* model) const { Clp_deleteModel(model); }
  };
  std::unique_ptr<Clp_Simplex, Free> model_;
  double time_unit_{}, length_unit_{};  // a mean cell and what the jerk limit makes of it: J = 1
  double tolerance_{}, velocity_{}, acceleration_{};
  std::vector<double> steps_;
  std::vector<std::pair<int, Tube>> tubes_;
  std::vector<double> cost_, lower_, upper_;
  std::vector<double> row_lower_, row_upper_, value_;
  std::vector<int> column_;
  std::vector<CoinBigIndex> start_{0};
};

/// s, of ramps from rest to full speed; half of it is lost beside a run at full speed.
inline double ramp_time(const Limits& limits) {
  const auto& [v, a, j] = limits;
  return a * a < v * j ? v / a + a / j : 2 * std::sqrt(v / j);
}

/// s, lost at a corner between long lines over length / V, by any motion whatever that is within the
/// tolerance of the lines point by point in their order: half of it is before the moment that belongs to the
/// corner, the other half mirrors it in place and time. (A motion and its mirror image have a mean that is a
/// motion as well, as each half lives in one convex tube.) The state a time before the corner, a ramp and a
/// quarter, is free; nothing comes there sooner than by a ramp and full speed. In space it is no faster, as
/// the projection of a motion is one.
inline double corner_bound(const Limits& limits, double tolerance, double turn, int cells) {
  const double time = 1.25 * ramp_time(limits);
  const Eigen::Vector2d corner(0, 0), far(-2 * limits.velocity * time, 0);
  const Eigen::Vector2d along(std::cos(turn / 2), std::sin(turn / 2)), across(-along[1], along[0]);
  MotionBound bound(limits, tolerance, {{{far, corner}, time, cells}});
  bound.stay(cells, {corner, corner});
  bound.fix(cells, MotionBound::Of::position, along, 0);
  bound.fix(cells, MotionBound::Of::velocity, across, 0);
  bound.fix(cells, MotionBound::Of::acceleration, along, 0);
  return 2 * (time - bound.farthest_start({-1, 0}) / limits.velocity);
}

/// The same of two corners of 90 degrees, one to each side, `gap` mm apart, if the time from one to the other
/// lies between `shortest` and `longest`: while it may be before or behind its first corner, a motion is in
/// no tube. The second half is the first one turned by 180 degrees, backwards.
inline double pair_bound(const Limits& limits, double tolerance, double gap, double shortest, double longest,
                         int cells) {
  const double time = 1.25 * ramp_time(limits);
  const Eigen::Vector2d corner(0, 0), far(-2 * limits.velocity * time, 0), next(0, gap), middle(0, gap / 2);
  const int between = std::max(4, static_cast<int>(std::lround(cells * shortest / 2 / time)));
  std::vector<TubePhase> phases{{{far, corner}, time, cells}};
  if (longest > shortest) phases.push_back({{far, next}, (longest - shortest) / 2, 1, false});
  phases.push_back({{corner, next}, shortest / 2, between});
  MotionBound bound(limits, tolerance, phases);
  if (!(longest > shortest)) bound.stay(cells, {corner, corner});
  for (const Eigen::Vector2d& direction : {Eigen::Vector2d(1, 0), Eigen::Vector2d(0, 1)}) {
    bound.fix(bound.nodes() - 1, MotionBound::Of::position, direction, direction.dot(middle));
    bound.fix(bound.nodes() - 1, MotionBound::Of::acceleration, direction, 0);
  }
  return 2 * (time + shortest / 2 - bound.farthest_start({-1, 0}) / limits.velocity) - gap / limits.velocity;
}

/// The same whatever the time between the corners is: the parts of its range with the least bounds are halved
/// until none is 3.5 % below the best of their middles: less would take much longer, as a part has no circle
/// round its corner, only both tubes.
inline double pair_bound(const Limits& limits, double tolerance, double gap, int cells) {
  struct Part {
    double bound, shortest, longest;
  };
  const auto above = [](const Part& a, const Part& b) { return a.bound > b.bound; };
  const double least = (gap - 2 * tolerance) / limits.velocity;
  // whoever takes longer between the corners than this loses two ramps there
  const double most = (gap + 2 * tolerance) / limits.velocity + 2 * ramp_time(limits);
  std::vector<Part> parts{{-1, least, most}};
  double reached = std::numeric_limits<double>::infinity();
  for (int i = 0; i < 100 && parts[0].bound < 0.965 * reached; ++i) {
    std::pop_heap(parts.begin(), parts.end(), above);
    const Part part = parts.back();
    parts.pop_back();
    const double middle = (part.shortest + part.longest) / 2;
    reached = std::min(reached, pair_bound(limits, tolerance, gap, middle, middle, cells));
    for (const auto& [shortest, longest] :
         {std::pair(part.shortest, middle), std::pair(middle, part.longest)}) {
      parts.push_back({pair_bound(limits, tolerance, gap, shortest, longest, cells), shortest, longest});
      std::push_heap(parts.begin(), parts.end(), above);
    }
  }
  return std::min(parts[0].bound, 2 * ramp_time(limits));
}

}  // namespace cncplan::test
