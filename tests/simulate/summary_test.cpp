// What the summary says, and what it leaves out.
#include <cmath>
#include <string>

#include "simulate/run.hpp"
#include "support/catch.hpp"
#include "support/shared.hpp"

using namespace cncplan;

namespace {

const std::string corner = "F1800\nG1 X20\nY20\n";
// Of motions of 0.2 mm with a corner at each end.
std::string rings(int lines) {
  std::string text = "F1800\n";
  for (int i = 0; i < lines; ++i) {
    const double angle = i * 0.35, radius = 0.5 + i * 1e-3;
    text += "G1 X" + std::to_string(radius * std::cos(angle)) + " Y" +
            std::to_string(radius * std::sin(angle)) + " Z" + std::to_string(i * 1e-4) + "\n";
  }
  return text;
}

std::string row_of(const std::string& table, const std::string& name) {
  const std::size_t from = table.find("\n" + name);
  return from == std::string::npos ? "" : table.substr(from + 1, table.find('\n', from + 1) - from - 1);
}

}  // namespace

TEST_CASE("no samples are made where nothing needs them") {
  const test::Folder folder;
  for (const std::string with : {"", "--count-steps ", "--motions m.csv --blocks b.csv "}) {
    INFO(with);
    const auto run = folder.run_text(corner, with + "--json");
    REQUIRE(run.exit == 0);
    const auto json = run.json();
    for (const char* key : {"samples", "end_error_mm", "contour_error_mm", "interpolate_s"}) {
      INFO(key);
      CHECK_FALSE(json.contains(key));
    }
    CHECK(json["measure_s"].is_number_float());
    CHECK(json["deviation_mm"] > 0.001);
  }
  for (const std::string with : {"--period 0.001 ", "--samples s.csv ", "--report r.html "}) {
    INFO(with);
    const auto run = folder.run_text(corner, with + "--json");
    REQUIRE(run.exit == 0);
    for (const char* key : {"samples", "end_error_mm", "contour_error_mm", "interpolate_s"}) {
      INFO(key);
      CHECK(run.json().contains(key));
    }
  }
}

TEST_CASE("what is measured takes no longer than the plan") {
  const test::Folder folder;
  const auto json = folder.run_text(rings(4000), "--smooth fast --json").json();
  INFO("plan " << json["plan_s"] << " s, measures " << json["measure_s"] << " s");
  CHECK(json["measure_s"].get<double>() <= 2.0 * json["plan_s"].get<double>());
}

TEST_CASE("the deviation is the largest there is, with and without samples, and the report's") {
  const test::Folder folder;
  const std::string text = "F3000\nG64 P0.1\nG1 X20\nG3 X25 Y5 J5\nG1 Y20\nX3 Y18\n";
  for (const std::string level : {"fast", "best"}) {
    INFO(level);
    const std::string options = "--tolerance 0.01 --json --smooth " + level;
    const double alone = folder.run_text(text, options).json()["deviation_mm"];
    const auto fine = folder.run_text(text, options + " --period 0.0001 --report r.html");
    REQUIRE(fine.exit == 0);
    const double sampled = fine.json()["deviation_mm"];
    CHECK(alone <= 0.1);
    CHECK(alone > 0.001);
    CHECK(sampled >= alone);
    CHECK(sampled <= alone * (1.0 + 1e-3));
    const std::string page = folder.read("r.html");
    const std::size_t at = page.find("\"largest\":");
    REQUIRE(at != std::string::npos);
    CHECK(std::stod(page.substr(at + 10)) == sampled);
  }
}

TEST_CASE("the table shows the tool and the axes against their limits, and the tolerance in force") {
  const test::Folder folder;
  folder.write("mill.toml",
               "[[axis]]\nletter = \"X\"\nvelocity = 25\nacceleration = 500\njerk = 9000\n"
               "[[axis]]\nletter = \"Y\"\n[[axis]]\nletter = \"Z\"\n");
  const auto table = folder.run_text("G64 P0.1\n" + corner, "--machine mill.toml --vmax 40 --jmax 12345").out;
  INFO(table);
  CHECK(row_of(table, "tool's peaks").find(" of 40 mm/s, ") != std::string::npos);
  CHECK(row_of(table, "tool's peaks").find(" of 1000 mm/s^2, ") != std::string::npos);
  CHECK(row_of(table, "tool's peaks").find(" of 1.234e+04 mm/s^3") != std::string::npos);
  CHECK(row_of(table, "X").find(" of 25") != std::string::npos);
  CHECK(row_of(table, "X").find(" of 500") != std::string::npos);
  CHECK(row_of(table, "X").find(" of 9000") != std::string::npos);
  // Pulses of 2 us, high alone, are 500000 steps/s at most: 1250 mm/s at 400 steps/mm. No other limit is set.
  const std::string of_y = row_of(table, "Y");
  const std::size_t limit = of_y.find(" of 1250 ");
  REQUIRE(limit != std::string::npos);
  CHECK(of_y.find(" of ") == limit);
  CHECK(of_y.find(" of ", limit + 1) == std::string::npos);
  CHECK(row_of(table, "off the path").find("tolerance 0.1") != std::string::npos);
  CHECK(row_of(table, "peak along").empty());

  const auto two = folder.run_text("G64 P0.1\n" + corner + "G64\nX0\nY0\n", "--tolerance 0.02").out;
  CHECK(row_of(two, "off the path").find("tolerance 0.02 to 0.1") != std::string::npos);
  const auto given = folder.run_text(corner, "--tolerance 0.02").out;
  CHECK(row_of(given, "off the path").find("tolerance 0.02") != std::string::npos);
  CHECK(row_of(given, "off the path").find(" to ") == std::string::npos);
}

TEST_CASE("a time beyond all clocks is told by its size") {
  const test::Folder folder;
  const auto run = folder.run_text("G1 X1\n", "--vmax 1e-300");  // 1 mm
  REQUIRE(run.exit == 0);
  INFO(run.out);
  CHECK(row_of(run.out, "time").ends_with("  1e+300 s"));
  CHECK(row_of(run.out, "cutting").ends_with("  1 motions, 1.000 mm, 1e+300 s"));
  CHECK(row_of(folder.run_text("G4 P3725.5\n", "").out, "time").ends_with("  3725.5000 s (1:02:06)"));
}

TEST_CASE("the mean square error of a rotary axis is in square degrees") {
  const test::Folder folder;
  folder.write("mill.toml",
               "[[axis]]\nletter = \"X\"\n[[axis]]\nletter = \"Y\"\n[[axis]]\nletter = \"Z\"\n"
               "[[axis]]\nletter = \"C\"\nkind = \"rotary\"\nvelocity = 60\nacceleration = 1000\n"
               "jerk = 10000\nsteps_per_unit = 100\n");
  const auto json = folder.run_text("F600\nG1 X3 C40\nX7 C-20\n", "--machine mill.toml --json").json();
  for (const char* axis : {"X", "C"}) {
    INFO(axis);
    const double rmse = json["rmse"][axis];
    CHECK(rmse > 1e-4);
    CHECK(json["mse"][axis].get<double>() == Approx(rmse * rmse).epsilon(1e-9));
  }
}

TEST_CASE("the summary says which lines are planned at another level, and why") {
  const test::Folder folder;
  folder.write("mill.toml",
               "[[axis]]\nletter = \"X\"\n[[axis]]\nletter = \"Y\"\n[[axis]]\nletter = \"Z\"\n"
               "[[axis]]\nletter = \"A\"\nkind = \"rotary\"\nvelocity = 60\nacceleration = 1000\n"
               "jerk = 10000\n[[axis]]\nletter = \"C\"\nkind = \"rotary\"\nvelocity = 60\n"
               "acceleration = 1000\njerk = 10000\n");
  const std::string text = "F600\nG1 X3\nX5 Y2\nA10 C-20\nA20 C-30\n";
  for (const std::string level : {"good", "best"}) {
    INFO(level);
    const auto json = folder.run_text(text, "--machine mill.toml --json --smooth " + level).json();
    CHECK(json["level"] == level);
    REQUIRE(json["fallbacks"].size() == 1);
    CHECK(json["fallbacks"][0]["lines"] == nlohmann::json{4, 5});
    CHECK(json["fallbacks"][0]["level"] == "fast");
    CHECK(json["fallbacks"][0]["reason"] == "axes move, but not X Y Z");
  }
  const auto plain = folder.run_text(corner, "--json").json();
  CHECK(plain["level"] == "best");
  CHECK(plain["fallbacks"].empty());
  CHECK(folder.run_text(corner, "--json --tolerance 0").json()["level"] == "exact");
  CHECK(folder.run_text(corner, "--json --smooth fast").json()["level"] == "fast");
}

TEST_CASE("the real program of short lines is measured in less time than it is planned in") {
  const auto data = test::shared();
  if (!data) return;
  const test::Folder folder;
  const auto json = folder.run(*data + "/data/ball.nc --smooth fast --json --quiet").json();
  INFO("plan " << json["plan_s"] << " s, measures " << json["measure_s"] << " s");
  CHECK(json["measure_s"].get<double>() <= json["plan_s"].get<double>());
}
