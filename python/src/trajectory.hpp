// A planned trajectory of a machine with any number of axes.
#pragma once

#include <array>
#include <cstdint>
#include <memory>
#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "blocks.hpp"
#include "cncplan/plan_options.hpp"
#include "cncplan/trajectory.hpp"
#include "cncplan_tools/report.hpp"
#include "machine.hpp"

namespace cncplan::python {

/// Arrays that samples are written to: `axes` numbers a row of position to jerk, three of tool, one of the
/// others.
struct Columns {
  std::size_t axes{};
  double* t{};
  std::int64_t* line{};
  std::int64_t* block{};
  double *position{}, *velocity{}, *acceleration{}, *jerk{}, *tool{};
  double *s{}, *v{}, *a{}, *j{};
};

struct BlockRow {
  std::int64_t block{}, line{};
  double length{}, start{}, duration{}, entry{}, peak{}, exit{};
  std::int64_t level{};
  std::int64_t reason = -1;  ///< of another level; -1: it is the one that was asked for
};
struct FallbackRow {
  std::int64_t first{}, last{}, level{}, reason{};
};
struct EdgeRow {
  double time{};
  std::int64_t motor{}, axis{}, direction{};
};
struct PeakRow {
  std::vector<double> velocity, acceleration, jerk;  ///< of each axis
  Limits tool, along;
};

class AnyTrajectory {
 public:
  AnyTrajectory() = default;
  AnyTrajectory(const AnyTrajectory&) = delete;
  AnyTrajectory& operator=(const AnyTrajectory&) = delete;
  virtual ~AnyTrajectory() = default;

  [[nodiscard]] virtual double duration() const = 0;
  [[nodiscard]] virtual double length() const = 0;
  /// Rows of `sample`; as many as a 64-bit number has where there are more.
  [[nodiscard]] virtual std::int64_t sample_count(double period) const = 0;
  virtual void sample(double period, const Columns& out) const = 0;
  virtual void at(std::span<const double> times, const Columns& out) const = 0;
  [[nodiscard]] virtual std::vector<BlockRow> blocks() const = 0;
  [[nodiscard]] virtual std::vector<FallbackRow> fallbacks() const = 0;
  [[nodiscard]] virtual std::vector<TimedWord> words() const = 0;
  [[nodiscard]] virtual std::vector<std::string> warnings() const = 0;
  /// std::bad_alloc where there are more than `most`.
  [[nodiscard]] virtual std::vector<EdgeRow> step_edges(std::size_t most) const = 0;
  [[nodiscard]] virtual PeakRow peaks() const = 0;
  /// One page of HTML. Throws `Fault` where the build had no libraries to make it of.
  [[nodiscard]] virtual std::string report(const tools::ReportText& text) const = 0;
};

using TrajectoryPointer = std::unique_ptr<AnyTrajectory>;

/// Each throws `Fault`.
template <int N>
[[nodiscard]] TrajectoryPointer plan_text(const AnyMachine& machine, std::string_view text,
                                          const PlanOptions& options, const std::string& file);
template <int N>
[[nodiscard]] TrajectoryPointer plan_hand_made(const AnyMachine& machine, const std::vector<AnyBlock>& blocks,
                                               const PlanOptions& options);

/// Errors of arcs and splines alone.
void check(const AnyBlock& block);

}  // namespace cncplan::python
