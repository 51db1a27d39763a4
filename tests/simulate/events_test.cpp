// Holds, overrides and stops on the way, and starts in the middle of a program.
#include <algorithm>
#include <cmath>
#include <string>

#include "cncplan/executor_levels.hpp"
#include "cncplan/program.hpp"
#include "simulate/laws.hpp"
#include "simulate/programs.hpp"
#include "simulate/run.hpp"
#include "simulate/table.hpp"
#include "support/catch.hpp"
#include "support/random.hpp"

using namespace cncplan;

namespace {

// From the limits' speed to rest, when jerk alone binds: 30 mm/s, 10000 mm/s^3.
const double braking = 2.0 * std::sqrt(30.0 / 10000.0);

// A row of a table at a time, to the next period.
std::size_t row_at(const test::Table& samples, double time) {
  const auto& t = samples["t"];
  return static_cast<std::size_t>(std::lower_bound(t.begin(), t.end(), time - 1e-9) - t.begin());
}

}  // namespace

TEST_CASE("without events a played program takes the planned time") {
  const test::Folder folder;
  folder.write("none.csv", "t,event,value\n");
  for (const char* program : {"pocket", "kk22_figure7"}) {
    const auto planned = folder.run(test::example(program) + " --json --count-steps --smooth fast").json();
    const auto played =
        folder.run(test::example(program) + " --json --period 0.001 --count-steps --events none.csv").json();
    CHECK(played["time_s"].get<double>() == Approx(planned["time_s"].get<double>()).epsilon(1e-3));
    CHECK(played["net_steps"] == planned["net_steps"]);
    CHECK(played["steps"] == planned["steps"]);
    CHECK(played["completed"] == true);
    CHECK(planned["completed"] == true);
    CHECK(played["end_error_mm"] == 0.0);
  }
}

TEST_CASE("real programs end with events, and take the planned time without any") {
  const test::Folder folder;
  folder.write("none.csv", "t,event,value\n");
  test::Random random;
  const auto check = [&](const std::string& name, const std::string& program, int disturbed) {
    CAPTURE(name);
    double planned = 0;
    for (const std::string level : {" --smooth fast", " --tolerance 0"}) {
      CAPTURE(level);
      planned = folder.run(program + " --json" + level).json()["time_s"];
      const auto played = folder.run(program + " --json --events none.csv" + level).json();
      CHECK(played["time_s"].get<double>() < planned * (1 + 1e-3));
      // The last way down may begin where the plan has no junction, and go past a steady one of the plan.
      CHECK(played["time_s"].get<double>() > planned * (1 - 2e-3));
      CHECK(played["completed"] == true);
    }
    for (int sequence = 0; sequence < disturbed; ++sequence) {
      std::string events;
      double time = 0.0;
      for (int i = 0; i < 30; ++i) {
        time += random.log_uniform(1e-4, 0.1 * planned);
        const char* const kinds[] = {"hold,", "resume,", "feed,", "rapid,"};
        const int kind = random.integer(0, 3);
        events += std::to_string(time) + "," + kinds[kind] +
                  (kind < 2 ? "" : std::to_string(random.uniform(0.2, 1.0))) + "\n";
      }
      events += std::to_string(time + 1.0) + ",resume\n" + std::to_string(time + 1.0) + ",feed,1\n";
      folder.write("events.csv", events);
      CAPTURE(events);
      const auto run = folder.run(program + " --json --events events.csv");
      REQUIRE(run.exit == 0);
      CHECK(run.json()["completed"] == true);
    }
  };
  check("endless ticks", test::quoted(CNCPLAN_TEST_PROGRAMS "/endless_ticks.ngc"), 20);
  test::for_real_programs(
      [&](const std::string& name, const std::string& path) { check(name, test::quoted(path + ".ngc"), 2); });
}

TEST_CASE("a run waits between dwells and goes on behind many words") {
  const test::Folder folder;
  std::string level = "fast";
  const auto seconds = [&](const std::string& program, const char* events) {
    folder.write("e.csv", events);
    return folder.run_text(program, "--json --tolerance 0.01 --events e.csv --smooth " + level)
        .json()["time_s"]
        .get<double>();
  };
  std::string words;
  for (int i = 0; i < 10000; ++i) words += i % 2 == 0 ? "T1 M6\n" : "T2 M6\n";
  const double once = seconds("G1 X10 F600\n", "");
  for (const char* each : {"fast", "good", "best"}) {
    level = each;
    CAPTURE(level);
    CHECK(seconds("G4 P1\nG4 P1\n", "0.5,hold\n5,resume\n") == Approx(6));
    CHECK(seconds("G1 X10 F600\nG4 P1\nG4 P1\n", "0,step,1\n3,resume\n5,resume\n") == Approx(6));
    // At good and best, and ticks in which words are told.
    const double time = seconds("G1 X10 F600\n" + words + "G1 X20\n", "");
    CHECK(time >= 2 * once * (1 - 1e-9));
    CHECK(time < 2 * once * (level == "fast" ? 1 + 1e-9 : 1.005));
  }
}

TEST_CASE("runs rest as long at every level") {
  struct Case {
    const char* program;
    const char* events;
    double rests;  // s
    const char* period = "0.001";
  };
  const test::Folder folder;
  const std::string motion = "G1 X1 F1200\n";
  for (const std::string level : {"fast", "good", "best"}) {
    const auto seconds = [&](const std::string& program, const char* events, const std::string& period) {
      folder.write("e.csv", events);
      return folder
          .run_text(program,
                    "--json --tolerance 0.01 --events e.csv --smooth " + level + " --period " + period)
          .json()["time_s"]
          .get<double>();
    };
    for (const bool moves : {false, true})
      for (const Case& c :
           {Case{"G4 P0.5\nG4 P0.0005\n", "0.1,hold\n10,resume\n", 10.0005},
            Case{"G4 P0.5\nG4 P0.005\n", "0.1,hold\n10,resume\n", 10.005, "0.01"},
            Case{"G4 P0.002\nG4 P0.001\n", "0,step,1\n1.5,resume\n3,resume\n", 1.501},
            Case{"G4 P0.04\n", "", 0.04, "0.1"},
            Case{"G4 P0.5\nG4 P0.3\n", "0.1,hold\n1,step,1\n1.5,resume\n4,resume\n", 1.8},
            Case{"G4 P0.25\nG4 P0.4\n", "0.12,hold\n0.42,resume\n0.42,step,1\n3,resume\n", 0.82},
            Case{"G4 P0.25\nG4 P0.4\n", "0.1,step,1\n2,resume\n4,resume\n", 2.4},
            Case{"G4 P0.5\nG4 P0.3\n", "0,step,1\n0.1,step,0\n2,resume\n", 0.8},
            Case{"G4 P0.5\nG4 P0.3\n", "0,step,1\n0.1,resume\n2,resume\n4,resume\n", 2.3},
            Case{"G4 P0.5\n", "0,feed,0\n1,feed,1\n", 1.5},
            Case{"G4 P0.25\nG4 P0.25\n", "0.25,hold\n3,resume\n", 3.25},
            Case{"G4 P1.2\n", "0.1,feed,1\n", 1.2, "0.4"},
            Case{"G4 P0.5\nG4 P0.3\n", "0.5,hold\n0.55,resume\n", 0.85}}) {
        CAPTURE(level, moves, c.program, c.events);
        const double moved = moves ? seconds(motion, "", "0.001") : 0;
        const bool steps = moves && std::string(c.events).find("step,1") != std::string::npos;
        const double time = seconds(c.program + (moves ? motion : ""), c.events, c.period);
        // In single steps the motion waits for the last resume.
        if (!steps) CHECK(time == Approx(c.rests + moved).margin(1e-9 + (moves ? 1e-3 : 0)));
        if (steps) CHECK(time >= c.rests + moved - 1e-3);
      }
  }
}

TEST_CASE("events go with every policy for junctions") {
  const test::Folder folder;
  folder.write("e.csv", "t,event,value\n0,feed,1\n");
  const std::string run = "--json --quiet --tolerance 0 --vmax 30 --amax 1000 --jmax 10000";
  for (const char* policy : {"stop", "table", "tangent=2", "stop+deviation=0.1", "deviation=0.02"}) {
    CAPTURE(policy);
    const std::string options = run + " --junction " + policy;
    const std::string program = "F1800\nG1 X1\nX2 Y1\nX2 Y2\nX1\n";
    const double planned = folder.run_text(program, options).json()["time_s"];
    CHECK(folder.run_text(program, options + " --events e.csv").json()["time_s"] == Approx(planned));
  }
}

TEST_CASE("a pause before the first motion is made") {
  const test::Folder folder;
  folder.write("e.csv", "0,pause,2\n3,resume\n");
  REQUIRE(folder.run_text("G21\nG1 X10\nX20\n", "--quiet --events e.csv --samples s.csv").exit == 0);
  const test::Table samples(folder / "s.csv");
  CHECK(samples["x"][row_at(samples, 2.99)] == 0.0);
  CHECK(samples["x"].back() == 20.0);
}

TEST_CASE("a run that takes too long is refused at once") {
  const test::Folder folder;
  for (const char* events : {"0,feed,1e-8\n", "0.1,hold\n1e9,resume\n"}) {
    folder.write("e.csv", events);
    const auto run = folder.run_text("G1 X10 F600\n", "--json --events e.csv");
    CHECK(run.exit == 2);
    CHECK(run.err == "error: with its events the program takes more than 1e+10 periods of 0.001 s\n");
  }
}

TEST_CASE("all outputs of a disturbed run agree, and keep the limits") {
  const test::Folder folder;
  folder.write("e.csv",
               "t,event,value\n1.23,hold\n1.9,resume\n2.5,feed,0.3\n3.1,feed,90%\n4.2,rapid,50%\n"
               "5.0001,feed,0\n5.7,feed,1\n7.5,hold,\n7.51,resume,\n");
  const auto events = test::quoted((folder / "e.csv").string());
  const auto json = test::check_run(test::example("pocket"), "--tolerance 0 --events " + events, {});
  CHECK(json["completed"] == true);
  CHECK(json["contour_error_mm"] < 1e-9);
  CHECK(json["time_s"] > 20.05 + 0.67 + 0.7);
}

TEST_CASE(
    "events at the levels good and best: outputs agree, limits and tolerance are kept, the end is reached") {
  const test::Folder folder;
  folder.write("none.csv", "t,event,value\n");
  folder.write("e.csv",
               "1.23,hold\n1.9,resume\n2.5,feed,0.3\n3.1,feed,90%\n4.2,rapid,50%\n5.0001,feed,0\n5.7,feed,1\n"
               "7.5,hold,\n7.51,resume,\n8,step,1\n10,resume\n10,step,0\n");
  const std::string events = " --events " + test::quoted((folder / "e.csv").string());
  for (const std::string level : {"good", "best"}) {
    CAPTURE(level);
    const std::string options = "--tolerance 0.02 --smooth " + level;
    const double planned = folder.run(test::example("pocket") + " --json " + options).json()["time_s"];
    const auto played =
        folder.run(test::example("pocket") + " --json " + options + " --events none.csv").json();
    CHECK(played["time_s"].get<double>() ==
          Approx(planned).epsilon(2e-2));  // as it comes, with bounded holds
    CHECK(played["completed"] == true);
    CHECK(played["level"] == level);
    test::Asked asked;
    asked.jerk = 1e6;  // along the programmed path, which is not driven
    asked.exact = false;
    const auto json = test::check_run(test::example("pocket"), options + events, asked);
    CHECK(json["completed"] == true);
    CHECK(json["deviation_mm"] <= 0.02 * (1 + 1e-6));
    CHECK(json["tool_peak"]["jerk"] <= 10000 * (1 + 1e-4));
    CHECK(json["tool_peak"]["acceleration"] <= 1000 * (1 + 1e-5));
    CHECK(json["acceleration_jumps"] == 0);
    CHECK(json["time_s"] > planned + 0.67 + 0.7);

    REQUIRE(folder.run(test::example("pocket") + " --quiet --samples s.csv " + options + events).exit == 0);
    const test::Table samples(folder / "s.csv");
    double jerk = 0.0;
    for (std::size_t i = 3; i + 1 < samples.rows(); ++i) {
      double square = 0.0;
      for (const char* axis : {"x", "y", "z"}) {
        const auto& p = samples[axis];
        square += std::pow(p[i] - 3 * p[i - 1] + 3 * p[i - 2] - p[i - 3], 2);
      }
      jerk = std::max(jerk, std::sqrt(square));
    }
    CHECK(jerk <= 10000 * 1e-9 * (1 + 1e-3));
  }
}

TEST_CASE("events at the level good: single steps, a pause, a stop and a run without end") {
  const test::Folder folder;
  const std::string program = "G1 F1200 X10\nX20 Y5\nX30\nX40 Y-5\n",
                    good = " --smooth good --tolerance 0.01";
  folder.write("e.csv", "0,step,1\n2,resume\n4,step,0\n4,pause,4\n4,resume\n8,resume\n");
  REQUIRE(folder.run_text(program, "--quiet --events e.csv --samples s.csv" + good).exit == 0);
  const test::Table samples(folder / "s.csv");
  const auto x_at = [&](double time) { return samples["x"][row_at(samples, time)]; };
  CHECK(x_at(1.9) == Approx(10.0).margin(0.2));
  CHECK(x_at(3.9) == Approx(20.0).margin(0.2));
  CHECK(x_at(7.9) == Approx(30.0).margin(0.2));
  CHECK(samples["x"].back() == Approx(40.0).margin(1e-9));

  folder.write("e.csv", "1,stop\n2,resume\n");
  const auto stopped = folder.run_text("G1 X100\nY100\n", "--json --events e.csv" + good).json();
  CHECK(stopped["completed"] == false);
  CHECK(stopped["time_s"].get<double>() == Approx(1.0 + braking).epsilon(1e-4));
  folder.write("e.csv", "0,feed,0\n");
  CHECK(folder.run_text(program, "--json --events e.csv" + good).json()["time_s"] == 0.0);
  for (const char* events : {"0,feed,1e-8\n", "0.1,hold\n1e9,resume\n"}) {
    folder.write("e.csv", events);
    const auto run = folder.run_text(program, "--json --events e.csv" + good);
    CHECK(run.exit == 2);
    CHECK(run.err == "error: with its events the program takes more than 1e+10 periods of 0.001 s\n");
  }
}

TEST_CASE("events at the levels good and best: samples are the set points of an executor") {
  const std::string text = "G21 F1800\nG1 X20\nX30 Y10\nG3 X10 Y30 R20\nG4 P0.2\nG1 X0 Y20\nX0 Y0\nG0 X10\n";
  const test::Folder folder;
  folder.write("e.csv", "0.4,hold\n1.3,resume\n2,feed,0.5\n2.6,feed,1\n4,hold\n4.05,resume\n5,feed,0.9\n");
  const Machine<3> machine{.limits = {.velocity = 30, .acceleration = 1000, .jerk = 10000}};
  for (const auto level : {SmoothLevel::good, SmoothLevel::best}) {
    CAPTURE(to_text(level));
    const std::string options = " --quiet --tolerance 0.01 --samples s.csv --events e.csv --smooth ";
    REQUIRE(folder.run_text(text, options + std::string(to_text(level))).exit == 0);
    const test::Table samples(folder / "s.csv");
    const auto blocks = read_text(text, machine).take_blocks();
    Executor<Machine<3>, 300> executor(machine, LevelExecutorOptions{.level = level});
    for (const auto& block : blocks) REQUIRE(executor.push(block));
    executor.end_of_program();
    double worst = 0;
    for (std::size_t i = 1; i + 1 < samples.rows(); ++i) {
      const std::size_t ms = i - 1;
      if (ms == 400 || ms == 4000) executor.feed_hold();
      if (ms == 1300 || ms == 4050) executor.resume();
      if (ms == 2000) executor.feed_override(0.5);
      if (ms == 2600) executor.feed_override(1);
      if (ms == 5000) executor.feed_override(0.9);
      const auto point = executor.tick(1e-3);
      worst = std::max({worst, std::abs(samples["x"][i] - point.position[0]),
                        std::abs(samples["y"][i] - point.position[1])});
    }
    CHECK(samples.rows() > 5000);
    CHECK(worst < 1e-6);
  }
}

TEST_CASE("events at the level good end runs as they do at the level fast") {
  struct Case {
    const char* program;
    const char* events;
  };
  const test::Folder folder;
  for (const auto& [program, events] :
       {Case{"G1 X10 F1200\nG4 P1.5\nG1 X20\n", "0.8,stop\n"},
        Case{"G1 X10 F1200\nG4 P1.5\nG1 X20\n", "0.8,hold\n"},
        Case{"G61.1\nG1 X10 F1200\nG1 X20\n", "0,step,1\n"}, Case{"G1 X10 F1200\nG4 P1\n", ""},
        Case{"G4 P1.5\nG4 P0.5\n", ""}, Case{"G4 P1\nG1 X10 F1200\n", "0.5,hold\n"},
        Case{"G4 P1\nG1 X10 F1200\n", "0.5,stop\n"}, Case{"G0 X20\nG1 X10 F1200\n", "0.2,rapid,0\n"},
        Case{"G1 X10 F1200\nG4 P0.3\nM30\n", "0.1,hold\n0.5,resume\n"},
        Case{"G1 X50 F1200\n", "0.5,feed,0\n1,resume\n"},
        Case{"T1 M6\nG1 X9 F1200\nT2 M6\nX20\n", "0,step,1\n2,resume\n4,resume\n"}}) {
    CAPTURE(program, events);
    folder.write("e.csv", events);
    const auto run = [&](const std::string& level) {
      return folder
          .run_text(program, "--json --period 0.001 --tolerance 0.01 --events e.csv --smooth " + level)
          .json();
    };
    const auto good = run("good"), fast = run("fast");
    CHECK(good["time_s"].get<double>() == Approx(fast["time_s"].get<double>()).margin(2e-3));
    CHECK(good["completed"] == fast["completed"]);
    CHECK(good["end_error_mm"].get<double>() == Approx(fast["end_error_mm"].get<double>()).margin(0.02));
  }
}

TEST_CASE("the same events give the same bytes") {
  const test::Folder folder;
  folder.write("e.csv", "0.5,hold\n0.9,resume\n1.5,feed,1.7\n");
  const std::string run = test::example("pocket") + " --quiet --events e.csv --samples ";
  REQUIRE(folder.run(run + "a.csv --steps a.vcd").exit == 0);
  REQUIRE(folder.run(run + "b.csv --steps b.vcd").exit == 0);
  CHECK(test::text_of(folder / "a.csv") == test::text_of(folder / "b.csv"));
  CHECK(test::text_of(folder / "a.vcd") == test::text_of(folder / "b.vcd"));
}

TEST_CASE("a hold takes the least time, and the way goes on from there") {
  const test::Folder folder;
  folder.write("e.csv", "0.50025,hold\n1.5,resume\n");
  const auto run = folder.run_text("G1 X100\n", "--json --events e.csv --samples s.csv");
  REQUIRE(run.exit == 0);
  const test::Table samples(folder / "s.csv");
  const double rest = 0.50025 + braking;
  const std::size_t held = row_at(samples, rest);
  CHECK(samples["v"][held] == 0.0);
  CHECK(samples["v"][held - 1] > 0.0);
  CHECK(samples["j"][row_at(samples, 1.0)] == 0.0);
  CHECK(samples["x"][row_at(samples, 1.499)] == samples["x"][held]);
  CHECK(samples["x"].back() == 100.0);
  CHECK(samples["v"].back() == 0.0);
  const double alone = folder.run_text("G1 X100\n", "--json").json()["time_s"];
  CHECK(run.json()["time_s"].get<double>() == Approx(alone + (1.5 - rest) + braking).margin(1e-6));
}

TEST_CASE("feed follows the override up to the speed limit, rapids their own") {
  const test::Folder folder;
  folder.write("e.csv", "1,feed,0.5\n2,feed,150%\n3,feed,2\n");
  REQUIRE(
      folder.run_text("G1 X60 F1200\nG0 X90\n", "--quiet --events e.csv --samples s.csv --vmax 35").exit ==
      0);
  const test::Table feeds(folder / "s.csv");
  CHECK(feeds["v"][row_at(feeds, 0.9)] == Approx(20.0));
  CHECK(feeds["v"][row_at(feeds, 1.9)] == Approx(10.0));
  CHECK(feeds["v"][row_at(feeds, 2.9)] == Approx(30.0));
  CHECK(*std::max_element(feeds["v"].begin(), feeds["v"].end()) == Approx(35.0));
  folder.write("e.csv", "0,feed,0.1\n0,rapid,40%\n");
  REQUIRE(folder.run_text("G0 X30\n", "--quiet --events e.csv --samples s.csv").exit == 0);
  const test::Table rapids(folder / "s.csv");
  CHECK(rapids["v"][row_at(rapids, 1.0)] == Approx(12.0));
}

TEST_CASE("a stop ends the program where it comes to rest") {
  const test::Folder folder;
  folder.write("e.csv", "1,stop\n2,resume\n");
  const auto run = folder.run_text("G1 X100\nY100\n",
                                   "--json --count-steps --events e.csv --samples s.csv --blocks b.csv");
  REQUIRE(run.exit == 0);
  const auto json = run.json();
  CHECK(json["completed"] == false);
  CHECK(json["time_s"].get<double>() == Approx(1.0 + braking).epsilon(1e-9));
  const test::Table samples(folder / "s.csv");
  CHECK(samples["t"].back() == json["time_s"].get<double>());
  CHECK(samples["v"].back() == 0.0);
  const double there = samples["x"].back();
  CHECK(json["net_steps"]["X"] == std::lround(there * 400.0));
  CHECK(json["net_steps"]["Y"] == 0);
  CHECK(json["end_error_mm"].get<double>() == Approx(std::hypot(100.0 - there, 100.0)));
  const test::Table blocks(folder / "b.csv");
  CHECK(blocks["v_out"][0] == 0.0);
  CHECK(blocks["duration"][1] == 0.0);
}

TEST_CASE("a hold that nothing ends is the end") {
  const test::Folder folder;
  folder.write("e.csv", "1,feed,0%\n");
  const auto json = folder.run_text("G1 X100\n", "--json --events e.csv").json();
  CHECK(json["completed"] == false);
  CHECK(json["time_s"].get<double>() == Approx(1.0 + braking).epsilon(1e-9));
}

TEST_CASE("single steps and a pause at a line") {
  const test::Folder folder;
  const std::string program = "G1 X10\nX20\nX30\nX40\n";
  folder.write("e.csv", "0,step,1\n2,resume\n4,step,0\n4,pause,4\n4,resume\n8,resume\n");
  REQUIRE(folder.run_text(program, "--quiet --events e.csv --samples s.csv").exit == 0);
  const test::Table samples(folder / "s.csv");
  const auto x_at = [&](double time) { return samples["x"][row_at(samples, time)]; };
  CHECK(x_at(1.9) == Approx(10.0).margin(1e-9));
  CHECK(x_at(3.9) == Approx(20.0).margin(1e-9));
  CHECK(x_at(7.9) == Approx(30.0).margin(1e-9));
  CHECK(samples["x"].back() == 40.0);
}

TEST_CASE("a run that rests for good at a junction has not stepped the block behind it") {
  const test::Folder folder;
  folder.write("e.csv", "0,step,1\n");
  const auto run = folder.run_text("G21 G90\nG1 X10 F600\nG1 Y10\n", "--json --count-steps --events e.csv");
  INFO(run.err);
  REQUIRE(run.exit == 0);
  CHECK(run.json()["completed"] == false);
  CHECK(run.json()["steps"] == nlohmann::json{{"X", 4000}, {"Y", 0}, {"Z", 0}});
}

TEST_CASE("bad events: file, line, column and what is wrong, and no output") {
  struct Case {
    const char* events;
    const char* error;
  };
  const test::Folder folder;
  for (const auto& [events, error] :
       {Case{"t,event,value\n1,hold\nx,resume\n", "e.csv:3:1: error: 'x' is no time"},
        {"2,hold\n1,resume\n", "e.csv:2:1: error: a time before that of the row above"},
        {"-1,hold\n", "e.csv:1:1: error: a time below 0"},
        {"nan,hold\n", "e.csv:1:1: error: 'nan' is no time"},
        {"1\n", "e.csv:1:2: error: no event"},
        {"1,halt\n", "e.csv:1:3: error: 'halt' is no event"},
        {"1,hold,1\n", "e.csv:1:8: error: hold takes no value"},
        {"1,feed\n", "e.csv:1:7: error: '' is no share"},
        {"1,feed,fast\n", "e.csv:1:8: error: 'fast' is no share"},
        {"1,feed,2.1\n", "e.csv:1:8: error: feed takes 0 to 2"},
        {"1, feed, 210%\n", "e.csv:1:10: error: feed takes 0 to 2"},
        {"1,rapid,101%\n", "e.csv:1:9: error: rapid takes 0 to 1"},
        {"1,pause,1.5\n", "e.csv:1:9: error: '1.5' is no whole number"},
        {"1,feed,1,2\n", "e.csv:1:9: error: more than three fields"}}) {
    INFO(events);
    folder.write("e.csv", events);
    const auto run = folder.run_text("G1 X1\n", "--events e.csv --samples s.csv");
    CHECK(run.exit == 2);
    CHECK(run.err == error + std::string("\n"));
    CHECK_FALSE(std::filesystem::exists(folder / "s.csv"));
  }
  CHECK(folder.run_text("G1 X1\n", "--events none.csv").err == "error: none.csv: cannot be read\n");
  folder.write("e.csv", "");
  for (const char* other :
       {"--profile five", "--plan block", "--interpolator taylor", "--interpolator constant"})
    CHECK(folder.run_text("G1 X1\n", std::string("--events e.csv ") + other).exit == 2);
  CHECK(folder.run_text("G1 X1\n", "--events e.csv --samples e.csv").exit == 2);
}

TEST_CASE("a program is begun at a line, from rest at the start of its first motion") {
  const test::Folder folder;
  const std::string program = "G1 X10 F1200\nY10\n(nothing moves here)\nX0\nY0\n";
  REQUIRE(folder.run_text(program, "--quiet --from-line 3 --samples s.csv --motions m.csv").exit == 0);
  const test::Table samples(folder / "s.csv"), motions(folder / "m.csv");
  CHECK(motions["line"] == std::vector<double>{4, 5});
  CHECK(samples["x"][0] == Approx(10.0).epsilon(1e-15));
  CHECK(samples["y"][0] == Approx(10.0).epsilon(1e-15));
  CHECK(samples["v"][0] == 0.0);
  CHECK(samples["s"].back() == 20.0);
  CHECK(motions["feed"][0] == 20.0);  // what stands before the line was read
  const auto json = folder.run_text(program, "--json --count-steps --from-line 3").json();
  CHECK(json["net_steps"]["X"] == -4000);
  CHECK(json["net_steps"]["Y"] == -4000);
  const auto beyond = folder.run_text(program, "--from-line 6");
  CHECK(beyond.exit == 2);
  CHECK(beyond.err == "error: --from-line 6: program.ngc has no motion there or behind\n");
  CHECK(folder.run_text(program, "--from-line 0").exit == 2);
}

TEST_CASE("a pause on the line at which a program begins is no surprise") {
  const test::Folder folder;
  folder.write("e.csv", "0,pause,3\n");
  const auto run = folder.run_text("G1 X10 F600\nX20\nX30\n", "--events e.csv --from-line 3 --json --quiet");
  CHECK(run.err.empty());
  CHECK(run.json()["warnings"] == 0);
  CHECK_FALSE(folder.run_text("G1 X10 F600\nX20\nX30\n", "--events e.csv --from-line 2 --quiet").exit);
  folder.write("f.csv", "0,pause,1\n");
  CHECK(folder.run_text("G1 X10 F600\nX20\nX30\n", "--events f.csv --from-line 2 --quiet")
            .err.find("warning: pause") != std::string::npos);
}
