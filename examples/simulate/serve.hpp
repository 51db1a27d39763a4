// A program played in real time for a browser to see and to steer.
#pragma once

#include "machine.hpp"
#include "options.hpp"
#include "program.hpp"
#include "report/report.hpp"

namespace simulate {

/// Serves the report of a program as a page that runs it, at the address of `options.serve`, until SIGINT.
/// Throws `Failure`.
template <class M>
int serve_program(const Options& options, const support::Machine& file, const M& machine,
                  const Program<M>& program, report::Report report);

}  // namespace simulate
