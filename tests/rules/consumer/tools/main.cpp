// A machine from a text, and a report of a program on it.
#include <cncplan/cncplan.hpp>
#include <cncplan_tools/samples.hpp>
#include <cncplan_tools/trajectory_report.hpp>
#include <cstdio>
#include <sstream>

int main() {
  using namespace cncplan;
  const auto wrong = tools::parse_machine("unit = \"cm\"\n", "wrong.toml");
  if (wrong || wrong.error() != "wrong.toml:1:8: error: unit must be \"mm\" or \"inch\"")
    return std::puts("a wrong file is not told"), 1;

  const auto file = tools::parse_machine("[[axis]]\nletter = \"X\"\n[[axis]]\nletter = \"Y\"\n", "mill.toml");
  if (!file) return std::puts(file.error().c_str()), 1;
  const auto mill = tools::machine_of<3>(*file, {30.0, 1000.0, 10000.0});
  if (!mill || tools::machine_of<1>(*file, {30.0, 1000.0, 10000.0})) return std::puts("number of axes"), 1;
  const auto trajectory = plan_text("G1 X10 F600\nY10\n", *mill, {});
  if (!trajectory) return std::puts(to_text(trajectory.error()).c_str()), 1;

  std::ostringstream table, page;
  if (!tools::write_samples(table, *trajectory, *file, 0.5) ||
      tools::write_samples(table, *trajectory, *file, 0.0))
    return std::puts("samples"), 1;
  if (!table.str().starts_with("t,X,Y,s,v,a,j\n0,") || !table.str().ends_with(",0\n"))
    return std::puts(table.str().c_str()), 1;
  const auto report = tools::report_of(*trajectory, *file, {"corner.nc", "G1 X10 F600\nY10\n", {}});
  if (!report) return std::puts("report"), 1;
  tools::report::write(page, *report);
  return page.str().find("corner.nc") == std::string::npos;
}
