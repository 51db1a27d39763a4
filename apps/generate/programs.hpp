// Programs of the kinds and sizes that KK22 machined (section 4): its own are not printed. Arcs in R format,
// no F.
#pragma once

#include <array>
#include <cmath>
#include <cstdint>
#include <cstdio>
#include <numbers>
#include <ostream>
#include <random>
#include <string_view>

namespace cncplan::generate {

/// Block to sphere, layer by layer in rounded squares; the sphere's skin in 35000 short moves; a circular
/// pocket.
enum class Kind : std::uint8_t { roughing, finishing, pocket };

/// Kind by the name that the command line uses. False for another name.
inline bool parse(std::string_view name, Kind& kind) {
  constexpr std::array<std::string_view, 3> names{"roughing", "finishing", "pocket"};
  for (std::size_t i = 0; i < names.size(); ++i)
    if (names[i] == name) {
      kind = static_cast<Kind>(i);
      return true;
    }
  return false;
}

/// Moves written in the axes of a plane, so that one program serves G17, G18 and G19. Coordinates have four
/// decimals.
class Mill {
 public:
  Mill(std::ostream& stream, int plane)
      : stream_(stream),
        letters_(plane == 18   ? "ZXY"
                 : plane == 19 ? "YZX"
                               : "XYZ") {
    stream_ << "%\nG" << plane << " G21 G40 G49 G54 G80 G90 G94\nT1 M6\nS12000 M3\n";
  }

  void rapid(double a, double b, double c) { write("G0", {a, b, c}, 0.0); }
  void line(double a, double b, double c) { write("G1", {a, b, c}, 0.0); }
  /// An arc of at most half a turn.
  void arc(bool clockwise, double a, double b, double c, double radius) {
    write(clockwise ? "G2" : "G3", {a, b, c}, radius);
  }
  void end() { stream_ << "M5\nM30\n%\n"; }

 private:
  void write(const char* code, const std::array<double, 3>& place, double radius) {
    std::array<char, 128> text;
    int length = std::snprintf(text.data(), text.size(), "%s %c%.4f %c%.4f %c%.4f", code, letters_[0],
                               tidy(place[0]), letters_[1], tidy(place[1]), letters_[2], tidy(place[2]));
    stream_.write(text.data(), length);
    if (radius > 0.0) {
      length = std::snprintf(text.data(), text.size(), " R%.4f", radius);
      stream_.write(text.data(), length);
    }
    stream_ << '\n';
  }

  /// No "-0.0000".
  static double tidy(double number) { return std::abs(number) < 5e-5 ? 0.0 : number; }

  std::ostream& stream_;
  std::string_view letters_;
};

/// Random numbers that are the same on every standard library.
class Dice {
 public:
  explicit Dice(std::uint64_t seed) : engine_(seed) {}
  double uniform(double low, double high) {
    return low + (high - low) * static_cast<double>(engine_() >> 11U) * 0x1p-53;
  }

 private:
  std::mt19937_64 engine_;
};

/// 25 layers of 5 rings of 12 moves, 4 of them arcs: 1500 moves, 500 arcs. The rings go from the block's
/// square towards the sphere's circle, but keep corners: this is the roughing.
inline void write_roughing(Mill& mill, Dice& dice) {
  constexpr double block = 20.0;   // half the block's side, mm
  constexpr double sphere = 18.0;  // mm
  constexpr double safe = 5.0;
  for (int layer = 1; layer <= 25; ++layer) {
    const double depth = sphere * (layer - dice.uniform(0.2, 0.4)) / 25.0;
    const double circle = std::sqrt(depth * (2.0 * sphere - depth));
    for (int ring = 0; ring < 5; ++ring) {
      const double half = block + (circle - block) * (ring + dice.uniform(-0.1, 0.1)) / 4.0;
      const double corner = std::round(1e4 * half * (0.2 + 0.15 * ring) * dice.uniform(0.95, 1.05)) * 1e-4;
      const double flat = half - corner;
      mill.rapid(-half, 0.0, safe);
      mill.line(-half, 0.0, -depth);
      mill.line(-half, flat, -depth);
      mill.arc(true, -flat, half, -depth, corner);
      mill.line(flat, half, -depth);
      mill.arc(true, half, flat, -depth, corner);
      mill.line(half, -flat, -depth);
      mill.arc(true, flat, -half, -depth, corner);
      mill.line(-flat, -half, -depth);
      mill.arc(true, -half, -flat, -depth, corner);
      mill.line(-half, 0.0, -depth);
      mill.rapid(-half, 0.0, safe);
    }
  }
}

/// Rings of chords from the pole to the equator, 35000 moves; a small arc leads from each ring to the next.
inline void write_finishing(Mill& mill, Dice& dice) {
  constexpr double sphere = 18.0;
  constexpr int rings = 150;
  constexpr int moves = 35000 - 2;  // down and up
  const auto polar = [](int ring) { return ring * std::numbers::pi / 2.0 / rings; };
  double all = 0.0;
  for (int ring = 1; ring <= rings; ++ring) all += std::sin(polar(ring));
  double share = 0.0;
  int made = 0;
  double angle = dice.uniform(0.0, 2.0 * std::numbers::pi);
  mill.rapid(0.0, 0.0, 5.0);
  for (int ring = 1; ring <= rings; ++ring) {
    const double radius = sphere * std::sin(polar(ring));
    const double height = sphere * (std::cos(polar(ring)) - 1.0);
    const double step = sphere * std::numbers::pi / 2.0 / rings;
    share += std::sin(polar(ring)) / all * moves;
    const int chords = static_cast<int>(std::round(share)) - made - 1;
    mill.arc(false, radius * std::cos(angle), radius * std::sin(angle), height, step);
    for (int i = 1; i <= chords; ++i) {
      const double turned = angle + 2.0 * std::numbers::pi * i / chords;
      mill.line(radius * std::cos(turned), radius * std::sin(turned), height);
    }
    made += chords + 1;
    angle += dice.uniform(-0.01, 0.01) / ring;
  }
  mill.rapid(0.0, 0.0, 5.0);
}

/// 10 layers of 20 rings of 6 moves, 4 of them arcs: 1200 moves, 800 arcs. Rings take turns between four
/// quarters of a circle and two rounds of two halves each: exact semicircles, where R format is at its worst.
inline void write_pocket(Mill& mill, Dice& dice) {
  for (int layer = 1; layer <= 10; ++layer) {
    const double depth = -0.5 * layer;
    for (int ring = 1; ring <= 20; ++ring) {
      const double radius = std::round(1e3 * (1.25 * ring + dice.uniform(-0.1, 0.1))) * 1e-3;
      if (ring == 1) {
        mill.rapid(0.0, 0.0, 5.0);
      } else {
        mill.line(radius - 0.7, -0.2, depth);
      }
      mill.line(radius, 0.0, depth);
      if (ring % 2 == 0) {
        mill.arc(false, 0.0, radius, depth, radius);
        mill.arc(false, -radius, 0.0, depth, radius);
        mill.arc(false, 0.0, -radius, depth, radius);
        mill.arc(false, radius, 0.0, depth, radius);
      } else {
        for (int round = 0; round < 2; ++round) {
          mill.arc(false, -radius, 0.0, depth, radius);
          mill.arc(false, radius, 0.0, depth, radius);
        }
      }
    }
  }
}

/// The whole program; the same for the same seed.
inline void write(std::ostream& stream, Kind kind, std::uint64_t seed = 2022, int plane = 17) {
  Mill mill(stream, plane);
  Dice dice(seed);
  if (kind == Kind::roughing) write_roughing(mill, dice);
  if (kind == Kind::finishing) write_finishing(mill, dice);
  if (kind == Kind::pocket) write_pocket(mill, dice);
  mill.end();
}

}  // namespace cncplan::generate
