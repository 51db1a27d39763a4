// Whole programs: the sampler and the timeline of plan/, over lines and arcs that follow each other.
#include <array>
#include <memory>
#include <sstream>
#include <variant>

#include "../../examples/generate/programs.hpp"
#include "cncplan/gcode/read_program.hpp"
#include "cncplan/junction/deviation.hpp"
#include "cncplan/plan/motion_block.hpp"
#include "cncplan/plan/sampler.hpp"
#include "cncplan/plan/timeline.hpp"
#include "cncplan/plan/whole_plan.hpp"
#include "support/catch.hpp"
#include "support/no_heap.hpp"
#include "support/random.hpp"

using namespace cncplan;

namespace {

struct Planned {
  std::vector<plan::Block> blocks;
  std::vector<double> lengths;
  std::vector<plan::Span> spans;
};

/// The first moves of a generated program, with a pause now and then.
Planned planned(generate::Kind kind, std::size_t moves) {
  std::ostringstream text;
  generate::write(text, kind);
  Planned result;
  const Limits limits{.velocity = 30.0, .acceleration = 1000.0, .jerk = 10000.0};
  gcode::Reader reader;
  const std::string program = text.str();
  const auto read = gcode::read_program(gcode::TextLines(program), reader, [&](const gcode::Item& item) {
    if (const auto* motion = std::get_if<gcode::Motion>(&item))
      result.blocks.push_back(plan::block(*motion, limits, 30.0).value());
    return result.blocks.size() < moves;
  });
  REQUIRE(read);
  for (std::size_t i = 17; i < result.blocks.size(); i += 50) result.blocks[i].pause = 0.0123;
  result.blocks.back().pause = kind == generate::Kind::pocket ? 0.5 : 0.0;
  const auto plan = plan::whole_plan(result.blocks, junction::Deviation{0.01});
  REQUIRE(plan);
  result.lengths = plan->lengths;
  result.spans = plan->spans;
  return result;
}

plan::Sampler sampler(const Planned& program, double period) {
  return {program.blocks, program.spans, program.lengths, period};
}

}  // namespace

TEST_CASE("A program's samples stand on one grid, and the last one on its end point, bit for bit") {
  for (const auto kind : {generate::Kind::roughing, generate::Kind::finishing, generate::Kind::pocket}) {
    const Planned program = planned(kind, 600);
    for (const double period : {1e-3, 3.7e-3}) {
      auto samples = sampler(program, period);
      std::int64_t k = 0;
      bool on_grid = true;
      double jump = 0;
      std::optional<plan::ProgramSample> last;
      while (const auto now = samples.next()) {
        const double t = static_cast<double>(k++) * period;
        on_grid = on_grid && now->sample.time == std::min(t, samples.grid().end);
        if (last) jump = std::max(jump, (now->sample.position - last->sample.position).norm() / period);
        last = now;
      }
      CHECK(on_grid);
      CHECK(k == samples.size());
      REQUIRE(last);
      CHECK(last->sample.time == samples.grid().end);
      CHECK(last->sample.position == program.blocks.back().segment.end());
      CHECK(jump < 30.0 * (1 + 1e-9));
    }
  }
}

TEST_CASE("A program's batches are its stream to 1e-12 mm, however they are cut") {
  test::Random random;
  for (const auto kind : {generate::Kind::roughing, generate::Kind::finishing, generate::Kind::pocket}) {
    const Planned program = planned(kind, 600);
    auto stream = sampler(program, 1e-3);
    auto batch = sampler(program, 1e-3);
    Eigen::Matrix<double, 3, 512> room;
    double worst = 0;
    std::int64_t count = 0;
    while (true) {
      const int wanted = random.integer(1, 512);
      const auto written = batch.positions({room.data(), 3, wanted});
      for (Eigen::Index i = 0; i < written; ++i, ++count)
        worst = std::max(worst, (room.col(i) - stream.next()->sample.position).cwiseAbs().maxCoeff());
      if (written < wanted) break;
    }
    CHECK(count == stream.size());
    CHECK_FALSE(stream.next());
    CHECK(worst < 1e-12);
  }
}

TEST_CASE("Asked at random, the timeline gives what the cursor gave on its way") {
  test::Random random;
  for (const auto kind : {generate::Kind::roughing, generate::Kind::finishing, generate::Kind::pocket}) {
    const Planned program = planned(kind, 600);
    std::vector<plan::SpanStart> starts(program.spans.size());
    std::vector<double> blocks(program.lengths.size());
    const plan::Timeline timeline(std::span<const plan::Span>(program.spans),
                                  std::span<const double>(program.lengths), std::span(starts),
                                  std::span(blocks));
    plan::Cursor cursor(program.spans, program.lengths);
    double worst = 0;
    std::size_t other_block = 0;
    for (int k = 0; k <= 20000; ++k) {
      const double t = timeline.duration() * (k / 20000.0);
      const auto walked = cursor.at(t);
      const auto found = timeline.at(t);
      const auto place = [&](const plan::Place& p) {
        const auto& segment = program.blocks[p.block].segment;
        return segment.position(segment.parameter_at(p.along));
      };
      worst = std::max({worst, (place(walked) - place(found)).norm(),
                        std::abs(walked.state.position - found.state.position)});
      if (walked.block != found.block && std::abs(walked.along - found.along) > 1e-9 && found.along > 1e-9 &&
          walked.along > 1e-9)
        ++other_block;
    }
    CHECK(worst < 1e-9);
    CHECK(other_block == 0);
    CHECK(timeline.at(-1.0).along == 0.0);
    CHECK(timeline.at(1e9).block == program.blocks.size() - 1);
  }
}

TEST_CASE("Sampling a program keeps off the heap") {
  const Planned program = planned(generate::Kind::pocket, 60);
  static Eigen::Matrix<double, 3, 512> room;
  CHECK(test::heap_allocations_of([&] {
          auto samples = sampler(program, 1e-3);
          while (samples.next()) {
          }
          auto batch = sampler(program, 1e-3);
          while (batch.positions(points(room)) == room.cols()) {
          }
        }) == 0);
}

TEST_CASE("a program without blocks has no samples") {
  plan::Sampler sampler({}, {}, {}, 1e-3);
  CHECK(sampler.size() == 0);
  CHECK(!sampler.next());
  std::array<double, 12> points{};
  CHECK(sampler.positions(Points(points.data(), 3, 4)) == 0);
}
