// A straight row of joints: how a machine moves whose programs name its own axes.
#pragma once

#include <algorithm>
#include <cmath>

#include "cncplan/core/concepts.hpp"
#include "cncplan/path/quadrature.hpp"
#include "cncplan/plan/joint_path.hpp"

namespace cncplan::plan {

/// All joints go evenly from one place to another. The length is what the tool's tip travels on the way,
/// shared evenly too, and no less than a tenth of what any joint does (mm or rad): a tool that turns about
/// its tip has a way to go as well. The machine must outlive it.
template <Kinematics K>
class JointRow {
 public:
  using Scalar = typename K::Scalar;
  using Vector = typename K::Joints;
  using Rates = BasicJointRates<Scalar, Vector::RowsAtCompileTime>;

  JointRow(const K& machine, const Vector& start, const Vector& end)
      : machine_(&machine), start_(start), end_(end), length_(measure()) {}

  [[nodiscard]] Scalar length() const { return length_; }
  /// The parameter is the length itself.
  [[nodiscard]] Scalar parameter_end() const { return length_; }
  [[nodiscard]] Scalar parameter_at(Scalar s) const { return std::clamp(s, Scalar(0), length_); }
  [[nodiscard]] Scalar length_at(Scalar u) const { return u; }

  [[nodiscard]] Vector position(Scalar u) const {
    return u < length_ ? start_ + (end_ - start_) * (u / length_) : end_;
  }
  [[nodiscard]] Vector derivative(Scalar) const {
    return length_ > Scalar(0) ? ((end_ - start_) / length_).eval() : Vector::Zero();
  }
  [[nodiscard]] Vector second_derivative(Scalar) const { return Vector::Zero(); }
  [[nodiscard]] Rates rates(Scalar u) const { return {derivative(u), Vector::Zero(), Vector::Zero()}; }

  /// The tool's tip.
  [[nodiscard]] BasicVector3<Scalar> tip(Scalar u) const { return machine_->forward(position(u)).position; }

  /// No axis turns round, and places are where proportion says.
  [[nodiscard]] Scalar next_turning(int, Scalar) const { return length_; }
  [[nodiscard]] Scalar crossing(int axis, Scalar value, Scalar low, Scalar high) const {
    const Scalar way = end_[axis] - start_[axis];
    return way == Scalar(0) ? low : std::clamp((value - start_[axis]) / way * length_, low, high);
  }

 private:
  // The tip over a parameter from 0 to 1.
  struct TipCurve {
    using Scalar = JointRow::Scalar;
    using Vector = BasicVector3<Scalar>;

    const JointRow& row;

    [[nodiscard]] Vector derivative(Scalar part) const {
      const auto way = (row.end_ - row.start_).eval();
      return row.machine_->jacobian(row.start_ + part * way).template topRows<3>() * way;
    }
  };

  [[nodiscard]] Scalar measure() const {
    constexpr Scalar most_panels(1000);
    constexpr Scalar least_share(0.1);
    const Scalar farthest = (end_ - start_).cwiseAbs().maxCoeff();
    // a panel for each mm or rad: over so little the tip's speed is smooth
    const int panels = static_cast<int>(std::clamp(std::ceil(farthest), Scalar(1), most_panels));
    return std::max(path::arc_length(TipCurve{*this}, Scalar(0), Scalar(1), panels), least_share * farthest);
  }

  const K* machine_;
  Vector start_;
  Vector end_;
  Scalar length_;
};

}  // namespace cncplan::plan
