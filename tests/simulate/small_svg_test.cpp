// Pictures with less text: what is left out, what stays, and where the lines are then.
#include "support/small_svg.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdlib>
#include <numbers>
#include <string>
#include <vector>

#include "support/catch.hpp"

namespace {

struct Point {
  double x{}, y{};
};

// Of the first path of a picture, whose `d` is numbers with M, L, commas and blanks between them.
std::vector<Point> points_of(const std::string& svg) {
  const std::size_t from = svg.find(" d='") + 4, end = svg.find('\'', from);
  std::string text = svg.substr(from, end - from);
  std::replace_if(
      text.begin(), text.end(), [](char c) { return c == 'M' || c == 'L' || c == ','; }, ' ');
  std::vector<Point> points;
  char* at = text.data();
  for (;;) {
    char* next = nullptr;
    const double x = std::strtod(at, &next);
    if (next == at) return points;
    points.push_back({x, std::strtod(next, &at)});
  }
}

double distance(Point p, const std::vector<Point>& line) {
  double least = INFINITY;
  for (std::size_t i = 1; i < line.size(); ++i) {
    const Point a = line[i - 1], b = line[i];
    const double dx = b.x - a.x, dy = b.y - a.y, square = dx * dx + dy * dy;
    const double part =
        square > 0 ? std::clamp(((p.x - a.x) * dx + (p.y - a.y) * dy) / square, 0.0, 1.0) : 0.0;
    least = std::min(least, std::hypot(a.x + part * dx - p.x, a.y + part * dy - p.y));
  }
  return least;
}

}  // namespace

TEST_CASE("a curve of a small picture is within 0.2 px of what it was, with fewer points") {
  std::vector<Point> curve;
  std::string svg = "<svg><path stroke='black' d='";
  for (int i = 0; i <= 2000; ++i) {
    const double angle = 2 * std::numbers::pi * i / 2000;
    curve.push_back({400 + 300 * std::cos(angle), 300 + 200 * std::sin(3 * angle)});
    svg += (i == 0 ? "M" : " L") + std::to_string(curve.back().x) + "," + std::to_string(curve.back().y);
  }
  const auto small = points_of(support::small_svg(svg + "'/></svg>"));
  CHECK(small.size() > 100);
  CHECK(small.size() < 700);
  double most = 0.0;
  for (const Point p : curve) most = std::max(most, distance(p, small));
  CHECK(most < 0.2);  // 0.1 for points left out, and what two decimals less move the ends
  CHECK(std::hypot(small.back().x - 700, small.back().y - 300) < 0.1);
}

TEST_CASE("parts of a path stay apart, and so do the corners of a small picture") {
  CHECK(support::small_svg("<path d='M1,1 L2,1 L3,1  M5,5 L6,5 L6,9'/>") ==
        "<path d='M1.0,1.0 3.0,1.0M5.0,5.0 6.0,5.0 6.0,9.0'/>");
}

TEST_CASE("what a small picture does not know stays as it is") {
  const std::string curve = "<path d='M1,1 C2,2 3,3 4,4'/>", text = "<text x='1'>a &lt; b</text>";
  CHECK(support::small_svg(curve) == curve);
  CHECK(support::small_svg(text) == text);
  CHECK(support::small_svg("<svg") == "<svg");
  CHECK(support::small_svg("") == "");
}

TEST_CASE("empty groups go, those with something in them stay") {
  CHECK(support::small_svg("<g id='a'>\n<g id='b'>\n</g>\n</g><g id='c'>\n<text>x</text>\n</g>") ==
        "<g id='c'>\n<text>x</text>\n</g>");
}

TEST_CASE("dots of one colour become one path") {
  const auto dot = [](const char* x, const char* color) {
    return std::string("<use xlink:href='#gpDot' x='") + x + "' y='2' color='" + color + "'/>";
  };
  const std::string small = support::small_svg(dot("1", "red") + dot("2.04", "red") + dot("3", "blue"));
  CHECK(small ==
        "<path stroke='red' stroke-width='1.2' stroke-linecap='round' d='M1.0,2.0h0M2.0,2.0h0'/>"
        "<path stroke='blue' stroke-width='1.2' stroke-linecap='round' d='M3.0,2.0h0'/>");
}
