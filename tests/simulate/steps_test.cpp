// Step edges against samples so dense that the planned position at an edge can be read off them.
#include <algorithm>
#include <cmath>

#include "simulate/table.hpp"
#include "simulate/vcd.hpp"
#include "support/catch.hpp"

using namespace cncplan;

namespace {

constexpr double steps_per_mm = 400.0;

// The cubic through four neighbours of t on a grid.
double at(const std::vector<double>& values, double t, double period) {
  const auto last = static_cast<double>(values.size()) - 4.0;  // the last row is off the grid
  const double k = std::clamp(std::floor(t / period) - 1.0, 0.0, last - 1.0);
  const auto i = static_cast<std::size_t>(k);
  const double u = t / period - k;
  return values[i] * (u - 1) * (u - 2) * (u - 3) / -6.0 + values[i + 1] * u * (u - 2) * (u - 3) / 2.0 +
         values[i + 2] * u * (u - 1) * (u - 3) / -2.0 + values[i + 3] * u * (u - 1) * (u - 2) / 6.0;
}

// Largest miss of an edge from its boundary, and of the count from the position at all samples, in steps.
struct Misses {
  double edge = 0.0;
  double count = 0.0;
};

Misses misses(const test::VcdAxis& axis, const std::vector<double>& times, const std::vector<double>& values,
              double period) {
  Misses worst;
  double count = std::round(values.front() * steps_per_mm);
  std::size_t row = 0;
  const auto count_until = [&](double time) {
    for (; row < times.size() && times[row] < time; ++row)
      worst.count = std::max(worst.count, std::abs(count - values[row] * steps_per_mm));
  };
  for (const auto& edge : axis.edges) {
    const double time = static_cast<double>(edge.time) * 1e-9;
    count_until(time);
    const double boundary = count + edge.direction / 2.0;
    worst.edge = std::max(worst.edge, std::abs(at(values, time, period) * steps_per_mm - boundary));
    count += edge.direction;
  }
  count_until(times.back() + 1.0);
  return worst;
}

}  // namespace

TEST_CASE("edges are where dense samples cross the boundaries between steps") {
  const double period = 2e-5;
  const test::Folder folder;
  // stops at the junctions: the position has no corner that a cubic would round off
  const auto run = folder.run_text("G2 X3 Y1 R2\nG3 X1 Y4.2361 Z-0.5 I-2 J1 P2\nG1 X-2 Y0.3 Z1.01\n",
                                   "--junction stop --period 2e-5 --samples s.csv --steps x.vcd --quiet");
  REQUIRE(run.exit == 0);
  const test::Table samples(folder / "s.csv");
  const test::Vcd vcd(folder / "x.vcd");
  for (const auto& [name, column] : {std::pair{"X", "x"}, {"Y", "y"}, {"Z", "z"}}) {
    INFO(name);
    const auto& axis = vcd.axis(name);
    const auto worst = misses(axis, samples["t"], samples[column], period);
    CHECK(axis.edges.size() > 600);
    CHECK(worst.edge < 1e-4);  // an edge on the nanosecond grid: 30 mm/s 0.5 ns = 6e-6 steps
    CHECK(worst.count <= 0.5 + 1.01e-4);
    CHECK(axis.shortest_high == 2000);
    CHECK(axis.longest_high == 2000);
  }
}
