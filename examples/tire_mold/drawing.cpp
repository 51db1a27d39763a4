#include "drawing.hpp"

#include <dime/Input.h>
#include <dime/Model.h>
#include <dime/entities/Arc.h>
#include <dime/entities/Circle.h>
#include <dime/entities/LWPolyline.h>
#include <dime/entities/Line.h>
#include <dime/entities/Polyline.h>
#include <dime/entities/Vertex.h>
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <numbers>
#include <optional>
#include <string_view>

#include "cncplan/plan/sidewall_guide.hpp"
#include "failure.hpp"

namespace tire_mold {

namespace {

using namespace cncplan;
using kinematics::Drawn;
using kinematics::DrawnArc;
using kinematics::DrawnLine;
using kinematics::Vector2;
using simulate::Exit;
using simulate::Failure;

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

class Collector {
 public:
  Collector(const std::string& file, Drawing& drawing) : file_(file), drawing_(drawing) {}

  void take(dimeEntity& entity) {
    ++count_;
    name_ = fmt::format("entity {} ({})", count_, entity.getEntityName());
    if (entity.isOfType(dimeBase::dimeExtrusionEntityType)) {
      const auto& up = static_cast<dimeExtrusionEntity&>(entity).getExtrusionDir();
      if (up.x != 0.0 || up.y != 0.0 || up.z <= 0.0) refuse("is not drawn in the plane of X and Y");
    }
    switch (entity.typeId()) {
      case dimeBase::dimeLineType: {
        const auto& line = static_cast<dimeLine&>(entity);
        add(DrawnLine{flat(line.getCoords(0)), flat(line.getCoords(1))});
        break;
      }
      case dimeBase::dimeArcType: {
        const auto& arc = static_cast<dimeArc&>(entity);
        dimeVec3f center;
        arc.getCenter(center);
        double sweep = std::fmod(arc.getEndAngle() - arc.getStartAngle(), 360.0);
        if (sweep <= 0.0) sweep += 360.0;
        add(DrawnArc{flat(center), arc.getRadius(), arc.getStartAngle() * radians, sweep * radians});
        break;
      }
      case dimeBase::dimeCircleType: {
        const auto& circle = static_cast<dimeCircle&>(entity);
        add(DrawnArc{flat(circle.getCenter()), circle.getRadius(), 0.0, 360.0 * radians});
        break;
      }
      case dimeBase::dimeLWPolylineType:
        add(static_cast<dimeLWPolyline&>(entity));
        break;
      case dimeBase::dimePolylineType:
        add(static_cast<dimePolyline&>(entity));
        break;
      default:
        leave_out(entity.getEntityName());
    }
  }

 private:
  [[noreturn]] void refuse(std::string_view why) const {
    throw Failure(Exit::bad_input, fmt::format("{}: {} {}", file_, name_, why));
  }

  [[nodiscard]] Vector2 flat(const dimeVec3f& point) const {
    if (!std::isfinite(point.x) || !std::isfinite(point.y)) refuse("has a coordinate that is not finite");
    if (point.z != 0.0) refuse("is not drawn in the plane of X and Y");
    return {point.x, point.y};
  }

  void add(const Drawn& drawn) { add(drawn, name_); }
  void add(const Drawn& drawn, const std::string& name) {
    drawing_.drawn.push_back(drawn);
    drawing_.names.push_back(name);
  }

  void add(const dimeLWPolyline& polyline) {
    if (polyline.getElevation() != 0.0) refuse("is not drawn in the plane of X and Y");
    std::vector<Corner> corners;
    for (int i = 0; i < polyline.getNumVertices(); ++i)
      corners.push_back({{polyline.getXCoords()[i], polyline.getYCoords()[i]}, polyline.getBulges()[i]});
    add(corners, (polyline.getFlags() & 1) != 0);
  }

  void add(dimePolyline& polyline) {
    constexpr int other_than_plane = 0x02 | 0x04 | 0x10 | 0x40;
    if ((polyline.getFlags() & other_than_plane) != 0)
      refuse("is a mesh or a fitted curve, not a chain of lines and arcs");
    std::vector<Corner> corners;
    for (int i = 0; i < polyline.getNumCoordVertices(); ++i) {
      const dimeVertex* vertex = polyline.getCoordVertex(i);
      constexpr int bulge = 42;
      dimeParam value;
      corners.push_back(
          {flat(vertex->getCoords()), vertex->getRecord(bulge, value) ? value.double_data : 0.0});
    }
    add(corners, (polyline.getFlags() & dimePolyline::CLOSED) != 0);
  }

  void add(const std::vector<Corner>& corners, bool closed) {
    const std::size_t sides = corners.size() - (closed || corners.empty() ? 0 : 1);
    if (corners.size() < 2) refuse("has fewer than two corners");
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
    fmt::print(stderr, "{}: warning: {} is left out\n", file_, name_);
  }

  const std::string& file_;
  Drawing& drawing_;
  int count_ = 0;
  std::string name_;
};

bool hand_over(const dimeState*, dimeEntity* entity, void* collector) {
  static_cast<Collector*>(collector)->take(*entity);
  return true;
}

std::string sentence(const std::string& file, const kinematics::ChainError& error, const Drawing& drawing) {
  if (drawing.names.empty()) return fmt::format("{}: there is no line and no arc in it", file);
  std::string text = fmt::format("{}: {} ", file, drawing.names[error.entity]);
  const std::string other = error.other ? drawing.names[*error.other] : "";
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
  std::FILE* const probe = std::fopen(file.c_str(), "rb");
  const bool readable = probe != nullptr && std::fgetc(probe) != EOF;
  if (probe != nullptr) std::fclose(probe);
  dimeInput input;
  if (!readable || !input.setFile(file.c_str()))
    throw Failure(Exit::bad_input, fmt::format("{}: cannot be read", file));
  dimeModel model;
  if (!model.read(&input))
    throw Failure(Exit::bad_input, fmt::format("{}:{}:1: error: is not a DXF drawing", file,
                                               std::max(input.getFilePosition(), 1)));
  Drawing drawing;
  Collector collector(file, drawing);
  model.traverseEntities(hand_over, &collector, false, false, false);
  return drawing;
}

kinematics::ProfileChain profile_of(const std::string& file, const kinematics::ChainOptions& options,
                                    bool quiet) {
  const Drawing drawing = read_drawing(file);
  auto chain = kinematics::chain_profile(std::span<const Drawn>(drawing.drawn), options);
  if (!chain) throw Failure(Exit::bad_input, sentence(file, chain.error(), drawing));
  for (std::size_t i = 0; i + 1 < chain->pieces.size() && !quiet; ++i) {
    const double angle = kinematics::kink_angle(chain->pieces[i], chain->pieces[i + 1]);
    if (std::abs(angle) < plan::SidewallGuide::smooth_angle) continue;
    fmt::print(
        stderr, "{}: warning: a kink of {:.4g} degrees between {} and {}: the tool stops and turns there\n",
        file, angle / radians, drawing.names[chain->entities[i]], drawing.names[chain->entities[i + 1]]);
  }
  return std::move(*chain);
}

}  // namespace tire_mold
