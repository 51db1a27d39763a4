// Many points of an arc or line at once against the same one by one.
#include "cncplan/path/detail/helix_batch.hpp"

#include <limits>
#include <vector>

#include "cncplan/path/segment.hpp"
#include "random_arcs.hpp"
#include "support/catch.hpp"
#include "support/random.hpp"

using namespace cncplan;

TEMPLATE_TEST_CASE("Points of many lengths are those of single ones, the ends bit for bit", "", float,
                   double) {
  using S = TestType;
  test::Random random;
  const S eps = std::numeric_limits<S>::epsilon();
  S worst = 0;
  bool ends = true;
  for (int i = 0; i < test::cases(1000); ++i) {
    const S radius = static_cast<S>(random.log_uniform(1e-2, 1e3));
    const S angle = static_cast<S>(random.uniform(0.01, 20));
    path::ArcGeometry<S> geometry;
    geometry.start = {radius, 0, 1};
    geometry.center = {0, 0, 0};
    geometry.radial = {radius, 0, 0};
    geometry.start_radius = radius;
    geometry.end_radius = random.coin() ? radius : radius * S(1.01);
    geometry.angle = angle;
    geometry.end = {geometry.end_radius * std::cos(angle), geometry.end_radius * std::sin(angle),
                    random.coin() ? S(1) : S(3)};
    geometry.turn = Turn::counterclockwise;
    geometry.plane = Plane::xy;
    const path::BasicSegment<S> arc = path::BasicArc<S>(geometry);
    const path::BasicSegment<S> line = path::BasicLine<S>(geometry.start, geometry.end);
    for (const auto& segment : {arc, line}) {
      std::vector<S> lengths{S(-1), S(0)};
      const int count = random.integer(1, 700);
      for (int k = 1; k <= count; ++k)
        lengths.push_back(segment.length() * static_cast<S>(k) / static_cast<S>(count));
      lengths.push_back(segment.length());
      lengths.push_back(segment.length() * 2);
      std::vector<BasicVector3<S>> out(lengths.size());
      segment.positions_at(lengths, points(std::span<BasicVector3<S>>(out)));
      for (std::size_t k = 0; k < out.size(); ++k) {
        const S s = std::clamp(lengths[k], S(0), segment.length());
        worst = std::max(
            worst, (out[k] - segment.position(segment.parameter_at(s))).norm() / (radius + segment.length()));
      }
      ends = ends && out[0] == segment.start() && out[1] == segment.start() &&
             out[out.size() - 1] == segment.end() && out[out.size() - 2] == segment.end();
    }
  }
  CHECK(ends);
  CHECK(worst / eps < 3);
}
