// Turns a plan into step edges.
#include <fmt/format.h>

#include "run.hpp"
#include "stopwatch.hpp"

namespace simulate {

template <class P>
void make_steps(const Program& program, const Route<P>& route, const Plan& plan, const Options& options,
                const Machine& machine, Measures& measures,
                const std::function<void(const cncplan::step::Edge&)>& take) {
  const Stopwatch watch(measures.steps_seconds);
  const auto path = [&](std::size_t i) -> const P& { return route[i].path; };
  const auto where = [&](std::size_t i) {
    return fmt::format("{}:{}:1", program.file, program.origins[route[i].block].line);
  };
  measures.steps = support::make_steps<P>(plan, machine, options.period, path, where, take);
}

using Take = std::function<void(const cncplan::step::Edge&)>;
template void make_steps(const Program&, const Route<MillPath>&, const Plan&, const Options&, const Machine&,
                         Measures&, const Take&);
template void make_steps(const Program&, const Route<PolarPath>&, const Plan&, const Options&, const Machine&,
                         Measures&, const Take&);
template void make_steps(const Program&, const Route<RowPath>&, const Plan&, const Options&, const Machine&,
                         Measures&, const Take&);

}  // namespace simulate
