// KK22 Fig. 7: five arcs in a chain under the published table and five-phase law.
#include <array>
#include <cmath>
#include <numbers>

#include "simulate/laws.hpp"
#include "support/catch.hpp"

using namespace cncplan;

namespace {

// Time and distance of a ramp whose jerk alone binds (KK22 section 3.1): 30 mm/s peaks at 548 mm/s^2.
double ramp_time(double from, double to) { return 2.0 * std::sqrt(std::abs(to - from) / 10000.0); }
double ramp_distance(double from, double to) { return (from + to) / 2.0 * ramp_time(from, to); }

// A block long enough to reach 30 mm/s.
double block_time(double length, double from, double to) {
  return ramp_time(from, 30.0) + ramp_time(30.0, to) +
         (length - ramp_distance(from, 30.0) - ramp_distance(30.0, to)) / 30.0;
}

struct Blocks {
  std::array<double, 7> speeds;  // at the six blocks' ends, the start first
  const char* junction;
};

}  // namespace

TEST_CASE("KK22 Fig. 7: lengths, junctions and the time of closed form") {
  // R = 5: quarter, quarter, half, quarter, quarter of a circle, 47.1239 mm; then 10 mm back
  const double quarter = 5.0 * std::numbers::pi / 2.0;
  const std::array<double, 6> lengths{quarter, quarter, 2.0 * quarter, quarter, quarter, 10.0};
  const double half = 15.0;
  for (const Blocks& expected :
       {Blocks{{0, half, half, half, half, 0, 0}, "table"}, Blocks{{0, 0, 0, 0, 0, 0, 0}, "stop"}}) {
    INFO(expected.junction);
    const test::Folder folder;
    const auto run = folder.run(test::example("kk22_figure7") +
                                " --json --count-steps --plan block --profile five --junction " +
                                expected.junction + " --blocks b.csv --motions m.csv");
    REQUIRE(run.exit == 0);
    const auto json = run.json();
    const test::Table blocks(folder / "b.csv");
    const test::Table motions(folder / "m.csv");
    REQUIRE(blocks.rows() == 6);
    double arcs = 0.0, duration = 0.0;
    for (std::size_t i = 0; i < 6; ++i) {
      INFO("block " << i);
      CHECK(motions["kind"][i] == (i < 5 ? test::kind::arc : test::kind::line));
      CHECK(blocks["length"][i] == Approx(lengths[i]).epsilon(1e-12));
      CHECK(blocks["v_in"][i] == Approx(expected.speeds[i]).margin(1e-12));
      CHECK(blocks["v_out"][i] == Approx(expected.speeds[i + 1]).margin(1e-12));
      const double time = block_time(lengths[i], expected.speeds[i], expected.speeds[i + 1]);
      CHECK(blocks["duration"][i] == Approx(time).epsilon(1e-12));
      duration += time;
      if (i < 5) arcs += blocks["length"][i];
    }
    CHECK(arcs == Approx(47.1239).margin(5e-5));
    CHECK(json["time_s"].get<double>() == Approx(duration).epsilon(1e-12));
    CHECK(json["arcs"] == 5);
    CHECK(json["motions"] == 6);
    CHECK(json["lines"] == 9);
    // to the front again: 10 mm each in X and 15 in Y, there and back, at 400 steps/mm
    CHECK(json["net_steps"] == nlohmann::json{{"X", 0}, {"Y", 0}, {"Z", 0}});
  }
}

TEST_CASE("the absolute reading of the table stops a chain that the published one runs through") {
  // two arcs of 135 degrees on one circle: their chords turn right by more than 90, with a G02's rotation
  const test::Folder folder;
  const auto speed = [&](const std::string& junction) {
    const auto run = folder.run_text("G2 X8.535534 Y3.535534 R5\nX5 Y-5 R5\n",
                                     "--quiet --plan block --blocks b.csv --junction " + junction);
    REQUIRE(run.exit == 0);
    return test::Table(folder / "b.csv")["v_out"].front();
  };
  CHECK(speed("table") == Approx(30.0));
  CHECK(speed("table-absolute") == 0.0);
  CHECK(speed("stop") == 0.0);
}
