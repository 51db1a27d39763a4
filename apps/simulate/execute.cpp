#include "execute.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cstdio>

#include "deviation.hpp"
#include "events.hpp"
#include "html_report.hpp"
#include "machine.hpp"
#include "outputs.hpp"
#include "plan.hpp"
#include "problems.hpp"
#include "read_program.hpp"
#include "run.hpp"
#include "serve.hpp"
#include "support/failure.hpp"

namespace simulate {

namespace {

using support::Exit;
using support::Failure;

// A pause before a line without motion never comes.
void tell_pauses(const Options& options, ProgramText& program) {
  if (!options.events) return;
  for (const Event& event : read_events(*options.events)) {
    const auto line = static_cast<int>(event.value);
    const auto is_there = [&](const Origin& motion) { return motion.line == line; };
    const auto first = program.motions.begin() + (options.from_line ? 0 : 1);  // else where it starts
    if (event.request != Request::pause || line == 0 || std::any_of(first, program.motions.end(), is_there))
      continue;
    program.warnings.push_back(fmt::format("{}:{}:{}: warning: pause: {} has no motion on line {}",
                                           *options.events, event.row, event.column, program.file, line));
    fmt::print(stderr, "{}\n", program.warnings.back());
  }
}

}  // namespace

template <class M>
int execute(const Options& options, const support::Machine& file, const M& machine) {
  Problems problems(options);
  auto program = read_program(options, file, machine, problems);
  tell(options, problems, program.lines, program.warnings.size());
  if (options.check) return static_cast<int>(Exit::done);
  tell_pauses(options, program);

  if (options.serve) {
    const Plan planned = plan(options, file, machine, program);
    const Run run(options, file, program, planned);
    return serve_program(options, html_report(options, file, program, run.measures(), planned),
                         live_machines(options, file, machine, program));
  }
  const auto plan_as = [&](const Options& wanted) { return plan(wanted, file, machine, program); };
  return write_outputs(options, file, program, plan_as);
}

using namespace cncplan::kinematics;
template int execute(const Options&, const support::Machine&, const Mill<3>&);
template int execute(const Options&, const support::Machine&, const Mill<6>&);
template int execute(const Options&, const support::Machine&, const Rows&);
template int execute(const Options&, const support::Machine&, const Mapped<ThreeJoints>&);
template int execute(const Options&, const support::Machine&, const Mapped<ScaraWrist>&);
template int execute(const Options&, const support::Machine&, const Mapped<FiveAxes>&);
template int execute(const Options&, const support::Machine&, const Mapped<WristArm>&);

}  // namespace simulate
