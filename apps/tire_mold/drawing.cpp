#include "drawing.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <string_view>
#include <utility>

#include "cncplan/tire_mold/wall_cutter.hpp"
#include "dxf.hpp"
#include "support/failure.hpp"

namespace tire_mold {

namespace {

using namespace cncplan;
using kinematics::Drawn;
using kinematics::DrawnArc;
using kinematics::DrawnLine;
using kinematics::Vector2;
using support::Exit;
using support::Failure;

constexpr double radians = std::numbers::pi / 180.0;

// The side of a polyline: an arc where it bulges by the tangent of a quarter of its angle.
Drawn side(const Vector2& from, const Vector2& to, double bulge) {
  if (bulge == 0.0) return DrawnLine{from, to};
  const Vector2 way = to - from;
  const Vector2 left(-way.y(), way.x());
  const Vector2 center = (from + to) / 2.0 + left * ((1.0 - bulge * bulge) / (4.0 * bulge));
  const double radius = way.norm() * (1.0 + bulge * bulge) / (4.0 * std::abs(bulge));
  return DrawnArc{center, radius, std::atan2(from.y() - center.y(), from.x() - center.x()),
                  4.0 * std::atan(bulge)};
}

struct Corner {
  Vector2 point;
  double bulge{};
};

// Group codes (DXF reference, ENTITIES section).
enum Code {
  x = 10,
  y = 20,
  z = 30,
  end_x = 11,
  end_y = 21,
  end_z = 31,
  elevation = 38,
  radius = 40,
  bulge = 42,
  start_angle = 50,
  end_angle = 51,
  flags = 70,
  up_x = 210,
  up_y = 220,
  up_z = 230
};

class Collector {
 public:
  Collector(const std::string& file, Drawing& drawing) : file_(file), drawing_(drawing) {}

  void take(const DxfEntity& entity) {
    entity_ = &entity;
    name_ = fmt::format("entity {} ({})", ++count_, entity.type);
    if (number(up_x) != 0.0 || number(up_y) != 0.0 || number(up_z, 1.0) <= 0.0 || number(z) != 0.0 ||
        number(end_z) != 0.0 || number(elevation) != 0.0)
      refuse("is not drawn in the plane of X and Y");
    if (entity.type == "LINE") {
      add(DrawnLine{{needed(x), needed(y)}, {needed(end_x), needed(end_y)}});
    } else if (entity.type == "ARC") {
      double sweep = std::fmod(needed(end_angle) - needed(start_angle), 360.0);
      if (sweep <= 0.0) sweep += 360.0;
      add(DrawnArc{{needed(x), needed(y)}, needed(radius), needed(start_angle) * radians, sweep * radians});
    } else if (entity.type == "CIRCLE") {
      add(DrawnArc{{needed(x), needed(y)}, needed(radius), 0.0, 360.0 * radians});
    } else if (entity.type == "LWPOLYLINE") {
      add(corners_of(entity.pairs), closed());
    } else if (entity.type == "POLYLINE") {
      constexpr int other_than_flat = 0x02 | 0x04 | 0x08 | 0x10 | 0x40;
      if ((static_cast<int>(number(flags)) & other_than_flat) != 0)
        refuse("is a mesh or a fitted curve, not a chain of lines and arcs");
      std::vector<Corner> corners;
      for (const auto& vertex : entity.vertices) {
        const auto corner = corners_of(vertex);
        corners.insert(corners.end(), corner.begin(), corner.end());
      }
      add(corners, closed());
    } else {
      leave_out(entity.type);
    }
  }

 private:
  [[noreturn]] void refuse(std::string_view why) const {
    throw Failure(Exit::bad_input, fmt::format("{}:{}:1: error: {} {}", file_, entity_->line, name_, why));
  }

  [[nodiscard]] double number(int code, double otherwise = 0.0) const {
    const auto pair = std::find_if(entity_->pairs.begin(), entity_->pairs.end(),
                                   [code](const DxfPair& p) { return p.code == code; });
    return pair == entity_->pairs.end() ? otherwise : dxf_number(file_, *pair);
  }
  [[nodiscard]] double needed(int code) const {
    const double value = number(code, std::numeric_limits<double>::quiet_NaN());
    if (std::isnan(value)) refuse(fmt::format("has no group code {}", code));
    return value;
  }
  [[nodiscard]] bool closed() const { return (static_cast<int>(number(flags)) & 1) != 0; }

  // A corner begins with its X; what follows belongs to it.
  [[nodiscard]] std::vector<Corner> corners_of(const std::vector<DxfPair>& pairs) const {
    std::vector<Corner> corners;
    for (const DxfPair& pair : pairs) {
      if (pair.code == x) corners.emplace_back();
      if (corners.empty()) continue;
      if (pair.code == x) corners.back().point.x() = dxf_number(file_, pair);
      if (pair.code == y) corners.back().point.y() = dxf_number(file_, pair);
      if (pair.code == bulge) corners.back().bulge = dxf_number(file_, pair);
      if (pair.code == z && dxf_number(file_, pair) != 0.0) refuse("is not drawn in the plane of X and Y");
    }
    return corners;
  }

  void add(const Drawn& drawn) { add(drawn, name_); }
  void add(const Drawn& drawn, const std::string& name) {
    const auto* arc = std::get_if<DrawnArc>(&drawn);
    if (arc != nullptr && !(arc->radius > 0.0)) refuse("has no radius greater than zero");
    drawing_.drawn.push_back(drawn);
    drawing_.origins.push_back({name, entity_->line});
  }

  void add(const std::vector<Corner>& corners, bool closed) {
    if (corners.size() < 2) refuse("has fewer than two corners");
    const std::size_t sides = corners.size() - (closed ? 0 : 1);
    for (std::size_t i = 0; i < sides; ++i) {
      const Corner& from = corners[i];
      const Corner& to = corners[(i + 1) % corners.size()];
      if (closed && i + 1 == sides && from.point == to.point) continue;  // closed twice over
      add(side(from.point, to.point, from.bulge), fmt::format("{}, side {}", name_, i + 1));
    }
  }

  void leave_out(std::string_view type) const {
    constexpr std::array<std::string_view, 7> annotations{"TEXT",   "MTEXT", "DIMENSION", "POINT",
                                                          "LEADER", "HATCH", "VIEWPORT"};
    if (std::find(annotations.begin(), annotations.end(), type) == annotations.end())
      refuse("is not supported: a profile is made of LINE, ARC, CIRCLE, LWPOLYLINE and POLYLINE");
    fmt::print(stderr, "{}:{}:1: warning: {} is left out\n", file_, entity_->line, name_);
  }

  const std::string& file_;
  Drawing& drawing_;
  const DxfEntity* entity_ = nullptr;
  int count_ = 0;
  std::string name_;
};

std::string sentence(const std::string& file, const kinematics::ChainError& error, const Drawing& drawing) {
  if (drawing.origins.empty()) return fmt::format("{}:1:1: error: there is no line and no arc in it", file);
  const Origin& entity = drawing.origins[error.entity];
  const std::string text = fmt::format("{}:{}:1: error: {} ", file, entity.line, entity.name);
  const std::string other = error.other ? drawing.origins[*error.other].name : "";
  switch (error.error.code) {
    case ErrorCode::unconnected:
      return text + fmt::format("is not connected to the others: the nearest is {}, {:.6g} mm away", other,
                                error.error.value);
    case ErrorCode::branching:
      return text + fmt::format("meets more than one other at one end, {} among them", other);
    case ErrorCode::duplicate:
      return text + fmt::format("is there twice: {} is the same", other);
    case ErrorCode::below_limit:
      return text + fmt::format("is {:.6g} mm long, no more than the chain tolerance", error.error.value);
    default:
      return text + std::string(message(error.error.code));
  }
}

}  // namespace

Drawing read_drawing(const std::string& file) {
  Drawing drawing;
  Collector collector(file, drawing);
  for (const DxfEntity& entity : read_dxf_entities(file)) collector.take(entity);
  return drawing;
}

kinematics::ProfileChain profile_of(const std::string& file, const kinematics::ChainOptions& options) {
  const Drawing drawing = read_drawing(file);
  auto chain = kinematics::chain_profile(std::span<const Drawn>(drawing.drawn), options);
  if (!chain) throw Failure(Exit::bad_input, sentence(file, chain.error(), drawing));
  for (std::size_t i = 0; i + 1 < chain->pieces.size(); ++i) {
    const double angle = kinematics::kink_angle(chain->pieces[i], chain->pieces[i + 1]);
    if (std::abs(angle) < cncplan::tire_mold::WallCutter::smooth_angle) continue;
    const Origin& before = drawing.origins[chain->entities[i]];
    const Origin& behind = drawing.origins[chain->entities[i + 1]];
    fmt::print(
        stderr,
        "{}:{}:1: warning: a kink of {:.4g} degrees between {} and {}: the tool stops and turns there\n",
        file, behind.line, angle / radians, before.name, behind.name);
  }
  return std::move(*chain);
}

}  // namespace tire_mold
