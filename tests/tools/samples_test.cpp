// Tables of set points: what stands in them is where the program goes, in the units of the machine's file.
#include "cncplan_tools/samples.hpp"

#include <cmath>
#include <sstream>
#include <string>
#include <vector>

#include "cncplan_tools/trajectory_report.hpp"
#include "support/catch.hpp"

using namespace cncplan;

namespace {

const std::string four_axes =
    "[[axis]]\nletter = \"X\"\n[[axis]]\nletter = \"Y\"\n[[axis]]\nletter = \"Z\"\n"
    "[[axis]]\nletter = \"A\"\nkind = \"rotary\"\nvelocity = 90\nacceleration = 360\njerk = 7200\n";

std::vector<std::vector<double>> rows_of(const std::string& table) {
  std::istringstream lines(table);
  std::string line;
  std::getline(lines, line);
  std::vector<std::vector<double>> rows;
  while (std::getline(lines, line)) {
    std::istringstream fields(line);
    std::string field;
    rows.emplace_back();
    while (std::getline(fields, field, ',')) rows.back().push_back(std::stod(field));
  }
  return rows;
}

}  // namespace

TEST_CASE("a table of samples has the axes of the machine's file, rotary ones in degrees") {
  const auto file = tools::parse_machine(four_axes, "four.toml").value();
  const auto machine = tools::machine_of<4>(file, {30.0, 1000.0, 10000.0}).value();
  const auto trajectory = plan_text("G21 G90 F1200\nG1 X10 Y-5\nA90\n", machine, {}).value();
  std::ostringstream table;
  REQUIRE(tools::write_samples(table, trajectory, file, 0.01));
  CHECK(table.str().starts_with("t,X,Y,Z,A,s,v,a,j\n"));
  const auto rows = rows_of(table.str());
  REQUIRE(rows.size() == static_cast<std::size_t>(std::ceil(trajectory.duration() / 0.01)) + 1);
  for (std::size_t i = 0; i + 1 < rows.size(); ++i)
    CHECK(rows[i][0] == Approx(0.01 * static_cast<double>(i)));
  const auto& first = rows.front();
  const auto& last = rows.back();
  for (std::size_t axis = 1; axis <= 4; ++axis) CHECK(std::abs(first[axis]) < 1e-12);
  const std::vector<double> end{10.0, -5.0, 0.0, 90.0};
  for (std::size_t axis = 0; axis < 4; ++axis) CHECK(last[axis + 1] == Approx(end[axis]).margin(1e-9));
  CHECK(std::abs(last[6]) < 1e-9);
  double fastest = 0.0;  // of A, by differences: F1200 is 20 degrees a second
  for (std::size_t i = 1; i + 1 < rows.size(); ++i)
    fastest = std::max(fastest, std::abs(rows[i][4] - rows[i - 1][4]) / 0.01);
  CHECK(fastest == Approx(20.0).epsilon(1e-3));
}

TEST_CASE("a file of more axes than a machine has is refused wherever its axes are read") {
  const auto four = tools::parse_machine(four_axes, "four.toml").value();
  const auto two =
      tools::parse_machine("[[axis]]\nletter = \"X\"\n[[axis]]\nletter = \"Y\"\n", "two.toml").value();
  const auto refused = tools::machine_of<3>(four, {30.0, 1000.0, 10000.0});
  REQUIRE_FALSE(refused);
  CHECK(refused.error() == "axes of the machine's file: 4 is above the limit 3");
  const auto machine = tools::machine_of<3>(two, {30.0, 1000.0, 10000.0}).value();
  CHECK(machine.axes[2].high == 0.0);  // Z cannot move
  const auto trajectory = plan_text("G1 X1 F600\n", machine, {}).value();
  std::ostringstream table;
  const auto written = tools::write_samples(table, trajectory, four, 0.01);
  REQUIRE_FALSE(written);
  CHECK(written.error().code == ErrorCode::above_limit);
  CHECK(table.str().empty());
  CHECK_FALSE(tools::report_of(trajectory, four, {"a.nc", "G1 X1 F600\n", {}}));
  CHECK(tools::report_of(trajectory, two, {"a.nc", "G1 X1 F600\n", {}}));
}

TEST_CASE("a file whose axes are not the coordinates of its programs makes no machine") {
  const auto table = tools::parse_machine(
      "[[axis]]\nletter = \"Y\"\n[[axis]]\nletter = \"Z\"\n[[axis]]\nletter = \"C\"\nkind = \"rotary\"\n",
      "table.toml");
  REQUIRE(table);
  CHECK_FALSE(tools::machine_of<3>(*table, {30.0, 1000.0, 10000.0}));
  CHECK_FALSE(tools::read_machine("no such file"));
  CHECK(tools::read_machine("no such file").error() == "no such file: cannot be read");
  CHECK_FALSE(tools::read_machine("."));
}
