// The path of a plan as columns of whole numbers, which a page turns into polynomials.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "cncplan_tools/detail/channel_point.hpp"
#include "cncplan_tools/detail/grids.hpp"
#include "cncplan_tools/detail/packed.hpp"

namespace cncplan::tools::report {

/// Factors of the powers of the length from a piece's start; those above its degree are 0.
struct Polynomial {
  std::array<Channels, 6> power;

  [[nodiscard]] ChannelPoint at(double s) const {
    const auto& [p0, p1, p2, p3, p4, p5] = power;
    return {p0 + s * (p1 + s * (p2 + s * (p3 + s * (p4 + s * p5)))),
            p1 + s * (2 * p2 + s * (3 * p3 + s * (4 * p4 + s * 5 * p5))),
            2 * p2 + s * (6 * p3 + s * (12 * p4 + s * 20 * p5)), 6 * p3 + s * (24 * p4 + s * 60 * p5)};
  }
};

/// A path is made of pieces. Each goes on from the end of the one before, in position and two derivatives by
/// length, or has a start of its own. By its degree, this is known of it besides its length:
///
///     0  nothing: a place
///     1  the position at its end, as what it differs from the last one that was told so
///     3  the second derivative at its end, in the same way
///     5  what the powers 3, 4 and 5 of the length add to the position at its end
///
/// A piece begins where the page finds the end of the one before, not where it should be. So rounding does
/// not add up unseen: a piece is taken only if what the page makes of it is near the path, else it has a
/// start of its own, or a higher degree, or is cut in two.
class PathColumns {
 public:
  using At = std::function<ChannelPoint(double)>;

  explicit PathColumns(std::size_t channels)
      : zero_(Channels::Zero(static_cast<Eigen::Index>(channels))),
        here_{zero_, zero_, zero_, zero_},
        last_end_(whole(zero_, 0.0)),
        last_second_(last_end_),
        ends_(channels),
        seconds_(channels),
        shapes_(3 * channels) {}

  /// Appends the path of a block. at(s): a `ChannelPoint` where s mm have been travelled.
  void add(double length, const At& at) {
    const std::size_t before = degrees_.size();
    read_ = 0.0;
    add_pieces(0.0, length, at, 0);
    counts_.push_back(static_cast<std::int64_t>(degrees_.size() - before));
  }

  /// How far off the page finds a place of the path, in mm or degrees, at most.
  [[nodiscard]] double error() const { return error_; }
  /// Whether it is all there, and within 1e-7 mm or degrees.
  [[nodiscard]] bool complete() const { return complete_ && error_ <= farthest; }

  void put(std::vector<Column>& columns) const {
    columns.push_back({"pieces", pack(differences(counts_))});
    columns.push_back({"degree", pack(differences(degrees_))});
    columns.push_back({"length", pack(differences(lengths_))});
    const auto put_all = [&](const std::string& name, const std::vector<std::vector<std::int64_t>>& all) {
      for (std::size_t k = 0; k < all.size(); ++k)
        columns.push_back({name + std::to_string(k), pack(all[k])});
    };
    put_all("end", ends_);
    put_all("second", seconds_);
    put_all("shape", shapes_);
  }
  /// Position and two derivatives at the start of each piece that has a start of its own.
  [[nodiscard]] const std::vector<double>& starts() const { return starts_; }

 private:
  using Whole = Eigen::Matrix<std::int64_t, Eigen::Dynamic, 1, 0, 3 + gcode::max_axes, 1>;
  static constexpr int own_start = 8;       // is added to the degree
  static constexpr double farthest = 1e-7;  // mm or degrees, of a path that is taken
  static constexpr std::size_t places = 5;
  using Truth = std::array<ChannelPoint, places>;  // evenly along a piece, both ends among them

  struct Piece {
    int degree{};
    bool own{};
    std::int64_t length{};
    std::array<Whole, 3> numbers;
    Polynomial path;
  };

  static Whole whole(const Channels& values, double grid) {
    return (values * grid).array().round().cast<std::int64_t>();
  }
  static bool can_be_whole(const Channels& values, double grid) {
    return values.cwiseAbs().maxCoeff() * grid < static_cast<double>(packed_end / 2);
  }

  void add_pieces(double from, double to, const At& at, int depth) {
    constexpr int deepest = 12;
    const double middle = from + (to - from) / 2;
    const Truth truth{at(from), at((from + middle) / 2), at(middle), at((middle + to) / 2), at(to)};
    const double length = std::round((to - read_) * PathGrid::length);
    if (!(length < static_cast<double>(packed_end / 2))) return fail();
    if (!(length > 0.0)) return add_place(truth.front());
    for (const int degree : {1, 3, 5})
      for (const bool own : {false, true})
        if (const auto piece = make(degree, own, static_cast<std::int64_t>(length), truth);
            piece && is_near(*piece, truth))
          return add_piece(*piece, truth);
    if (depth == deepest) {  // the third derivative of a higher degree would be rounding where this is short
      for (const int degree : {3, 5})
        if (const auto piece = make(degree, true, static_cast<std::int64_t>(length), truth);
            piece && (degree == 5 || off(*piece, truth) <= farthest))
          return add_piece(*piece, truth);
      return fail();
    }
    add_pieces(from, middle, at, depth + 1);
    add_pieces(middle, to, at, depth + 1);
  }

  [[nodiscard]] std::optional<Piece> make(int degree, bool own, std::int64_t length,
                                          const Truth& truth) const {
    const double h = static_cast<double>(length) / PathGrid::length;
    const ChannelPoint &start = own ? truth.front() : here_, &end = truth.back();
    Piece piece{degree, own, length, {}, {{start.position, zero_, zero_, zero_, zero_, zero_}}};
    auto& [p0, p1, p2, p3, p4, p5] = piece.path.power;
    if (degree == 1) {
      if (!can_be_whole(end.position, PathGrid::length)) return {};
      piece.numbers[0] = whole(end.position, PathGrid::length);
      p1 = (piece.numbers[0].cast<double>() / PathGrid::length - start.position) / h;
      return piece;
    }
    p1 = start.first;
    p2 = start.second / 2;
    if (degree == 3) {
      if (!can_be_whole(end.second, PathGrid::second)) return {};
      piece.numbers[0] = whole(end.second, PathGrid::second);
      p3 = (piece.numbers[0].cast<double>() / PathGrid::second - start.second) / (6 * h);
      return piece;
    }
    // The powers over the piece that lead to position, slope and bend at its end.
    const Channels d = end.position - (p0 + h * (p1 + h * p2)), v = h * (end.first - (p1 + 2 * h * p2)),
                   a = h * h * (end.second - 2 * p2);
    const std::array<Channels, 3> shapes{10 * d - 4 * v + a / 2, -15 * d + 7 * v - a, 6 * d - 3 * v + a / 2};
    double scale = h * h * h;
    for (std::size_t k = 0; k < shapes.size(); ++k, scale *= h) {
      if (!can_be_whole(shapes[k], PathGrid::shape)) return {};
      piece.numbers[k] = whole(shapes[k], PathGrid::shape);
      piece.path.power[3 + k] = piece.numbers[k].cast<double>() / PathGrid::shape / scale;
    }
    return piece;
  }

  // Where place k of a piece is.
  static double share(double length, std::size_t k) {
    return length * static_cast<double>(k) / static_cast<double>(places - 1);
  }
  [[nodiscard]] static double distance(const Channels& a, const Channels& b) {
    return (a - b).cwiseAbs().maxCoeff();
  }
  // mm or degrees; share of a direction; share of a second derivative; the second derivative of a line; of
  // the largest third derivative
  static constexpr double near = 1e-8, direction = 1e-7, bend = 1e-5, straight = 1e-9, overshoot = 1.002;

  [[nodiscard]] static bool is_near(const Piece& piece, const Truth& truth) {
    const double h = static_cast<double>(piece.length) / PathGrid::length;
    double most_third = 0.0;  // it may jump inside the piece; no curve may overshoot there
    for (const ChannelPoint& point : truth) most_third = std::max(most_third, point.third.norm());
    for (std::size_t k = 0; k < places; ++k) {
      const ChannelPoint found = piece.path.at(share(h, k));
      if (!(distance(found.position, truth[k].position) <= near &&
            distance(found.first, truth[k].first) <= direction + straight / h &&
            (found.second - truth[k].second).norm() <= bend * truth[k].second.norm() + straight &&
            found.third.norm() <= overshoot * most_third + straight / h))
        return false;
    }
    return true;
  }

  // How far off the page finds its places, at most.
  [[nodiscard]] static double off(const Piece& piece, const Truth& truth) {
    const double h = static_cast<double>(piece.length) / PathGrid::length;
    double most = 0.0;
    for (std::size_t k = 0; k < places; ++k)
      most = std::max(most, distance(piece.path.at(share(h, k)).position, truth[k].position));
    return most;
  }

  void add_piece(const Piece& piece, const Truth& truth) {
    const double h = static_cast<double>(piece.length) / PathGrid::length;
    error_ = std::max(error_, off(piece, truth));
    add_start(piece.degree, piece.own, truth.front());
    lengths_.push_back(piece.length);
    const auto append = [](auto& columns, const Whole& numbers, std::size_t first = 0, std::size_t step = 1) {
      for (std::size_t k = 0; k < static_cast<std::size_t>(numbers.size()); ++k)
        columns[first + step * k].push_back(numbers[static_cast<Eigen::Index>(k)]);
    };
    if (piece.degree == 1) {
      append(ends_, piece.numbers[0] - last_end_);
      last_end_ = piece.numbers[0];
    } else if (piece.degree == 3) {
      append(seconds_, piece.numbers[0] - last_second_);
      last_second_ = piece.numbers[0];
    } else {
      for (std::size_t k = 0; k < 3; ++k) append(shapes_, piece.numbers[k], k, 3);
    }
    here_ = piece.path.at(h);
    read_ += h;
  }

  void add_place(const ChannelPoint& point) {
    const bool own = !(distance(here_.position, point.position) <= near);
    add_start(0, own, point);
    lengths_.push_back(0);
    if (own) here_ = point;
  }
  void add_start(int degree, bool own, const ChannelPoint& start) {
    degrees_.push_back(degree + (own ? own_start : 0));
    if (!own) return;
    for (const Channels* values : {&start.position, &start.first, &start.second})
      starts_.insert(starts_.end(), values->begin(), values->end());
  }
  void fail() { complete_ = false; }

  Channels zero_;
  ChannelPoint here_;  // at the end of the last piece, as it is read
  double read_{};      // length of the block, as it is read
  Whole last_end_, last_second_;
  std::vector<std::int64_t> counts_, degrees_, lengths_;
  std::vector<std::vector<std::int64_t>> ends_, seconds_, shapes_;
  std::vector<double> starts_;
  bool complete_ = true;
  double error_{};
};

}  // namespace cncplan::tools::report
