// The flat program: its lines as they stand, and what each asks for.
#pragma once

#include <string>
#include <vector>

#include "cncplan/cncplan.hpp"

namespace tire_mold {

using namespace cncplan::tire_mold;  // the library's part of it

/// One motion of the artwork, in its own coordinates.
struct Move {
  ArtworkPath segment;
  double feed{};  ///< mm/s; 0 for a feed move without any F so far
  bool rapid{};
  bool exact_stop{};
  int column{};
};

struct Line {
  std::string text;
  std::vector<cncplan::gcode::Word> words;  ///< with their columns, in order
  std::vector<Move> moves;
  double pause = 0.0;  ///< s
  bool stops = false;  ///< M0, M1, M2, M6, M30
};

struct Artwork {
  std::string file;
  std::vector<Line> lines;
};

/// Reads a program. Throws `Failure` for text that is not understood, and for codes whose positions are not
/// those of the artwork (G28, G30, G53, G92, work offsets, inverse time).
[[nodiscard]] Artwork read_artwork(const std::string& file, const cncplan::gcode::Dialect& dialect);

}  // namespace tire_mold
