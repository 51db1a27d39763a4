// Whole programs of many blocks: their samples, one by one and in batches.
#include <algorithm>
#include <cmath>
#include <cstdint>
#include <sstream>
#include <string>

#include "../../apps/generate/programs.hpp"
#include "cncplan/plan_program.hpp"
#include "support/catch.hpp"
#include "support/no_heap.hpp"
#include "support/random.hpp"

using namespace cncplan;

namespace {

const Machine<3> mill{.limits = {.velocity = 30, .acceleration = 1000, .jerk = 10000}};

// The first lines of a generated program, with a pause now and then.
auto planned(generate::Kind kind, int lines) {
  std::ostringstream text;
  generate::write(text, kind);
  std::istringstream program(text.str());
  std::string line, part;
  for (int i = 1; i <= lines && std::getline(program, line); ++i)
    part += line + (i % 50 == 0 ? "\nG4 P0.0123\n" : "\n");
  auto trajectory =
      plan_text(part + (kind == generate::Kind::pocket ? "G4 P0.5\n" : ""), mill, {.tolerance = 0});
  REQUIRE(trajectory);
  return *trajectory;
}

constexpr generate::Kind kinds[] = {generate::Kind::roughing, generate::Kind::finishing,
                                    generate::Kind::pocket};

}  // namespace

TEST_CASE("A program's samples stand on one grid, and the last one on its end point, bit for bit") {
  for (const auto kind : kinds) {
    const auto trajectory = planned(kind, 600);
    for (const double period : {1e-3, 3.7e-3}) {
      std::int64_t k = 0;
      bool on_grid = true;
      double jump = 0.0;
      Vector3 last = trajectory.program().front().path.start();
      for (const auto& now : trajectory.samples(period)) {
        on_grid = on_grid && now.time == std::min(static_cast<double>(k++) * period, trajectory.duration());
        jump = std::max(jump, (now.position - last).norm() / period);
        last = now.position;
      }
      CHECK(on_grid);
      CHECK(k == trajectory.samples(period).size());
      CHECK(last == trajectory.program().back().path.end());
      CHECK(jump < 30.0 * (1 + 1e-9));
    }
  }
}

TEST_CASE("A program's batches are its stream to 1e-12 mm, however they are cut") {
  test::Random random;
  for (const auto kind : kinds) {
    const auto trajectory = planned(kind, 600);
    Eigen::Matrix<double, 3, 512> room;
    double worst = 0.0;
    const auto samples = trajectory.samples(1e-3);
    auto sample = samples.begin();
    std::int64_t first = 0;
    for (bool more = true; more;) {
      const int wanted = random.integer(1, 512);
      const auto written = trajectory.positions(1e-3, first, {room.data(), 3, wanted});
      for (Eigen::Index i = 0; i < written; ++i, ++sample)
        worst = std::max(worst, (room.col(i) - (*sample).position).cwiseAbs().maxCoeff());
      first += written;
      more = written == wanted;
    }
    CHECK(first == samples.size());
    CHECK(sample == samples.end());
    CHECK(worst < 1e-12);
  }
}

TEST_CASE("Asked at random, a program gives what its samples gave on their way") {
  test::Random random;
  for (const auto kind : kinds) {
    const auto trajectory = planned(kind, 600);
    const double period = trajectory.duration() / 20000.0;
    double worst = 0.0;
    for (const auto& now : trajectory.samples(period)) {
      (void)trajectory.at(random.uniform(-1.0, 2.0) * trajectory.duration());
      const auto asked = trajectory.at(now.time);
      worst = std::max({worst, (asked.position - now.position).norm(),
                        std::abs(asked.along.position - now.along.position)});
    }
    CHECK(worst == 0.0);
  }
}

TEST_CASE("Sampling a program keeps off the heap") {
  const auto trajectory = planned(generate::Kind::pocket, 60);
  static Eigen::Matrix<double, 3, 512> room;
  double sum = 0.0;
  CHECK(test::heap_allocations_of([&] {
          for (const auto& now : trajectory.samples(1e-3)) sum += now.position.x();
          sum += trajectory.at(trajectory.duration() / 3).position.y();
          for (std::int64_t first = 0; trajectory.positions(1e-3, first, points(room)) == room.cols();)
            first += room.cols();
        }) == 0);
  CHECK(std::isfinite(sum));
}
