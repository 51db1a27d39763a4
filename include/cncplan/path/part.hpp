// Part of a path, between two of its lengths.
#pragma once

#include "cncplan/core/concepts.hpp"
#include "cncplan/core/enclosed_bounds.hpp"

namespace cncplan::path {

/// A path from one length to a higher one; its own length starts with zero.
template <Path P>
  requires EnclosedPath<P>
class Part {
 public:
  using Scalar = typename P::Scalar;
  using Vector = typename P::Vector;

  Part(const P& path, Scalar from, Scalar to) : path_(path), from_(from), length_(to - from) {}

  [[nodiscard]] const P& whole() const { return path_; }
  /// Where on the whole path it begins.
  [[nodiscard]] Scalar from() const { return from_; }
  [[nodiscard]] Scalar length() const { return length_; }
  [[nodiscard]] Vector position_at(Scalar s) const { return path_.position_at(from_ + s); }
  [[nodiscard]] PathPoint<Vector> point_at(Scalar s) const { return path_.point_at(from_ + s); }
  /// X Y Z of the tool, and their derivatives, where the whole path tells them.
  [[nodiscard]] PathPoint<BasicVector3<Scalar>> tool_point_at(Scalar s) const requires
      requires(const P& path) {
    path.tool_point_at(s);
  }
  { return path_.tool_point_at(from_ + s); }
  [[nodiscard]] auto enclosure(Scalar from, Scalar to) const {
    return path_.enclosure(from_ + from, from_ + to);
  }
  [[nodiscard]] auto bounds(Scalar from, Scalar to) const { return path_.bounds(from_ + from, from_ + to); }
  [[nodiscard]] auto box() const { return enclosed_box(*this); }

 private:
  P path_;
  Scalar from_;
  Scalar length_;
};

}  // namespace cncplan::path
