// A planned program sampled and stepped, and what was measured on the way.
#pragma once

#include <functional>

#include "cncplan/step/edge.hpp"
#include "deviation.hpp"
#include "measures.hpp"
#include "options.hpp"
#include "plan.hpp"
#include "program.hpp"
#include "support/machine_file.hpp"

namespace simulate {

/// All that it is made of outlives it.
class Run {
 public:
  Run(const Options& options, const support::Machine& file, const ProgramText& program, const Plan& plan);

  [[nodiscard]] const Measures& measures() const { return measures_; }

  /// Makes all samples and hands them to `take`, in order.
  void sample(const std::function<void(const Sample&)>& take);

  /// Turns the plan into edges at their exact times and hands them to `take` in order, as signals of the
  /// machine's motors. Throws `Failure` for a plan that breaks a rule of a drive.
  void step(const std::function<void(const cncplan::step::Edge&)>& take);

 private:
  void measure();

  const Options& options_;
  const support::Machine& file_;
  const ProgramText& program_;
  const Plan& plan_;
  const MotionPlaces places_;
  Measures measures_;
};

}  // namespace simulate
