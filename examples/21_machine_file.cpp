// A machine from a file, a program planned for it, its set points as a table, and a page to look at.
// Writes samples.csv and report.html.
#include <cncplan/cncplan.hpp>
#include <cncplan_tools/machine_file.hpp>
#include <cncplan_tools/samples.hpp>
#include <cncplan_tools/trajectory_report.hpp>
#include <cstdio>
#include <fstream>
#include <iterator>
#include <string>

using namespace cncplan;

int main(int argc, char** argv) {
  if (argc != 3) return std::fprintf(stderr, "usage: 21_machine_file MACHINE.toml PROGRAM\n"), 2;
  const auto file = tools::read_machine(argv[1]);
  if (!file) return std::fprintf(stderr, "%s\n", file.error().c_str()), 2;
  const auto mill = tools::machine_of<3>(*file, {30.0, 1000.0, 10000.0});  // limits of the tool: mm, s
  if (!mill) return std::fprintf(stderr, "%s: %s\n", argv[1], mill.error().c_str()), 2;

  const auto trajectory = plan_file(argv[2], *mill, {.dialect = file->dialect});
  if (!trajectory) return std::fprintf(stderr, "%s\n", to_text(trajectory.error()).c_str()), 2;

  std::ofstream table("samples.csv"), page("report.html");
  if (!tools::write_samples(table, *trajectory, *file, 1e-3)) return std::fputs("no samples\n", stderr), 1;
  if (const auto missing = tools::report::missing_packages(); !missing.empty())
    return std::fprintf(stderr, "no report: the library was built without%s\n", std::string(missing).c_str()),
           1;
  std::ifstream program(argv[2]);
  const std::string text{std::istreambuf_iterator<char>(program), {}};
  const std::string seconds = std::to_string(trajectory->duration()) + " s";
  const auto report = tools::report_of(*trajectory, *file, {argv[2], text, {{"duration", seconds}}});
  if (!report) return std::fprintf(stderr, "%s\n", to_text(report.error()).c_str()), 1;
  tools::report::write(page, *report);
  std::printf("%.3f s: samples.csv, report.html\n", trajectory->duration());
  return table && page ? 0 : 1;
}
