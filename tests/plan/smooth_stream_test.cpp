// Programs that are planned in parts: limits by differences, the path by brute force, the time of the whole.
#include "cncplan/smooth_stream.hpp"
#include "cncplan/plan_blocks.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <sstream>
#include <string>
#include <tuple>
#include <vector>

#include "plan/at_level.hpp"
#include "plan/joined_parts.hpp"
#include "plan/rows_program.hpp"
#include "support/catch.hpp"
#include "support/random.hpp"

using namespace cncplan;
using namespace cncplan::test;

namespace {

using Stream = SmoothStream<Machine<3>, MillBlock>;

// Where parts meet at a speed, of a program whose parts end at these times.
template <class T>
std::size_t cuts(const T& trajectory, const std::vector<double>& ends) {
  return static_cast<std::size_t>(std::count_if(ends.begin(), ends.end(), [&](double end) {
    return end < trajectory.duration() && trajectory.at(end).velocity.norm() > 0;
  }));
}

}  // namespace

TEST_CASE("stream: parts of a long run keep limits and tolerance, and take the time of the whole",
          "[smooth-stream]") {
  struct Case {
    double feed;
    SmoothLevel level;
    std::size_t held;
  };
  for (const auto& [feed, level, held] :
       {Case{1800, SmoothLevel::good, 60}, Case{1800, SmoothLevel::good, 150},
        Case{6000, SmoothLevel::good, 60}, Case{6000, SmoothLevel::best, 100}}) {
    CAPTURE(feed, held);
    Machine<3> machine = mill;
    machine.limits.velocity = feed / 60;
    const MillBlocks blocks = blocks_of_text(rows(8, 50, feed), machine);
    const auto whole = plan_blocks(blocks, machine, at_level(level, within));
    REQUIRE(whole);
    std::vector<double> ends;
    const auto parts = plan_in_parts(blocks, machine, within, level, held, &ends);
    REQUIRE(parts);
    check_motion(*parts, blocks, machine);
    const auto met = static_cast<double>(cuts(*parts, ends));
    CHECK(cuts(*parts, ends) >= blocks.size() / held);
    // A stop in place of a cut costs 0.11 s and more.
    CHECK(parts->duration() - whole->duration() < 0.02 * met);
  }
}

TEST_CASE("stream: the level exact keeps to the path, and without a tolerance the level is exact",
          "[smooth-stream]") {
  const MillBlocks blocks = blocks_of_text("F1800\nG1 X20\nX40 Y2\nX60 Y0\nX60.01 Y0.001\nX70 Z3\n");
  for (const PlanOptions& options :
       {PlanOptions{.tolerance = 0.1, .level = SmoothLevel::exact}, PlanOptions{.tolerance = 0}}) {
    const auto whole = plan_blocks(blocks, mill, options);
    REQUIRE(whole);
    Stream stream(mill, options);
    for (const auto& block : blocks) REQUIRE(stream.push(block));
    REQUIRE(stream.finish());
    const auto part = stream.take();
    CHECK(part.level() == SmoothLevel::exact);
    CHECK(part.duration() == Approx(whole->duration()).epsilon(1e-9));
    double off = 0;
    for (const auto& point : part.samples(0.01)) {
      double nearest = 1e9;
      for (const auto& block : blocks) {
        const Vector3 from = block.path.position_at(0),
                      way = block.path.position_at(block.path.length()) - from;
        const double along =
            way.isZero() ? 0 : std::clamp((point.position - from).dot(way) / way.squaredNorm(), 0.0, 1.0);
        nearest = std::min(nearest, (point.position - from - along * way).norm());
      }
      off = std::max(off, nearest);
    }
    CHECK(off < 1e-9);
  }
}

TEST_CASE("stream: the level best", "[smooth-stream]") {
  const MillBlocks blocks = blocks_of_text(rows(4, 50));
  std::vector<double> ends;
  const auto parts = plan_in_parts(blocks, mill, within, SmoothLevel::best, 80, &ends);
  REQUIRE(parts);
  check_motion(*parts, blocks);
  CHECK(cuts(*parts, ends) >= 2);
}

TEST_CASE("stream: a part goes on as the one before ended", "[smooth-stream]") {
  const MillBlocks blocks = blocks_of_text(rows(6, 60));
  Stream stream(mill, at_level(SmoothLevel::good, within), 80);
  Vector3 position = Vector3::Zero(), velocity = Vector3::Zero(), acceleration = Vector3::Zero();
  int parts = 0;
  const auto take = [&] {
    if (!stream.ready()) return;
    const auto part = stream.take();
    const auto start = part.at(0), end = part.at(part.duration());
    CHECK((start.position - position).norm() < 1e-9);
    CHECK((start.velocity - velocity).norm() < 1e-6);
    CHECK((start.acceleration - acceleration).norm() < 1e-3);
    position = end.position;
    velocity = end.velocity;
    acceleration = end.acceleration;
    ++parts;
  };
  for (const MillBlock& block : blocks) {
    REQUIRE(stream.push(block));
    take();
    CHECK((parts == 0 || velocity.norm() > 1));
  }
  REQUIRE(stream.finish());
  take();
  CHECK(parts > 5);
  CHECK(velocity.norm() == 0);
  CHECK(!stream.ready());
  const auto nothing = stream.take();
  CHECK(nothing.program().empty());
}

TEST_CASE("stream: plans that look ahead over seconds make short parts, and take the time of the whole",
          "[smooth-stream]") {
  test::Random random;
  for (const auto level : {SmoothLevel::good, SmoothLevel::best}) {
    std::string text = "F1800\n";
    Vector3 at = Vector3::Zero();
    for (int i = 0; i < (level == SmoothLevel::good ? 60 : 15); ++i) {
      at += Vector3(random.uniform(3, 25), random.uniform(-10, 10), 0);
      const bool arc = random.integer(0, 3) == 0, rapid = random.integer(0, 9) == 0;
      text += rapid ? "G0 X" : arc ? "G2 R60 X" : "G1 X";
      text += std::to_string(at.x()) + " Y" + std::to_string(at.y()) +
              (random.integer(0, 14) == 0 ? "\nG4 P0.1\n" : "\n");
    }
    const MillBlocks blocks = blocks_of_text(text);
    const auto whole = plan_blocks(blocks, mill, at_level(level, within));
    REQUIRE(whole);
    Stream stream(mill, at_level(level, within), 300);
    stream.plan_ahead(4, 4);
    JoinedParts<MillBlock, Machine<3>> parts;
    for (const MillBlock& block : blocks) {
      REQUIRE(stream.push(block));
      while (stream.has_part()) {
        REQUIRE(stream.make_part());
        REQUIRE(stream.ready());
        parts.take(stream);
      }
    }
    while (!stream.empty()) {
      REQUIRE(stream.finish_part());
      parts.take(stream);
    }
    const auto joined = parts.trajectory(mill);
    check_motion(joined, blocks, mill, 40);
    CHECK(joined.duration() < 1.01 * whole->duration());
    double before = 0;
    for (const double end : parts.ends()) {
      CHECK(end - before < 10);
      before = end;
    }
    CHECK(parts.ends().size() > static_cast<std::size_t>(joined.duration() / 8));
  }
}

TEST_CASE("stream: where feeds are raised behind a cut the motion goes on", "[smooth-stream]") {
  // From the fuzzing of executors: with a higher feed the search beyond the cut begins with another curve
  // than the one along which a way to rest was proven.
  Machine<3> machine{.limits = {.velocity = 50, .acceleration = 1000, .jerk = 100000}};
  machine.axes[0].velocity = 31.0847513, machine.axes[0].acceleration = 877.993888;
  machine.axes[1].velocity = 55.4672692, machine.axes[1].acceleration = 714.684798;
  machine.axes[2].velocity = 33.2934659, machine.axes[2].acceleration = 662.545337;
  machine.axes[0].jerk = 34917.9428, machine.axes[1].jerk = 36539.643, machine.axes[2].jerk = 105527.886;
  const std::string text =
      "G91 G21 F1801.927\nG0 X1.80156 Y1.07464 Z-0.30486\nG1 X0.52360 Y3.34880 Z-0.99851\nF67.938\n"
      "G64 P0.0097\nG0 X2.49750 Y0.92788 Z-0.54742\nG0 X1.11155 Y1.70349 Z-0.18410\n"
      "G1 X-0.39106 Y2.92340 Z-0.43369\nG1 X-2.82634 Y3.36672 Z-1.36351\nG1 X-1.56806 Y1.77250 Z-0.70422\n"
      "G0 X-1.78832 Y3.76106 Z-1.33240\nG0 X-2.20918 Y2.59644 Z-0.63006\nM3 S1000\n"
      "G0 X-3.76304 Y2.63373 Z-0.97827\nG1 X-2.33247 Y0.95459 Z-0.93821\n";
  const MillBlocks blocks = blocks_of_text(text, machine);
  std::size_t raised = 0;
  for (const SmoothLevel level : {SmoothLevel::good, SmoothLevel::best})
    for (const double reserve : {0.0, 0.02})
      for (double by = 1.05; by < 6; by *= 1.1) {
        CAPTURE(level, reserve, by);
        PlanOptions options{.tolerance = 0.0152749204, .level = level, .reserve = reserve};
        Stream stream(machine, options, 300);
        stream.plan_ahead(1.588, 0.784);
        JoinedParts<MillBlock, Machine<3>> parts;
        for (const MillBlock& block : blocks) REQUIRE(stream.push(block));
        while (stream.has_part()) {
          REQUIRE(stream.make_part());
          if (!stream.ready()) break;  // more blocks are needed
          parts.take(stream);
          if (!stream.open()) continue;
          ++raised;
          stream.scale_feeds(stream.first_open(), [&](std::int64_t) { return by; });
        }
        while (!stream.empty()) {
          REQUIRE(stream.finish_part());
          parts.take(stream);
        }
        const auto joined = parts.trajectory(machine);
        const Used most = used(joined, machine);
        CHECK(most.velocity <= 1 + 1e-6);
        CHECK(most.acceleration <= 1 + 1e-5);
        CHECK(most.jerk <= 1 + 1e-4);
        CHECK(joined.completed());
        const Vector3 end = blocks.back().path.position_at(blocks.back().path.length());
        CHECK((joined.at(joined.duration()).position - end).norm() < 1e-9);
      }
  CHECK(raised > 40);
}

TEST_CASE("stream: no more blocks are held than it was told", "[smooth-stream]") {
  const std::size_t held = 50;
  // Runs, a long stretch on the exact path, and one without any motion.
  std::string text = rows(3, 60) + "G61\n" + rows(3, 60) + "G64\n";
  for (int i = 0; i < 200; ++i) text += "M8\n";
  const MillBlocks blocks = blocks_of_text(text + rows(3, 60));
  Stream stream(mill, at_level(SmoothLevel::good, within), held);
  std::size_t pushed = 0, out = 0;
  for (const MillBlock& block : blocks) {
    REQUIRE(stream.push(block));
    ++pushed;
    if (!stream.ready()) continue;
    const auto part = stream.take();
    out = part.first_block() + part.program().size() - 1;
    CHECK(pushed - out <= held + 1);
  }
  CHECK(pushed - out <= held + 1);
  REQUIRE(stream.finish());
  const auto last = stream.take();
  CHECK(last.first_block() + last.program().size() == blocks.size());
}

TEST_CASE("stream: words behind every line are told once", "[smooth-stream]") {
  const MillBlocks lines = blocks_of_text(rows(3, 60));
  for (const int words : {1, 7}) {
    MillBlocks blocks;
    for (const MillBlock& line : lines) {
      blocks.push_back(line);
      const Vector3 here = line.path.position_at(line.path.length());
      for (int i = 0; i < words; ++i) {
        blocks.push_back(line);
        blocks.back().path = path::Line<3>(here, here);
        blocks.back().word = {'M', static_cast<double>(100 + i)};
      }
    }
    const std::size_t held = 120;
    CAPTURE(words);
    Stream stream(mill, at_level(SmoothLevel::good, within), held);
    JoinedParts<MillBlock, Machine<3>> parts;
    std::size_t out = 0, most = 0;
    for (std::size_t i = 0; i < blocks.size(); ++i) {
      REQUIRE(stream.push(blocks[i]));
      if (stream.ready()) {
        parts.take(stream);
        const auto all = parts.trajectory(mill);
        out = all.program().size() - 1;
      }
      most = std::max(most, i + 1 - out);
    }
    CHECK(most <= held + 1);
    REQUIRE(stream.finish());
    parts.take(stream);
    // Each word is told once.
    const auto all = parts.trajectory(mill);
    std::size_t told = 0;
    for (const auto& block : all.program()) told += block.word.letter == 'M' ? 1 : 0;
    CHECK(told == lines.size() * static_cast<std::size_t>(words));
    check_motion(all, blocks);
  }
}

TEST_CASE("stream: stops, pauses, words and exact blocks are those of the whole", "[smooth-stream]") {
  std::string text = rows(2, 60) + "M8\nG4 P0.25\n" + rows(2, 60) + "M0\nG61.1\n" + rows(1, 10) + "G61\n" +
                     rows(1, 10) + "G64\nM9\n" + rows(1, 80) + "G1 X3\nX9 Y4\nM5\nX0\nM30\n";
  const MillBlocks blocks = blocks_of_text(text);
  const auto whole = plan_blocks(blocks, mill, at_level(SmoothLevel::good, within));
  const auto parts = plan_in_parts(blocks, mill, within, SmoothLevel::good, 50);
  REQUIRE(whole);
  REQUIRE(parts);
  const auto words = [](const auto& trajectory) {
    std::vector<std::pair<std::size_t, int>> result;
    for (std::size_t b = 0; b < trajectory.program().size(); ++b)
      if (const auto& word = trajectory.program()[b].word; word.letter != '\0')
        result.emplace_back(b, static_cast<int>(word.number));
    return result;
  };
  CHECK(words(*parts) == words(*whole));
  const auto rest = [](const auto& trajectory) {
    double seconds = 0;
    for (const auto& [phase, block] : trajectory.phases())
      if (phase.velocity == 0 && phase.jerk == 0 && phase.acceleration == 0) seconds += phase.duration;
    return seconds;
  };
  CHECK(rest(*parts) == Approx(rest(*whole)));
  const auto stops = [](const auto& trajectory) {
    std::vector<std::size_t> result;
    for (std::size_t b = 0; b < trajectory.program().size(); ++b)
      if (trajectory.program()[b].exact_stop || trajectory.program()[b].pause > 0) result.push_back(b);
    return result;
  };
  CHECK(stops(*parts) == stops(*whole));
}

TEST_CASE("stream: a word without a stop is no reason for one", "[smooth-stream]") {
  std::ostringstream text;
  text << "F1800\n";
  for (int i = 1; i <= 300; ++i) text << "G1 X" << 0.4 * i << " Y" << 0.2 * std::sin(i) << "\n";
  // A place where a word is told, behind each second block: what is held ends with one as often as not.
  MillBlocks blocks;
  for (const MillBlock& block : blocks_of_text(text.str())) {
    blocks.push_back(block);
    if (blocks.size() % 3 != 2) continue;
    MillBlock word = block;
    const Vector3 here = block.path.position_at(block.path.length());
    word.path = path::Line<3>(here, here);
    word.word = {'M', 8};
    blocks.push_back(word);
  }
  const auto slowest = [](const auto& trajectory) {
    double least = 30;
    for (const auto& point : trajectory.samples(1e-3))
      if (point.time > 0.2 && point.time < trajectory.duration() - 0.2)
        least = std::min(least, point.velocity.norm());
    return least;
  };
  const auto whole = plan_blocks(blocks, mill, at_level(SmoothLevel::good, within));
  REQUIRE(whole);
  for (const std::size_t held : {60u, 61u, 62u, 63u}) {
    const auto parts = plan_in_parts(blocks, mill, within, SmoothLevel::good, held);
    REQUIRE(parts);
    CAPTURE(held, slowest(*whole));
    CHECK(slowest(*parts) > 0.5);  // it is 0 at a stop
    CHECK(parts->duration() < 1.1 * whole->duration());
  }
}

TEST_CASE("stream: merged lines", "[smooth-stream]") {
  const MillBlocks blocks = blocks_of_text("G64 P0.01 Q0.004\n" + rows(4, 200));
  const auto parts = plan_in_parts(blocks, mill, within, SmoothLevel::good, 60);
  const auto whole = plan_blocks(blocks, mill, at_level(SmoothLevel::good, within));
  REQUIRE(parts);
  REQUIRE(whole);
  check_motion(*parts, blocks);
  const auto merged = [](const auto& trajectory) {
    std::vector<std::size_t> numbers;
    for (std::size_t b = 0; b < trajectory.program().size(); ++b)
      if (trajectory.program()[b].merged > 0) numbers.push_back(b);
    return numbers;
  };
  CHECK(merged(*parts).size() > blocks.size() / 2);
  CHECK(merged(*parts) == merged(*whole));
}

TEST_CASE("stream: a wall that is touched behind a cut is not passed", "[smooth-stream]") {
  // A wall at Y -0.5: a curve beyond it has no plan. It is touched in a corner far behind the first cuts.
  Machine<3> machine = mill;
  machine.axes[1].low = -0.5;
  std::ostringstream text;
  text << rows(3, 60) << "G1 X0 Y2 Z0\nX-3 Y-0.5\nX-6\nX-9 Y0\n";
  for (int i = 0; i < 100; ++i) text << "G1 X" << -9 - 0.2 * i << " Y" << 0.1 * std::sin(i) << "\n";
  const MillBlocks blocks = blocks_of_text(text.str(), machine);
  for (const std::size_t held : {40u, 70u, 100u, 130u}) {
    CAPTURE(held);
    std::vector<double> ends;
    const auto parts = plan_in_parts(blocks, machine, within, SmoothLevel::good, held, &ends);
    REQUIRE(parts);
    check_motion(*parts, blocks, machine);
    CHECK(cuts(*parts, ends) > 0);
    for (const auto& point : parts->samples(1e-3)) CHECK(point.position[1] > -0.5 - 1e-9);
  }
}

TEST_CASE("stream: the way to rest behind a cut keeps to the travel too", "[smooth-stream]") {
  // Down to a wall, along it and up again: the curve beyond it is not driven, on an approach neither.
  Machine<3> machine = mill;
  machine.axes[1].low = -0.5;
  for (int touch = 20; touch < 75; touch += 5) {
    std::ostringstream text;
    text << std::fixed << "F1800\n";
    for (int i = 1; i <= 150; ++i) {
      const double d = std::abs(i - touch), down = std::clamp(0.08 * (24 - d), 0.0, 0.5);
      text << "G1 X" << 0.3 * i << " Y" << (d > 24 ? 0.05 * std::sin(i) : -down) << "\n";
    }
    const MillBlocks blocks = blocks_of_text(text.str(), machine);
    CAPTURE(touch);
    const auto parts = plan_in_parts(blocks, machine, within, SmoothLevel::good, 40);
    REQUIRE(parts);
    for (const auto& point : parts->samples(1e-3)) REQUIRE(point.position[1] > -0.5 - 1e-9);
  }
}

TEST_CASE("stream: cuts do not become slower from part to part", "[smooth-stream]") {
  // What is held has no room for a gentle ramp up and one down.
  for (const auto& [lines, step, bend, held] :
       {std::tuple(600, 0.1, 0.01, 60u), std::tuple(600, 0.25, 0.1, 60u)}) {
    std::ostringstream text;
    text << std::fixed << "F1800\n";
    for (int i = 1; i <= lines; ++i) text << "G1 X" << step * i << " Y" << bend * std::sin(0.3 * i) << "\n";
    const MillBlocks blocks = blocks_of_text(text.str());
    const auto parts = plan_in_parts(blocks, mill, within, SmoothLevel::good, held);
    const auto whole = plan_blocks(blocks, mill, at_level(SmoothLevel::good, within));
    REQUIRE(parts);
    REQUIRE(whole);
    CAPTURE(step, held);
    CHECK(parts->duration() < 1.1 * whole->duration());
  }
}

TEST_CASE("stream: a block that is refused leaves those before it", "[smooth-stream]") {
  Machine<3> machine = mill;
  machine.axes[0].high = 20;
  MillBlocks blocks = blocks_of_text(rows(1, 60), machine);
  Stream stream(machine, at_level(SmoothLevel::good, within), 40);
  for (const MillBlock& block : blocks) REQUIRE(stream.push(block));
  MillBlock apart = blocks.back();
  apart.path = path::Line<3>(Vector3(5, 5, 5), Vector3(6, 5, 5));
  apart.line = 77;
  const auto refused = stream.push(apart);
  REQUIRE(!refused);
  CHECK(refused.error().error().code == ErrorCode::discontinuous);
  CHECK(refused.error().block == blocks.size());
  CHECK(refused.error().about.line == 77);
  apart.path =
      path::Line<3>(Vector3(blocks.back().path.position_at(blocks.back().path.length())), Vector3(25, 0, 0));
  CHECK(stream.push(apart).error().error().code == ErrorCode::above_limit);
  apart.path = path::Line<3>(Vector3(blocks.back().path.position_at(blocks.back().path.length())),
                             Vector3::Constant(std::nan("")));
  CHECK(!stream.push(apart));
  apart = blocks.back();
  apart.path = path::Line<3>(Vector3(apart.path.position_at(apart.path.length())), Vector3(15, 0, 0));
  for (const double number : {0.0, -1.0, std::nan("")}) {
    MillBlock still = apart;
    still.feed = number;
    CHECK(stream.push(still).error().error().field == "feed");
    still = apart;
    still.pause = number - 1;
    CHECK(stream.push(still).error().error().field == "pause");
  }
  REQUIRE(stream.finish());
  const auto last = stream.take();
  CHECK(last.first_block() + last.program().size() == blocks.size());
  CHECK(last.at(last.duration()).velocity.norm() == 0);
}

TEST_CASE("stream: nothing, and more behind a finish", "[smooth-stream]") {
  Stream stream(mill, at_level(SmoothLevel::good, within), 60);
  REQUIRE(stream.finish());
  CHECK(!stream.ready());
  const MillBlocks blocks = blocks_of_text(rows(4, 60));
  double time = 0;
  for (std::size_t i = 0; i < blocks.size(); ++i) {
    REQUIRE(stream.push(blocks[i]));
    if (i + 1 != blocks.size() / 2 && i + 1 != blocks.size()) continue;
    REQUIRE(stream.finish());
    const auto part = stream.take();
    CHECK(part.first_block() + part.program().size() == i + 1);
    CHECK((part.at(part.duration()).position - blocks[i].path.position_at(blocks[i].path.length())).norm() <
          1e-9);
    CHECK(part.at(part.duration()).velocity.norm() == 0);
    time += part.duration();
  }
  CHECK(time > 0);
}

TEST_CASE("stream: random programs, random memory", "[smooth-stream]") {
  test::Random random;
  for (int round = 0; round < 6; ++round) {
    std::ostringstream text;
    text << "F1800\n";
    Vector3 at = Vector3::Zero(), way = Vector3::UnitX();
    const double longest = random.log_uniform(0.05, 3);
    for (int i = 0; i < 200; ++i) {
      const Vector3 any(random.uniform(-1, 1), random.uniform(-1, 1), random.uniform(-0.3, 0.3));
      way = (way + random.uniform(0, 0.8) * any).normalized();
      at += random.log_uniform(longest / 20, longest) * way;
      text << (random.integer(0, 20) == 0 ? "G0" : "G1") << " X" << at[0] << " Y" << at[1] << " Z" << at[2]
           << " F" << random.integer(300, 1800) << "\n";
    }
    const auto held = static_cast<std::size_t>(random.integer(40, 120));
    INFO("seed " << test::seed() << " round " << round << " held " << held << "\n" << text.str());
    const MillBlocks blocks = blocks_of_text(text.str());
    const auto parts = plan_in_parts(blocks, mill, within, SmoothLevel::good, held);
    REQUIRE(parts);
    check_motion(*parts, blocks);
  }
}
