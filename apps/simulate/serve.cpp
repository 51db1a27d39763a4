#include "serve.hpp"

#include <sstream>
#include <string>

#include "serve/web_server.hpp"
#include "support/failure.hpp"
#include "support/report.hpp"

namespace simulate {

int serve_program(const Options& options, report::Report report, const serve::LiveRun::Fresh& fresh) {
  report.live = true;
  std::ostringstream page;
  report::write(page, report);
  serve::block_signals();
  serve::LiveRun run(fresh, options.period);
  serve::run_server(
      *options.serve, page.str(),
      {[&run](const std::string& name, const std::string& value) { return run.ask(name, value); },
       [&run](long long after) { return run.rows(after); }, [&run] { run.end(); }});
  return static_cast<int>(support::Exit::done);
}

}  // namespace simulate
