// Real programs, stepped block by block: every block ends on its rounded target, in order of time.
#include <array>
#include <cmath>
#include <cstdint>
#include <filesystem>
#include <fstream>
#include <sstream>
#include <string>
#include <vector>

#include "cncplan/path/arc_from_center.hpp"
#include "cncplan/path/segment.hpp"
#include "cncplan/step/merge.hpp"
#include "doubles.hpp"
#include "support/catch.hpp"
#include "support/shared.hpp"

using namespace cncplan;

namespace {

// The moves of a list of canonical motions as LinuxCNC prints it, in mm.
std::vector<path::Segment<3>> moves(const std::filesystem::path& file) {
  std::vector<path::Segment<3>> result;
  std::ifstream in(file);
  Vector3 at = Vector3::Zero();
  double unit = 1.0;
  Plane plane = Plane::xy;
  for (std::string line; std::getline(in, line);) {
    const auto open = line.find('(');
    if (open == std::string::npos) continue;
    const std::string text = line.substr(open + 1);
    const std::string name = line.substr(0, open).substr(line.find_first_not_of(" 0123456789N."));
    std::istringstream words(text);
    std::vector<double> v;
    for (double x = 0; words >> x; words.ignore(1)) v.push_back(x * unit);
    if (name == "USE_LENGTH_UNITS") unit = text.find("INCH") != std::string::npos ? 25.4 : 1.0;
    if (name == "SELECT_PLANE")
      plane = text.find("XY") != std::string::npos   ? Plane::xy
              : text.find("XZ") != std::string::npos ? Plane::zx
                                                     : Plane::yz;
    if (name == "STRAIGHT_TRAVERSE" || name == "STRAIGHT_FEED") {
      const Vector3 to(v.at(0), v.at(1), v.at(2));
      result.push_back(path::Line<3>(at, to));
      at = to;
    }
    if (name == "ARC_FEED") {
      const PlaneAxes a = axes(plane);
      Vector3 to, center = Vector3::Zero();
      to(a.first) = v.at(0), to(a.second) = v.at(1), to(a.third) = v.at(5);
      center(a.first) = v.at(2), center(a.second) = v.at(3);
      const double turns = v.at(4) / unit;
      const auto arc =
          path::arc_from_center(at, to, center, turns > 0 ? Turn::counterclockwise : Turn::clockwise, plane,
                                {}, static_cast<int>(std::abs(turns)) - 1);
      if (!arc) FAIL(file << ": an arc is refused: " << line);
      result.push_back(*arc);
      at = to;
    }
  }
  return result;
}

}  // namespace

TEST_CASE("every block of the LinuxCNC programs ends on its rounded target") {
  const auto shared = test::shared();
  if (!shared) {
    WARN("SKIPPED: CNCPLAN_SHARED is not set");
    return;
  }
  int programs = 0;
  for (const auto& entry : std::filesystem::directory_iterator(*shared + "/data/ngc")) {
    if (entry.path().extension() != ".motions") continue;
    ++programs;
    const std::vector<path::Segment<3>> program = moves(entry.path());
    CAPTURE(entry.path().filename().string(), program.size());
    REQUIRE(program.size() > 20);
    const std::array per_unit{400.0, 160.0, 787.4};
    std::array<std::int64_t, 3> counts{};
    for (int i = 0; i < 3; ++i)
      counts[static_cast<std::size_t>(i)] =
          step::count_at(program.front().start()(i) * per_unit[static_cast<std::size_t>(i)]);
    double start = 0.0, last = 0.0;
    std::int64_t edges = 0;
    int off_target = 0, out_of_order = 0, late = 0;
    for (std::size_t b = 0; b < program.size(); ++b) {
      const path::Segment<3>& block = program[b];
      if (block.length() == 0.0) continue;
      // Half of the blocks at one speed, half from rest to rest.
      const auto steady = test::steady(block.length(), 20.0);
      const auto resting = test::rest_to_rest(block.length(), 1e4);
      const std::span<const Phase> phases =
          b % 2 == 0 ? std::span<const Phase>(steady) : std::span<const Phase>(resting);
      const double end = start + phases.back().time + phases.back().duration;
      auto source = step::block_edges(block, step::PhaseClock<double>(phases, start), per_unit, counts, last);
      while (const auto edge = source.next()) {
        out_of_order += edge->time < last;
        last = edge->time;
        ++edges;
      }
      late += last > end * (1 + 1e-14);
      counts = step::counts(source);
      start = end;
      for (std::size_t i = 0; i < 3; ++i) {
        const double target = block.end()(static_cast<int>(i)) * per_unit[i];
        off_target += std::abs(target - static_cast<double>(counts[i])) > 0.5;
      }
    }
    CHECK(edges > 1000);
    CHECK(off_target == 0);
    CHECK(out_of_order == 0);
    CHECK(late == 0);
  }
  CHECK(programs == 8);
}
