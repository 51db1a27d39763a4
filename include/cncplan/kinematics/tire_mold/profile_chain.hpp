// The profile of a mold from the lines and arcs of a drawing, in any order and direction (set-up).
#pragma once

#include <algorithm>
#include <cmath>
#include <concepts>
#include <cstddef>
#include <limits>
#include <numbers>
#include <optional>
#include <span>
#include <variant>
#include <vector>

#include "cncplan/core/error.hpp"
#include "cncplan/kinematics/tire_mold/profile_piece.hpp"

namespace cncplan::kinematics {

/// A straight line of a drawing, mm.
template <std::floating_point S>
struct BasicDrawnLine {
  BasicVector2<S> start = BasicVector2<S>::Zero();
  BasicVector2<S> end = BasicVector2<S>::Zero();
};

/// A circular arc of a drawing, mm.
template <std::floating_point S>
struct BasicDrawnArc {
  BasicVector2<S> center = BasicVector2<S>::Zero();
  S radius{};
  S start_angle{};  ///< rad
  S sweep{};        ///< rad, > 0 counter-clockwise as every ARC of a DXF file
};

/// What was drawn. Its place in the list is its name.
template <std::floating_point S>
using BasicDrawn = std::variant<BasicDrawnLine<S>, BasicDrawnArc<S>>;

using DrawnLine = BasicDrawnLine<double>;
using DrawnArc = BasicDrawnArc<double>;
using Drawn = BasicDrawn<double>;

/// Why a drawing is no chain, and which of its entities are at fault, by their places in the list.
struct ChainError {
  Error error;
  std::size_t entity{};
  std::optional<std::size_t> other{};

  friend bool operator==(const ChainError&, const ChainError&) = default;
};

/// Pieces end to end.
template <std::floating_point S>
struct BasicProfileChain {
  std::vector<BasicProfilePiece<S>> pieces;
  std::vector<std::size_t> entities;  ///< which entity each piece is
  bool closed{};

  [[nodiscard]] S length() const { return pieces.empty() ? S(0) : pieces.back().from + pieces.back().length; }
};

using ProfileChain = BasicProfileChain<double>;

/// How a chain is put together.
struct ChainOptions {
  double tolerance = 0.001;  ///< mm, >= 0: ends as near as this are one point
  bool reverse = false;      ///< from the last point to the first
  Side side = Side::right;   ///< of the chain in its direction, on which the tool stands
};

namespace detail {

template <std::floating_point S>
[[nodiscard]] BasicProfilePiece<S> piece_of(const BasicDrawnLine<S>& line) {
  const BasicVector2<S> way = line.end - line.start;
  return {line.start, std::atan2(way.y(), way.x()), S(0), S(0), way.norm(), S(0)};
}
template <std::floating_point S>
[[nodiscard]] BasicProfilePiece<S> piece_of(const BasicDrawnArc<S>& arc) {
  const S sense = std::copysign(S(1), arc.sweep);
  const BasicVector2<S> spoke(std::cos(arc.start_angle), std::sin(arc.start_angle));
  return {arc.center + arc.radius * spoke,
          arc.start_angle + sense * std::numbers::pi_v<S> / S(2),
          sense / arc.radius,
          sense * arc.radius,
          arc.radius * std::abs(arc.sweep),
          S(0)};
}

template <std::floating_point S>
[[nodiscard]] BasicProfilePiece<S> reversed(const BasicProfilePiece<S>& piece) {
  return {piece.end(),    piece.end_heading() + std::numbers::pi_v<S>,
          -piece.turning, -piece.radius,
          piece.length,   S(0)};
}

/// The piece turned, scaled and moved so that it goes from one point to another; how it closes gaps that the
/// tolerance allows. A full circle is only moved.
template <std::floating_point S>
[[nodiscard]] BasicProfilePiece<S> fitted(BasicProfilePiece<S> piece, const BasicVector2<S>& from,
                                          const BasicVector2<S>& to) {
  const BasicVector2<S> before = piece.end() - piece.start;
  const BasicVector2<S> after = to - from;
  piece.start = from;
  if (!(before.norm() > S(0) && after.norm() > S(0))) return piece;
  const S scale = after.norm() / before.norm();
  piece.heading += std::atan2(before.x() * after.y() - before.y() * after.x(), before.dot(after));
  piece.radius *= scale;
  piece.turning /= scale;
  piece.length *= scale;
  return piece;
}

template <std::floating_point S>
class Chainer {
 public:
  Chainer(std::span<const BasicDrawn<S>> drawn, S tolerance) : tolerance_(tolerance) {
    pieces_.reserve(drawn.size());
    for (const auto& entity : drawn)
      pieces_.push_back(std::visit([](const auto& shape) { return piece_of(shape); }, entity));
  }

  [[nodiscard]] Expected<BasicProfileChain<S>, ChainError> chain(bool reverse, Side side) {
    if (pieces_.empty())
      return tl::unexpected(ChainError{{ErrorCode::not_positive, "number of entities", 0.0, 0.0}, 0, {}});
    for (std::size_t i = 0; i < pieces_.size(); ++i)
      if (auto ok = check(i); !ok) return tl::unexpected(ok.error());
    auto links = walk({0, 1});
    if (!links) return tl::unexpected(links.error());
    const bool closed = closed_;
    links->insert(links->begin(), Link{0, false});
    if (!closed) {
      const auto before = walk({0, 0});
      if (!before) return tl::unexpected(before.error());
      for (const auto& [entity, turned] : *before) links->insert(links->begin(), Link{entity, !turned});
    }
    if (links->size() < pieces_.size()) return tl::unexpected(gap(*links));
    if (reverse) {
      std::reverse(links->begin(), links->end());
      for (Link& link : *links) link.turned = !link.turned;
    }
    return joined(*links, closed, side);
  }

 private:
  // One end of an entity: side 0 is where it begins as drawn.
  struct End {
    std::size_t entity{};
    std::size_t side{};

    friend bool operator==(const End&, const End&) = default;
  };
  // An entity in its place and direction.
  struct Link {
    std::size_t entity{};
    bool turned{};
  };

  [[nodiscard]] BasicVector2<S> at(const End& end) const {
    const auto& piece = pieces_[end.entity];
    return end.side == 0 ? piece.start : piece.end();
  }
  [[nodiscard]] bool meet(const BasicVector2<S>& a, const BasicVector2<S>& b) const {
    return (a - b).norm() <= tolerance_;
  }
  [[nodiscard]] BasicVector2<S> middle(std::size_t i) const {
    const auto [r, z] = pieces_[i].point(pieces_[i].length / S(2));
    return {r, z};
  }

  [[nodiscard]] Expected<void, ChainError> check(std::size_t i) const {
    const auto& piece = pieces_[i];
    const auto fail = [i](ErrorCode code, std::string_view field, S value, S bound) {
      return tl::unexpected(
          ChainError{{code, field, static_cast<double>(value), static_cast<double>(bound)}, i, {}});
    };
    if (!(piece.start.allFinite() && std::isfinite(piece.length) && std::isfinite(piece.heading)))
      return fail(ErrorCode::not_finite, "entity", piece.length, S(0));
    if (!(piece.length > tolerance_)) return fail(ErrorCode::below_limit, "length", piece.length, tolerance_);
    for (std::size_t j = 0; j < i; ++j) {
      const bool same = (meet(at({i, 0}), at({j, 0})) && meet(at({i, 1}), at({j, 1}))) ||
                        (meet(at({i, 0}), at({j, 1})) && meet(at({i, 1}), at({j, 0})));
      if (same && meet(middle(i), middle(j)))
        return tl::unexpected(ChainError{{ErrorCode::duplicate, "entity", 0.0, 0.0}, i, j});
    }
    return {};
  }

  /// The one end that meets another, if there is one.
  [[nodiscard]] Expected<std::optional<End>, ChainError> neighbour(const End& end) const {
    std::optional<End> found;
    for (std::size_t j = 0; j < pieces_.size(); ++j)
      for (const End other : {End{j, 0}, End{j, 1}}) {
        if (other == end || !meet(at(end), at(other))) continue;
        if (found)
          return tl::unexpected(ChainError{{ErrorCode::branching, "entity", 0.0, 0.0}, end.entity, j});
        found = other;
      }
    return found;
  }

  /// The entities that follow an end, in the direction away from it; sets `closed_` if they come back to
  /// entity 0.
  [[nodiscard]] Expected<std::vector<Link>, ChainError> walk(End end) {
    std::vector<Link> links;
    closed_ = false;
    while (links.size() <= pieces_.size()) {
      const auto next = neighbour(end);
      if (!next) return tl::unexpected(next.error());
      if (!*next) break;
      if ((*next)->entity == 0) {
        closed_ = true;
        break;
      }
      const bool turned = (*next)->side == 1;
      links.push_back({(*next)->entity, turned});
      end = {(*next)->entity, turned ? 0U : 1U};
    }
    return links;
  }

  /// The first entity that is left over, and the chain's entity nearest to it.
  [[nodiscard]] ChainError gap(const std::vector<Link>& links) const {
    std::vector<bool> used(pieces_.size());
    for (const Link& link : links) used[link.entity] = true;
    ChainError error{{ErrorCode::unconnected, "entity", std::numeric_limits<double>::infinity(),
                      static_cast<double>(tolerance_)},
                     static_cast<std::size_t>(std::find(used.begin(), used.end(), false) - used.begin()),
                     {}};
    for (const Link& link : links)
      for (const std::size_t side : {0U, 1U})
        for (const std::size_t own : {0U, 1U}) {
          const auto distance =
              static_cast<double>((at({link.entity, side}) - at({error.entity, own})).norm());
          if (distance < error.error.value) {
            error.error.value = distance;
            error.other = link.entity;
          }
        }
    return error;
  }

  [[nodiscard]] BasicProfileChain<S> joined(const std::vector<Link>& links, bool closed, Side side) const {
    BasicProfileChain<S> chain;
    chain.closed = closed;
    for (const auto& [entity, turned] : links) {
      chain.pieces.push_back(turned ? reversed(pieces_[entity]) : pieces_[entity]);
      chain.entities.push_back(entity);
    }
    const std::size_t n = chain.pieces.size();
    std::vector<BasicVector2<S>> meets(n + 1);
    for (std::size_t i = 1; i < n; ++i) meets[i] = (chain.pieces[i - 1].end() + chain.pieces[i].start) / S(2);
    meets[0] = chain.pieces[0].start;
    meets[n] = chain.pieces[n - 1].end();
    if (closed) meets[0] = meets[n] = (meets[0] + meets[n]) / S(2);
    S from = S(0);
    for (std::size_t i = 0; i < n; ++i) {
      chain.pieces[i] = fitted(chain.pieces[i], meets[i], meets[i + 1]);
      chain.pieces[i].from = from;
      chain.pieces[i].side = side;
      from += chain.pieces[i].length;
    }
    return chain;
  }

  std::vector<BasicProfilePiece<S>> pieces_;
  S tolerance_;
  bool closed_ = false;
};

}  // namespace detail

/// Chains what was drawn by its end points. The first entity keeps its direction, the others follow it; a
/// closed chain begins at the first entity's first point. Gaps within the tolerance are closed half and half,
/// by turning and scaling what meets there. Errors, by entity: not_finite; below_limit (a length no longer
/// than the tolerance); duplicate; branching; unconnected (value: the distance to the chain).
template <std::floating_point S>
[[nodiscard]] Expected<BasicProfileChain<S>, ChainError> chain_profile(std::span<const BasicDrawn<S>> drawn,
                                                                       const ChainOptions& options = {}) {
  return detail::Chainer<S>(drawn, static_cast<S>(options.tolerance)).chain(options.reverse, options.side);
}

}  // namespace cncplan::kinematics
