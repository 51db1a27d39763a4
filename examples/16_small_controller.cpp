// A small controller: lines of G-code come in, set points go out at every millisecond; a hold takes effect at
// once, and so does an override of 150 %. Compiled with -fno-exceptions -fno-rtti; once it runs (the reader's
// tables are made before main) there is no allocation.
#include <algorithm>
#include <array>
#include <cmath>
#include <cncplan/gcode/reader.hpp>
#include <cncplan/junction/deviation.hpp>
#include <cncplan/plan/block_builder.hpp>
#include <cncplan/plan/cells.hpp>
#include <cncplan/plan/player/player.hpp>
#include <cstdio>

using namespace cncplan;

namespace {

const Machine<3> mill{.limits = {.velocity = 30.0, .acceleration = 1000.0, .jerk = 10000.0},
                      .rapid_rate = 50.0};
constexpr std::array<std::string_view, 5> lines{"G21 G90 G17 F1200", "G1 X20", "G3 X25 Y5 R5", "G1 Y15",
                                                "M30"};

// All memory that it needs.
constexpr std::size_t room = 16;
std::array<Block<3>, room> blocks;
std::array<plan::PlayedBlock, room> played;
std::array<plan::BlockCaps, room> ahead;
std::array<plan::Gate, room + 1> gates, spare_gates;
gcode::Reader reader;
BlockBuilder<Machine<3>> builder(mill, dialect_of(mill));
plan::Player player({played, ahead, gates, spare_gates});
std::size_t pushed = 0;
int ticks = 0;

// The timer's interrupt.
void tick() {
  if (ticks == 300) player.hold();
  if (ticks == 500) player.resume();
  if (ticks == 700) player.feed_override(1.5);
  const plan::Played now = player.tick(0.001);
  if (now.block >= 0 && ticks % 50 == 0) {
    const path::Segment<3>& path = blocks[static_cast<std::size_t>(now.block) % room].path;
    const Vector3 point = path.position_at(now.along);
    std::printf("%5d ms %9.4f %9.4f mm %8.3f mm/s\n", ticks, point.x(), point.y(), now.velocity);
  }
  ++ticks;
}

// What look-ahead needs to know of a block behind another, which may be none.
plan::BlockCaps caps_of(const Block<3>& block, const Block<3>* before) {
  const double length = block.path.length();
  const Limits along = plan::limits_along(block.path.bounds(0.0, length), mill, rapid_speed(mill),
                                          mill.limits.velocity, length);
  if (before == nullptr || before->exact_stop || !(length > 0.0)) return {length, 0.0, along, block.pause};
  const auto tool = tool_axes(mill);
  const junction::Geometry joint{plan::tool_side<Machine<3>>(*before, true, tool),
                                 plan::tool_side<Machine<3>>(block, false, tool), mill.limits};
  return {length, std::sqrt(junction::Deviation{0.01}.speed_sq(joint)), along, block.pause};
}

// Waits for room, while the machine runs. Caps say what the machine bears, whatever the program's feed: so
// far an override may go. Rapids have an override of their own, up to their rate.
void run(const Block<3>& block) {
  const Block<3>* before = pushed == 0 ? nullptr : &blocks[(pushed + room - 1) % room];
  auto caps = caps_of(block, before);
  if (!block.rapid) caps.limits.velocity = std::min(caps.limits.velocity, mill.limits.velocity);
  const double feed = std::min(block.feed, rapid_speed(mill));
  while (!player.push({.caps = caps, .feed = feed, .rapid = block.rapid})) tick();
  blocks[pushed++ % room] = block;
}

}  // namespace

int main() {
  std::array<gcode::Item, gcode::max_items_per_line> items;
  for (const std::string_view line : lines) {
    const auto read = reader.read_line(line, items.begin());
    if (!read) return 1;
    for (auto end = *read;; end = reader.go_on(items.begin())) {
      for (auto item = items.begin(); item != end; ++item) {
        const auto block = builder.take(*item);
        if (!block) return 1;
        if (*block) run(**block);
      }
      if (!reader.busy()) break;  // a canned cycle has more steps
    }
  }
  while (!player.finished()) tick();
  std::printf("done after %d ms\n", ticks);
}
