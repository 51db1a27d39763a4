// A program played in real time for a browser to see and to steer.
#pragma once

#include "options.hpp"
#include "program_blocks.hpp"
#include "serve/live_run.hpp"
#include "support/machine_file.hpp"
#include "support/report.hpp"

namespace simulate {

/// Makes machines that run a program; what it is given outlives them.
template <class M>
[[nodiscard]] serve::LiveRun::Fresh live_machines(const Options& options, const support::Machine& file,
                                                  const M& machine, const Program<M>& program);

/// Serves the report of a program as a page that runs it, at the address of `options.serve`, until SIGINT.
/// Throws `Failure`.
int serve_program(const Options& options, report::Report report, const serve::LiveRun::Fresh& fresh);

}  // namespace simulate
