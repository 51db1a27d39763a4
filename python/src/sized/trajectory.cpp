// What Python asks a trajectory, for machines of the number SIZE of `SizedMachine`.
#include <algorithm>
#include <cmath>
#include <limits>
#include <new>
#include <sstream>

#include "cncplan/peaks.hpp"
#include "cncplan/step_edges.hpp"
#include "fault.hpp"
#include "interruption.hpp"
#include "planned.hpp"
#include "planner.hpp"

namespace cncplan::python {

namespace {

void write(const Planned<SIZE>::SetPoint& point, std::size_t row, const Columns& out) {
  const auto put = [row](double* column, double value) {
    if (column != nullptr) column[row] = value;
  };
  const auto put_axes = [&](double* column, const auto& vector) {
    if (column != nullptr) std::copy_n(vector.data(), out.axes, column + row * out.axes);
  };
  put(out.t, point.time);
  if (out.line != nullptr) out.line[row] = point.line;
  if (out.block != nullptr) out.block[row] = static_cast<std::int64_t>(point.block);
  put_axes(out.position, point.position);
  put_axes(out.velocity, point.velocity);
  put_axes(out.acceleration, point.acceleration);
  put_axes(out.jerk, point.jerk);
  if (out.tool != nullptr) std::copy_n(point.tool.data(), 3, out.tool + row * 3);
  put(out.s, point.along.position);
  put(out.v, point.along.velocity);
  put(out.a, point.along.acceleration);
  put(out.j, point.along.jerk);
}

class TrajectoryOfSize final : public AnyTrajectory {
 public:
  TrajectoryOfSize(const AnyMachine& machine, Planned<SIZE>&& planned)
      : machine_(machine), planned_(std::move(planned)) {}

  [[nodiscard]] double duration() const override { return planned_.duration(); }
  [[nodiscard]] double length() const override { return planned_.length(); }

  [[nodiscard]] std::int64_t sample_count(double period) const override {
    return planned_.samples(period).size();
  }

  void sample(double period, const Columns& out) const override {
    Interruption interruption;
    std::size_t row = 0;
    for (const auto& point : planned_.samples(period)) {
      write(point, row++, out);
      if (row % 4096 == 0) static_cast<void>(interruption.goes_on());
    }
  }

  void at(std::span<const double> times, const Columns& out) const override {
    Interruption interruption;
    for (std::size_t row = 0; row < times.size(); ++row) {
      write(planned_.at(times[row]), row, out);
      if (row % 4096 == 0) static_cast<void>(interruption.goes_on());
    }
  }

  [[nodiscard]] std::vector<BlockRow> blocks() const override {
    std::vector<BlockRow> rows;
    for (const BlockMotion& motion : planned_.blocks())
      rows.push_back({static_cast<std::int64_t>(motion.block), motion.line, motion.length, motion.start,
                      motion.duration, motion.entry, motion.peak, motion.exit,
                      static_cast<std::int64_t>(motion.level),
                      motion.reason ? static_cast<std::int64_t>(*motion.reason) : -1});
    return rows;
  }
  [[nodiscard]] std::vector<FallbackRow> fallbacks() const override {
    std::vector<FallbackRow> rows;
    for (const Fallback& part : planned_.fallbacks())
      rows.push_back({static_cast<std::int64_t>(part.first), static_cast<std::int64_t>(part.last),
                      static_cast<std::int64_t>(part.level), static_cast<std::int64_t>(part.reason)});
    return rows;
  }

  [[nodiscard]] std::vector<TimedWord> words() const override {
    return {planned_.words().begin(), planned_.words().end()};
  }
  [[nodiscard]] std::vector<std::string> warnings() const override {
    return {planned_.warnings().begin(), planned_.warnings().end()};
  }

  [[nodiscard]] std::vector<EdgeRow> step_edges(std::size_t most) const override {
    Interruption interruption;
    std::vector<EdgeRow> rows;
    for (const MotorEdge& edge : planned_.step_edges()) {
      if (rows.size() == most) throw std::bad_alloc();
      rows.push_back({edge.time, static_cast<std::int64_t>(edge.motor), edge.axis, edge.direction});
      if (rows.size() % 4096 == 0) static_cast<void>(interruption.goes_on());
    }
    return rows;
  }

  [[nodiscard]] PeakRow peaks() const override {
    const auto found = cncplan::peaks(planned_);
    const auto list = [](const auto& vector) {
      return std::vector<double>(vector.data(), vector.data() + vector.size());
    };
    return {list(found.velocity), list(found.acceleration), list(found.jerk), found.tool, found.along};
  }

  [[nodiscard]] std::string report(const tools::ReportText& text) const override {
    if (const auto missing = tools::report::missing_packages(); !missing.empty())
      throw Fault{{{{ErrorCode::not_supported, "report", 0, 0}, 0, 0, {}}, {}, {}},
                  "report: built without" + std::string(missing)};
    std::ostringstream page;
    tools::report::write(page, report_of<SIZE>(planned_, machine_, text));
    return std::move(page).str();
  }

 private:
  AnyMachine machine_;
  Planned<SIZE> planned_;
};

}  // namespace

template <>
TrajectoryPointer any_trajectory<SIZE>(const AnyMachine& machine, Planned<SIZE>&& planned) {
  return std::make_unique<TrajectoryOfSize>(machine, std::move(planned));
}

}  // namespace cncplan::python
