#include "serve.hpp"

#include <sstream>

#include "serve/live_run.hpp"
#include "serve/web_server.hpp"
#include "support/failure.hpp"

namespace simulate {

template <class M>
int serve_program(const Options& options, const support::Machine& file, const M& machine,
                  const Program<M>& program, report::Report report) {
  report.live = true;
  std::ostringstream page;
  report::write(page, report);
  serve::block_signals();
  using Block = typename M::Block;
  serve::LiveRun<M, Block> run(
      machine, program.blocks,
      {.tolerance = options.tolerance,
       .rotary_tolerance = options.rotary_tolerance * cncplan::gcode::radians_per_degree,
       .junction_deviation = options.corner_tolerance},
      options.period, [&](const auto& point, std::vector<double>& row) {
        const cncplan::Vector3 tool = tool_at(machine, point);
        row.insert(row.end(), tool.begin(), tool.end());
        for (std::size_t i = 0; i < file.axes.size(); ++i)
          for (const auto* of : {&point.position, &point.velocity, &point.acceleration, &point.jerk})
            row.push_back(file.shown(i, (*of)[static_cast<Eigen::Index>(i)]));
      });
  serve::run_server(
      *options.serve, page.str(),
      {[&run](const std::string& name, const std::string& value) { return run.ask(name, value); },
       [&run](long long after) { return run.rows(after); }, [&run] { run.end(); }});
  return static_cast<int>(support::Exit::done);
}

template int serve_program(const Options&, const support::Machine&, const Mill<3>&, const Program<Mill<3>>&,
                           report::Report);
template int serve_program(const Options&, const support::Machine&, const Mill<6>&, const Program<Mill<6>>&,
                           report::Report);
template int serve_program(const Options&, const support::Machine&, const Table&, const Program<Table>&,
                           report::Report);
template int serve_program(const Options&, const support::Machine&, const Rows&, const Program<Rows>&,
                           report::Report);

}  // namespace simulate
