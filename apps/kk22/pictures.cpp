#include <fmt/format.h>

#include <algorithm>
#include <vector>

#include "experiments.hpp"
#include "table_programs.hpp"

namespace kk22 {

using namespace cncplan;

namespace {

// Lines and arcs of a program as two sets of data, arcs by nine points.
void put(support::Gnuplot& plot, const std::vector<MillBlock>& blocks) {
  for (const bool arcs : {false, true}) {
    plot("${} << EOD\n", arcs ? "arcs" : "lines");
    for (const MillBlock& block : blocks) {
      if ((block.path.arc() != nullptr) != arcs) continue;
      const int parts = arcs ? 8 : 1;
      for (int i = 0; i <= parts; ++i) {
        const Vector3 place = block.path.position_at(block.path.length() * i / parts);
        plot("{:.5g} {:.5g} {:.5g}\n", place.x(), place.y(), place.z());
      }
      plot("\n\n");
    }
    plot("EOD\n");
  }
}

// The blocks' count, and how many of them are arcs.
std::string drawn(support::Gnuplot* plot, const char* picture, generate::Kind kind) {
  const auto blocks = blocks_of(kind);
  const auto arcs = std::count_if(blocks.begin(), blocks.end(),
                                  [](const auto& block) { return block.path.arc() != nullptr; });
  if (plot != nullptr) {
    put(*plot, blocks);
    (*plot)("set terminal svg size 700,560 background 'white'\n");
    plot->picture(picture);
    (*plot)(
        "set key top\nset view 50,30\nset xlabel 'X, mm'\nset ylabel 'Y, mm'\nset zlabel 'Z'\n"
        "splot $lines with lines lc '#1fb5b5' title 'lines', $arcs with lines lc '#1a9641' title 'arcs'\n"
        "unset zlabel\n");
  }
  return fmt::format("{} lines, {} arcs", blocks.size() - static_cast<std::size_t>(arcs), arcs);
}

}  // namespace

void pictures(support::Gnuplot* plot) {
  fmt::print(
      "## Figs. 12, 13 and 16: the machine, the screen and the parts\n\n| | KK22 | here |\n|---|---|---|\n"
      "| 12 | photographs of the machine and its control unit | none: no machine was run |\n"
      "| 13a | the roughing program on the screen, lines and arcs in two colours | {}, of a program of our "
      "own |\n"
      "| 13b, c | photographs of the roughed and the finished sphere | none: no part was cut |\n"
      "| 16a | the pocket program on the screen | {}, of a program of our own |\n"
      "| 16b | a photograph of the pocket, and what a caliper measured | none: no part was cut |\n\n",
      drawn(plot, "kk22_figure13a.svg", generate::Kind::roughing),
      drawn(plot, "kk22_figure16a.svg", generate::Kind::pocket));
}

}  // namespace kk22
