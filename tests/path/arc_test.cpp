#include "cncplan/path/arc.hpp"

#include "random_arcs.hpp"
#include "support/catch.hpp"
#include "support/path_laws.hpp"

using namespace cncplan;
using namespace cncplan::path;

static_assert(Path<BasicArc<float>> && Path<BasicArc<double>>);
template class cncplan::path::BasicArc<float>;
template class cncplan::path::BasicArc<double>;

namespace {

/// Largest of the values, with the arc that gave it.
struct Worst {
  double value = 0;
  std::string arc;

  template <class S>
  void see(double candidate, const BasicArc<S>& from) {
    if (candidate <= value) return;
    value = candidate;
    arc = test::describe(from);
  }
};

template <class S>
double size_of(const BasicArc<S>& arc) {
  return static_cast<double>(arc.start().cwiseAbs().maxCoeff() + arc.end().cwiseAbs().maxCoeff() +
                             arc.start_radius() + arc.end_radius()) *
         (1 + static_cast<double>(arc.parameter_end()) / 6) *
         static_cast<double>(std::numeric_limits<S>::epsilon());
}

}  // namespace

TEMPLATE_TEST_CASE("Arcs of every kind obey the laws of paths", "", float, double) {
  using S = TestType;
  test::Random random;
  for (const test::ArcKind kind : test::arc_kinds) {
    test::PathLawErrors worst;
    Worst ends;
    Worst approach;
    for (int i = 0; i < test::cases(100); ++i) {
      const auto arc = test::random_arc<S>(random, kind);
      worst.worst_of(test::path_law_errors(arc, std::min(1.0, static_cast<double>(arc.parameter_end()))));
      const bool exact = arc.position(S(0)) == arc.start() && arc.position(arc.parameter_end()) == arc.end();
      ends.see(exact ? 0 : 1, arc);
      // The formula without its exact ends arrives there as well.
      const S last = std::nextafter(arc.parameter_end(), S(0));
      approach.see(static_cast<double>((arc.position(last) - arc.end()).norm()) / size_of(arc), arc);
    }
    test::check_path_laws(worst, "arc kind " + std::to_string(static_cast<int>(kind)));
    INFO(ends.arc);
    CHECK(ends.value == 0);
    INFO(approach.arc);
    CHECK(approach.value < 4);
  }
}

TEMPLATE_TEST_CASE("Points of an arc lie on its circle at the angle that the sweep tells", "", float,
                   double) {
  using S = TestType;
  test::Random random;
  Worst worst;
  for (const test::ArcKind kind : test::arc_kinds)
    for (int i = 0; i < 200; ++i) {
      const auto arc = test::random_arc<S>(random, kind);
      const PlaneAxes a = axes(arc.plane());
      const double part = random.uniform(0, 1);
      const auto u = static_cast<S>(part) * arc.parameter_end();
      const double angle = double(arc.start_angle()) + double(u) * sign(arc.turn());
      const double radius =
          double(arc.start_radius()) + part * (double(arc.end_radius()) - double(arc.start_radius()));
      const auto p = arc.position(u);
      const double dx = double(p(a.first)) - (double(arc.center()(a.first)) + radius * std::cos(angle));
      const double dy = double(p(a.second)) - (double(arc.center()(a.second)) + radius * std::sin(angle));
      const double dz = double(p(a.third)) - (double(arc.start()(a.third)) + part * double(arc.rise()));
      worst.see(std::hypot(dx, dy, dz) / size_of(arc), arc);
    }
  INFO(worst.arc);
  CHECK(worst.value < 4);
}

TEMPLATE_TEST_CASE("Tangents, curvature and its maximum agree with the derivatives", "", float, double) {
  using S = TestType;
  test::Random random;
  Worst curvature;
  Worst above;
  Worst tangent;
  for (const test::ArcKind kind : test::arc_kinds)
    for (int i = 0; i < 100; ++i) {
      const auto arc = test::random_arc<S>(random, kind);
      for (int k = 0; k <= 20; ++k) {
        const S u = arc.parameter_end() * static_cast<S>(k) / S(20);
        const Vector3 d = arc.derivative(u).template cast<double>();
        const Vector3 dd = arc.second_derivative(u).template cast<double>();
        const Vector3 cross(d.y() * dd.z() - d.z() * dd.y(), d.z() * dd.x() - d.x() * dd.z(),
                            d.x() * dd.y() - d.y() * dd.x());
        const double kappa = cross.norm() / std::pow(d.norm(), 3);
        curvature.see(std::abs(double(arc.curvature(u)) / kappa - 1), arc);
        above.see(kappa / double(arc.max_curvature()) - 1, arc);
      }
      tangent.see(double((arc.start_tangent() - arc.derivative(S(0)).normalized()).norm()), arc);
      tangent.see(std::abs(double(arc.end_tangent().norm()) - 1), arc);
      tangent.see(double((arc.end_tangent() * arc.derivative(arc.parameter_end()).norm() -
                          arc.derivative(arc.parameter_end()))
                             .norm()) /
                      double(arc.derivative(arc.parameter_end()).norm()),
                  arc);
    }
  const double eps = static_cast<double>(std::numeric_limits<S>::epsilon());
  INFO(curvature.arc << "; " << above.arc);
  CHECK(curvature.value < 400 * eps);
  CHECK(above.value < 400 * eps);
  CHECK(tangent.value < 8 * eps);
}

TEMPLATE_TEST_CASE("Boxes hold every point and touch the arc on all sides", "", float, double) {
  using S = TestType;
  test::Random random;
  Worst outside;
  Worst loose;
  for (const test::ArcKind kind : test::arc_kinds)
    for (int i = 0; i < test::cases(60); ++i) {
      const auto arc = test::random_arc<S>(random, kind);
      const auto box = arc.box();
      BasicVector3<S> low = arc.start();
      BasicVector3<S> high = arc.start();
      const int samples = 1000 * (1 + static_cast<int>(arc.parameter_end() / S(6.3)));
      for (int k = 0; k <= samples; ++k) {
        const auto p = arc.position(arc.parameter_end() * static_cast<S>(k) / static_cast<S>(samples));
        low = low.cwiseMin(p);
        high = high.cwiseMax(p);
      }
      outside.see(double(std::max((box.low - low).maxCoeff(), (high - box.high).maxCoeff())) / size_of(arc),
                  arc);
      const double largest = double(std::max(arc.start_radius(), arc.end_radius()));
      loose.see(double(std::max((low - box.low).maxCoeff(), (box.high - high).maxCoeff())) /
                    (1e-5 * largest + size_of(arc)),
                arc);
    }
  INFO(outside.arc << "; " << loose.arc);
  CHECK(outside.value <
        2);  // roundings; the scan's own steps may miss (pi / 1000)^2 / 2 = 5e-6 of the radius
  CHECK(loose.value < 2);
}

TEMPLATE_TEST_CASE("Pieces between turnings are monotone and crossings invert position", "", float, double) {
  using S = TestType;
  test::Random random;
  Worst wrong_way;
  Worst crossing;
  Worst stuck;
  for (const test::ArcKind kind : test::arc_kinds)
    for (int i = 0; i < test::cases(60); ++i) {
      const auto arc = test::random_arc<S>(random, kind);
      for (int axis = 0; axis < 3; ++axis) {
        S low = S(0);
        for (int piece = 0; low < arc.parameter_end(); ++piece) {
          const S high = arc.next_reversal(axis, low);
          if (!(high > low) || piece > 100) {
            stuck.see(1, arc);
            break;
          }
          const S from = arc.position(low)(axis);
          const S to = arc.position(high)(axis);
          const S way = to < from ? S(-1) : S(1);
          S previous = from;
          for (int k = 1; k <= 16; ++k) {
            const S u = low + (high - low) * static_cast<S>(k) / S(16);
            const S now = arc.position(u)(axis);
            wrong_way.see(double(way * (previous - now)) / size_of(arc), arc);
            previous = now;
            if (from == to) continue;
            const S found =
                arc.crossing(axis, std::clamp(now, std::min(from, to), std::max(from, to)), low, high);
            const S there = arc.position(found)(axis);
            crossing.see(found >= low && found <= high ? double(std::abs(there - now)) / size_of(arc) : 1e9,
                         arc);
          }
          low = high;
        }
      }
    }
  INFO(wrong_way.arc << "; " << crossing.arc << "; " << stuck.arc);
  CHECK(stuck.value == 0);
  CHECK(wrong_way.value < 2);
  CHECK(crossing.value < 4);
}

TEMPLATE_TEST_CASE("Beyond its ends an arc has the point and the derivatives of the nearer one", "", float,
                   double) {
  using S = TestType;
  test::Random random;
  Worst other;
  for (const test::ArcKind kind : test::arc_kinds)
    for (int i = 0; i < 20; ++i) {
      const auto arc = test::random_arc<S>(random, kind);
      const S end = arc.parameter_end();
      const auto same = [&](S beyond, S at) {
        const bool equal = arc.position(beyond) == arc.position(at) &&
                           arc.derivative(beyond) == arc.derivative(at) &&
                           arc.second_derivative(beyond) == arc.second_derivative(at);
        other.see(equal ? 0 : 1, arc);
      };
      same(S(-0.5), S(0));
      same(end + S(0.5), end);
    }
  INFO(other.arc);
  CHECK(other.value == 0);
}

TEST_CASE("A quarter circle and a helix give the figures of the textbook") {
  const double r = 30;
  const double pi = std::numbers::pi;
  ArcGeometry<double> g{.start = {r, 0, 0}, .end = {0, r, 0}, .center = {0, 0, 7}, .radial = {r, 0, 5}};
  g.start_radius = g.end_radius = r;
  g.angle = pi / 2;
  g.turn = Turn::counterclockwise;
  g.plane = Plane::xy;
  const Arc quarter(g);
  CHECK(quarter.length() == Approx(47.123889803846899).epsilon(1e-15));
  CHECK(quarter.center() == Vector3(0, 0, 0));
  CHECK(quarter.is_circular());
  CHECK(quarter.curvature(0.3) == Approx(1 / r).epsilon(1e-15));
  CHECK((quarter.start_tangent() - Vector3(0, 1, 0)).norm() < 1e-15);
  CHECK((quarter.end_tangent() - Vector3(-1, 0, 0)).norm() < 1e-15);
  CHECK(quarter.next_reversal(0, 0.0) == quarter.parameter_end());
  CHECK(quarter.crossing(2, 0.0, 0.5, 1.0) == 0.5);
  CHECK(quarter.box() == Box{{0, 0, 0}, {r, r, 0}});
  CHECK(quarter.chord() == Vector3(-r, r, 0));

  g.end = {r, 0, 12};
  g.angle = 6 * pi;
  const Arc helix(g);
  CHECK(helix.length() == Approx(std::hypot(6 * pi * r, 12)).epsilon(1e-15));
  CHECK(helix.planar_length() == Approx(6 * pi * r).epsilon(1e-15));
  CHECK(helix.rise() == 12);
  const double pitch = 12 / (6 * pi);
  CHECK(helix.max_curvature() == Approx(r / (r * r + pitch * pitch)).epsilon(1e-14));
  CHECK(helix.next_reversal(2, 0.0) == helix.parameter_end());
  CHECK(helix.crossing(2, 3.0, 0.0, helix.parameter_end()) == Approx(1.5 * pi).epsilon(1e-15));
  CHECK_FALSE(helix == quarter);
  CHECK(helix == Arc(g));
}
