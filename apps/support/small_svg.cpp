#include "support/small_svg.hpp"

#include <fmt/format.h>

#include <cmath>
#include <cstddef>
#include <cstdlib>
#include <vector>

namespace support {

namespace {

struct Point {
  double x{}, y{};
};

// px from the straight way between two places.
double distance(Point p, Point from, Point to) {
  const double dx = to.x - from.x, dy = to.y - from.y, square = dx * dx + dy * dy;
  double part = square > 0.0 ? ((p.x - from.x) * dx + (p.y - from.y) * dy) / square : 0.0;
  part = part < 0.0 ? 0.0 : part > 1.0 ? 1.0 : part;
  return std::hypot(from.x + part * dx - p.x, from.y + part * dy - p.y);
}

// A line through the points that it cannot do without.
void put_line(std::string& out, const std::vector<Point>& points) {
  constexpr double near = 0.1;
  constexpr std::size_t most = 100;  // left out one after the other
  const auto put = [&](const char* before, Point p) {
    out += fmt::format("{}{:.1f},{:.1f}", before, p.x, p.y);
  };
  for (std::size_t from = 0, i = 0; i < points.size(); ++i) {
    if (i == 0) {
      put("M", points[i]);
      continue;
    }
    bool needed = i + 1 == points.size() || i - from >= most;
    for (std::size_t k = from + 1; k <= i && !needed; ++k)
      needed = distance(points[k], points[from], points[i + 1]) > near;
    if (!needed) continue;
    put(" ", points[i]);
    from = i;
  }
}

// What a `d` says where it is made of straight lines; else as it is.
std::string small_path(std::string_view text) {
  std::string out;
  std::vector<Point> points;
  const std::string copy(text);  // ends with a zero
  for (const char* at = copy.c_str(); *at != '\0';) {
    if (*at == ' ' || *at == '\n' || *at == '\t') {
      ++at;
      continue;
    }
    if (*at != 'M' && *at != 'L') return copy;
    if (*at == 'M') {
      put_line(out, points);
      points.clear();
    }
    char* end = nullptr;
    const double x = std::strtod(at + 1, &end);
    if (*end != ',') return copy;
    points.push_back({x, std::strtod(end + 1, &end)});
    at = end;
  }
  put_line(out, points);
  return out;
}

// The value of an attribute of a tag.
std::string_view attribute(std::string_view tag, std::string_view name) {
  const std::size_t at = tag.find(fmt::format(" {}='", name));
  if (at == std::string_view::npos) return {};
  const std::size_t from = at + name.size() + 3;
  return tag.substr(from, tag.find('\'', from) - from);
}

// Takes the last tag away where the text ends with one that opens a group, and says so.
bool close_empty_group(std::string& out) {
  const std::size_t last = out.rfind('<');
  if (last == std::string::npos || out.compare(last, 3, "<g ") != 0) return false;
  if (out.find_last_not_of('\n') != out.find('>', last)) return false;
  out.resize(last);
  return true;
}

// Adds a dot to the path that the text ends with, if that is one of the same colour, or to one of its own.
void put_dot(std::string& out, std::string_view tag, std::string_view last_color) {
  const auto number = [&](std::string_view name) {
    return std::strtod(std::string(attribute(tag, name)).c_str(), nullptr);
  };
  const std::string_view color = attribute(tag, "color"), end = "'/>";
  if (!color.empty() && color == last_color)
    out.resize(out.rfind(end));
  else
    out += fmt::format("<path stroke='{}' stroke-width='1.2' stroke-linecap='round' d='", color);
  out += fmt::format("M{:.1f},{:.1f}h0{}", number("x"), number("y"), end);
}

void put_path(std::string& out, std::string_view tag) {
  const std::string_view lines = attribute(tag, "d");
  const std::size_t at = lines.empty() ? 0 : static_cast<std::size_t>(lines.data() - tag.data());
  out += tag.substr(0, at);
  out += small_path(lines);
  out += tag.substr(at + lines.size());
}

}  // namespace

std::string small_svg(std::string_view svg) {
  std::string out;
  std::string_view dots;  // the colour of the path of dots that the text ends with
  while (!svg.empty()) {
    const std::string_view between = svg.substr(0, svg.find('<'));
    svg.remove_prefix(between.size());
    if (between.find_first_not_of(" \t\n") != std::string_view::npos)
      out += between;
    else if (!between.empty() && !out.ends_with('\n'))
      out += '\n';
    const std::string_view tag = svg.substr(0, svg.find('>') + 1);
    if (tag.empty()) break;
    svg.remove_prefix(tag.size());
    const bool dot = tag.starts_with("<use xlink:href='#gpDot'");
    if (dot)
      put_dot(out, tag, dots);
    else if (tag.starts_with("<path"))
      put_path(out, tag);
    else if (tag != "</g>" || !close_empty_group(out))
      out += tag;
    dots = dot ? attribute(tag, "color") : std::string_view();
  }
  return out += svg;
}

}  // namespace support
