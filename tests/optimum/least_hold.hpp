// The least time in which a motion along a path comes to rest, by a search: sequential linear programming.
#pragma once

#include <Clp_C_Interface.h>

#include <Eigen/Core>
#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>
#include <memory>
#include <optional>
#include <utility>
#include <vector>

#include "cncplan/core/limits.hpp"
#include "cncplan/core/path_point.hpp"

namespace cncplan::test {

/// Sought are the jerk s''' in steps of equal time, and that time, such that s' and s'' are 0 at the end and
///
///     |q'' v^2 + q' a| <= A    and    |q''' v^3 + 3 q'' v a + q' j| <= J
///
/// at both ends of each step. They are put straight round the last motion found, in a region that becomes
/// smaller where that promises too much; the motion itself is exact. What is found is a motion, so the least
/// time is no longer than that, but for what the limits are broken by between the ends of the steps.
///
/// `path.point_at(s)`, s >= 0 from where the hold is asked for, as far as `room`.
template <class P>
class LeastHold {
 public:
  struct Found {
    double time{};               // s
    double beyond{};             // the limits, as a share of them, and of the first speed at the end
    std::vector<double> jerk{};  // mm/s^3 along the path, in steps of equal time
  };

  LeastHold(const P& path, double room, double velocity, double acceleration, const Limits& limits, int steps)
      : path_(path),
        room_(room),
        velocity_(velocity),
        acceleration_(acceleration),
        limits_(limits),
        steps_(static_cast<std::size_t>(steps)) {}

  /// The search begins with a brake that takes so many seconds, along a cubic in time.
  [[nodiscard]] Found search(double seconds) const { return search(first(seconds)); }
  /// It begins with a motion whose accelerations in equal steps of time these are.
  [[nodiscard]] Found search(double seconds, const std::vector<double>& accelerations) const {
    const double step = seconds / static_cast<double>(steps_);
    const auto at = [&](double share) {
      const double place = share * static_cast<double>(accelerations.size() - 1);
      const auto i = std::min(static_cast<std::size_t>(place), accelerations.size() - 2);
      const double within = place - static_cast<double>(i);
      return accelerations[i] + within * (accelerations[i + 1] - accelerations[i]);
    };
    std::vector<double> jerk;
    for (std::size_t i = 0; i < steps_; ++i)
      jerk.push_back((at(static_cast<double>(i + 1) / static_cast<double>(steps_)) -
                      at(static_cast<double>(i) / static_cast<double>(steps_))) /
                     step);
    return search(driven(step, std::move(jerk)));
  }

 private:
  struct State {
    double s{}, v{}, a{};
  };
  struct Motion {
    double time{};             // s, of a step
    std::vector<double> jerk;  // of each step
    std::vector<State> states;
  };
  // What is limited, and its derivatives by s, v, a and j.
  struct Limited {
    Vector3 value, by_s, by_v, by_a, by_j;
    double most{};
  };

  [[nodiscard]] Found search(Motion best) const {
    constexpr int most_rounds = 80;
    double merit = merit_of(best), trust = 0.3;
    for (int round = 0; round < most_rounds && trust > 1e-4; ++round) {
      const auto next = step(best, trust);
      const double reached = next ? merit_of(*next) : merit;
      if (reached < merit) {
        const bool slow = merit - reached < 1e-5 * merit;
        best = *next;
        merit = reached;
        trust = slow ? trust / 2 : std::min(1.5 * trust, 0.5);
      } else {
        trust /= 2.5;
      }
    }
    const double most = beyond(best);
    return {best.time * static_cast<double>(steps_), most, std::move(best.jerk)};
  }

  [[nodiscard]] PathPoint<Vector3> at(double s) const { return path_.point_at(std::clamp(s, 0.0, room_)); }

  [[nodiscard]] Motion driven(double time, std::vector<double> jerk) const {
    Motion motion{time, std::move(jerk), {{0, velocity_, acceleration_}}};
    for (const double j : motion.jerk) {
      const auto& [s, v, a] = motion.states.back();
      motion.states.push_back(
          {s + time * (v + time * (a / 2 + time * j / 6)), v + time * (a + time * j / 2), a + time * j});
    }
    return motion;
  }
  // As v falls along a cubic to 0.
  [[nodiscard]] Motion first(double seconds) const {
    std::vector<double> jerk;
    const double bend = (acceleration_ * seconds + 2 * velocity_) / std::pow(seconds, 3),
                 fall = -(2 * acceleration_ * seconds + 3 * velocity_) / (seconds * seconds);
    for (std::size_t i = 0; i < steps_; ++i)
      jerk.push_back(2 * fall +
                     6 * bend * seconds * (static_cast<double>(i) + 0.5) / static_cast<double>(steps_));
    return driven(seconds / static_cast<double>(steps_), std::move(jerk));
  }

  [[nodiscard]] Limited acceleration(const State& at_node) const {
    const auto& [s, v, a] = at_node;
    const auto q = at(s);
    return {q.second * v * v + q.first * a,
            q.third * v * v + q.second * a,
            2 * q.second * v,
            q.first,
            Vector3::Zero(),
            limits_.acceleration};
  }
  [[nodiscard]] Limited jerk(const State& at_node, double j) const {
    const auto& [s, v, a] = at_node;
    const auto q = at(s);
    return {q.third * v * v * v + 3 * q.second * v * a + q.first * j,
            3 * q.third * v * a + q.second * j,
            3 * q.third * v * v + 3 * q.second * a,
            3 * q.second * v,
            q.first,
            limits_.jerk};
  }

  [[nodiscard]] double beyond(const Motion& motion) const {
    double most = 0;
    const auto look = [&](const Limited& limited) {
      most = std::max(most, limited.value.norm() / limited.most - 1);
    };
    for (std::size_t i = 0; i <= steps_; ++i) {
      const State& state = motion.states[i];
      if (i > 0) look(acceleration(state));
      if (i < steps_) look(jerk(state, motion.jerk[i]));
      if (i > 0) look(jerk(state, motion.jerk[i - 1]));
      most = std::max({most, -state.v / velocity_, (state.s - room_) / room_});
    }
    const State& end = motion.states.back();
    return std::max({most, std::abs(end.v) / velocity_,
                     std::abs(end.a) * motion.time * static_cast<double>(steps_) / velocity_});
  }
  // To break a limit by a thousandth costs a hundredth of the time.
  static constexpr double weight = 10;
  [[nodiscard]] double merit_of(const Motion& motion) const {
    return motion.time * static_cast<double>(steps_) * (1 + weight * beyond(motion));
  }

  // The best motion next to another one as all looks from there.
  [[nodiscard]] std::optional<Motion> step(const Motion& from, double trust) const {
    constexpr double infinity = std::numeric_limits<double>::infinity();
    const int n = static_cast<int>(steps_);
    const double total = from.time * n, jerk_unit = limits_.jerk;
    // Unknown are changes: of s, v, a at the ends of the steps, of their jerks, of their time, as shares; and
    // what limits are broken by.
    const double units[3] = {velocity_ * total, velocity_, velocity_ / total};
    const auto column = [&](int node, int k) { return 3 * (node - 1) + k; };
    const auto jerk_column = [&](int i) { return 3 * n + i; };
    const int time_column = 4 * n, beyond_column = 4 * n + 1;
    std::vector<double> lower(static_cast<std::size_t>(4 * n + 2), -infinity), upper(lower.size(), infinity),
        cost(lower.size(), 0);
    for (int i = 0; i < n; ++i) {
      lower[static_cast<std::size_t>(jerk_column(i))] = -4 * trust;
      upper[static_cast<std::size_t>(jerk_column(i))] = 4 * trust;
    }
    for (int node = 1; node <= n; ++node) {
      const State& state = from.states[static_cast<std::size_t>(node)];
      lower[static_cast<std::size_t>(column(node, 1))] = -state.v / units[1];
      upper[static_cast<std::size_t>(column(node, 0))] = (room_ - state.s) / units[0];
    }
    lower[static_cast<std::size_t>(time_column)] = -trust / 2;
    upper[static_cast<std::size_t>(time_column)] = trust / 2;
    lower[static_cast<std::size_t>(beyond_column)] = 0;
    cost[static_cast<std::size_t>(time_column)] = 1;
    cost[static_cast<std::size_t>(beyond_column)] = weight;

    std::vector<CoinBigIndex> starts{0};
    std::vector<int> columns;
    std::vector<double> elements, low, high;
    const auto add = [&](int at, double element) {
      if (std::abs(element) > 1e-10) columns.push_back(at), elements.push_back(element);
    };
    const auto end_row = [&](double least, double most) {
      starts.push_back(static_cast<CoinBigIndex>(columns.size()));
      low.push_back(least);
      high.push_back(most);
    };
    const double h = from.time;
    for (int i = 0; i < n; ++i) {
      const State& before = from.states[static_cast<std::size_t>(i)];
      const double j = from.jerk[static_cast<std::size_t>(i)];
      const double by_state[3][3] = {{1, h, h * h / 2}, {0, 1, h}, {0, 0, 1}};
      const double by_jerk[3] = {h * h * h / 6, h * h / 2, h};
      const double by_time[3] = {before.v + h * (before.a + h * j / 2), before.a + h * j, j};
      for (int k = 0; k < 3; ++k) {
        add(column(i + 1, k), -1);
        if (i > 0)
          for (int m = k; m < 3; ++m) add(column(i, m), by_state[k][m] * units[m] / units[k]);
        add(jerk_column(i), by_jerk[k] * jerk_unit / units[k]);
        add(time_column, by_time[k] * h / units[k]);
        end_row(0, 0);
      }
    }
    for (const int k : {1, 2}) {
      const State& end = from.states.back();
      add(column(n, k), 1);
      const double there = -(k == 1 ? end.v : end.a) / units[k];
      end_row(there, there);
    }
    // The tangent to the ball at the value, and some others.
    const auto limit = [&](const Limited& limited, int node, int step) {
      const double size = limited.value.norm();
      std::vector<Vector3> directions;
      if (size > 0) directions.emplace_back(limited.value / size);
      for (int k = 0; k < 3; ++k)
        for (const double sign : {-1.0, 1.0}) directions.emplace_back(sign * Vector3::Unit(k));
      for (const Vector3& direction : directions) {
        const double value = direction.dot(limited.value) / limited.most;
        if (value < 0.3) continue;  // it is far
        if (node > 0) {
          add(column(node, 0), direction.dot(limited.by_s) * units[0] / limited.most);
          add(column(node, 1), direction.dot(limited.by_v) * units[1] / limited.most);
          add(column(node, 2), direction.dot(limited.by_a) * units[2] / limited.most);
        }
        if (step >= 0) add(jerk_column(step), direction.dot(limited.by_j) * jerk_unit / limited.most);
        add(beyond_column, -1);
        end_row(-infinity, 1 - value);
      }
    };
    for (int node = 0; node <= n; ++node) {
      const State& state = from.states[static_cast<std::size_t>(node)];
      if (node > 0) limit(acceleration(state), node, -1);
      if (node < n) limit(jerk(state, from.jerk[static_cast<std::size_t>(node)]), node, node);
      if (node > 0) limit(jerk(state, from.jerk[static_cast<std::size_t>(node - 1)]), node, node - 1);
    }

    const std::unique_ptr<Clp_Simplex, void (*)(Clp_Simplex*)> model(Clp_newModel(), Clp_deleteModel);
    Clp_setLogLevel(model.get(), 0);
    const std::vector<CoinBigIndex> none(lower.size() + 1, 0);
    Clp_addColumns(model.get(), static_cast<int>(lower.size()), lower.data(), upper.data(), cost.data(),
                   none.data(), nullptr, nullptr);
    Clp_addRows(model.get(), static_cast<int>(low.size()), low.data(), high.data(), starts.data(),
                columns.data(), elements.data());
    Clp_dual(model.get(), 0);
    if (Clp_status(model.get()) != 0) Clp_primal(model.get(), 0);
    if (Clp_status(model.get()) != 0) return std::nullopt;
    const double* const x = Clp_primalColumnSolution(model.get());
    std::vector<double> next = from.jerk;
    for (int i = 0; i < n; ++i) next[static_cast<std::size_t>(i)] += x[jerk_column(i)] * jerk_unit;
    return driven(h * (1 + x[time_column]), std::move(next));
  }

  const P& path_;
  double room_, velocity_, acceleration_;
  Limits limits_;
  std::size_t steps_;
};

}  // namespace cncplan::test
