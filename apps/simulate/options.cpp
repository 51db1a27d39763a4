#include "options.hpp"

#include <fmt/format.h>
#include <CLI/CLI.hpp>

#include <algorithm>
#include <limits>
#include <map>
#include <string>

#include "support/failure.hpp"

namespace simulate {

namespace {

// Adds an option whose value goes by one of a few names.
template <class Value, class E>
CLI::Option* add_name(CLI::App& app, const std::string& name, Value& value,
                      const std::map<std::string, E>& names, const std::string& text) {
  return app
      .add_option_function<std::string>(
          name, [&value, names](const std::string& chosen) { value = names.at(chosen); }, text)
      ->check(CLI::IsMember(names));
}

// The same; its default is the value as it stands.
template <class E>
void add_choice(CLI::App& app, const std::string& name, E& value, const std::map<std::string, E>& names,
                const std::string& text) {
  const auto standing =
      std::find_if(names.begin(), names.end(), [&](const auto& entry) { return entry.second == value; });
  add_name(app, name, value, names, text)->default_str(standing->first);
}

// What options are made of once all are known.
struct Given {
  std::optional<std::string> junction, served;
  std::optional<double> tolerance;
};

void add_limits(CLI::App& app, Options& options) {
  app.add_option("--vmax", options.limits.velocity, "speed limit along the path, mm/s")
      ->check(support::positive());
  app.add_option("--amax", options.limits.acceleration, "acceleration limit, mm/s^2")
      ->check(support::positive());
  app.add_option("--jmax", options.limits.jerk, "jerk limit, mm/s^3")->check(support::positive());
}

// How the motion is planned.
void add_plan(CLI::App& app, Options& options, Given& given) {
  app.add_option("--rotary-tolerance", options.rotary_tolerance,
                 "how far rotary axes may leave their path at corners, degrees")
      ->check(support::not_negative());
  add_choice(app, "--profile", options.law, {{"five", Law::five}, {"seven", Law::seven}},
             "five: KK22's phases; seven: acceleration held at its limit");
  add_choice(app, "--plan", options.planning, {{"span", Planning::span}, {"block", Planning::block}},
             "span: ramps cross blocks; block: zero acceleration at every block end, as published");
  add_choice(app, "--interpolator", options.interpolator,
             {{"exact", Interpolator::exact},
              {"taylor", Interpolator::taylor},
              {"constant", Interpolator::constant}},
             "how samples are made");
  app.option_defaults()->always_capture_default(false);
  app.add_option(
         "--tolerance", given.tolerance,
         "mm that the tool may leave the path, so that it moves without a jump of velocity or acceleration; "
         "0: the exact path, corners by --junction; if not given, 0 with --junction, with what is as "
         "published and on machines whose axes are not the program's, else 0.01")
      ->check(support::not_negative());
  add_name<std::optional<cncplan::SmoothLevel>, cncplan::SmoothLevel>(
      app, "--smooth", options.smooth,
      {{"fast", cncplan::SmoothLevel::fast},
       {"good", cncplan::SmoothLevel::good},
       {"best", cncplan::SmoothLevel::best}},
      "with --tolerance, fast: closed form, as an executor does; best: the fastest motion; good: nearly "
      "that, with less work; best if not given, fast with --events");
  app.add_option("--junction", given.junction,
                 "corners of the exact path: table, table-absolute, stop, tangent=MM/S, deviation=MM, "
                 "acceleration-step=MM/S^2; several joined by +; deviation=0.01 if not given");
  app.add_option("--tool-length", options.tool_length,
                 "with a tilting axis: from there to the tool's tip, mm; 0 if not given")
      ->check(support::not_negative());
  add_name<std::optional<cncplan::Orientation>, cncplan::Orientation>(
      app, "--orientation", options.orientation,
      {{"joints", cncplan::Orientation::joints}, {"great-circle", cncplan::Orientation::great_circle}},
      "with tool-point control, how the tool turns along a line: its axes in proportion to the way, or its "
      "direction on a great circle; that of the machine file if not given");
}

// What is run, and what is made of it.
void add_run(CLI::App& app, Options& options, Given& given) {
  app.add_option("--events", options.events, "holds, overrides and stops on the way, CSV");
  app.add_option("--from-line", options.from_line, "begin at the first motion of this line or behind it")
      ->check(CLI::Range(1, std::numeric_limits<int>::max()));
  app.add_flag("--check", options.check, "say all that is wrong with the program, and plan nothing");
  app.add_option("--motions", options.motions, "write the program's motions, CSV; - for standard output");
  app.add_option("--blocks", options.blocks, "write the planned blocks, CSV; - for standard output");
  support::add_run_options(app, options);
  app.add_option("--compare", options.compare,
                 "with --report: a second plan beside the first, within this tolerance, mm")
      ->check(support::not_negative());
  app.add_option("--serve", given.served,
                 "run the program in real time, and let a browser see and steer it: PORT of this machine, or "
                 "ADDRESS:PORT");
  app.add_flag("--count-steps", options.count_steps,
               "make and count step edges where neither --steps nor --machine asks for them");
}

// Corners within a tolerance, or by the policies of the exact path.
void settle_corners(Options& options, const Given& given) {
  const bool published = options.law == Law::five || options.planning == Planning::block ||
                         options.interpolator != Interpolator::exact;
  if (published && given.tolerance.value_or(0.0) > 0.0)
    throw support::Failure(support::Exit::bad_input,
                           "--tolerance above 0 does not go with --profile five, --plan block or another "
                           "--interpolator than exact");
  constexpr double standard = 0.01;
  options.tolerance_given = given.tolerance.has_value();
  options.tolerance = given.tolerance.value_or(given.junction || published ? 0.0 : standard);
  options.junction = junction_choice(given.junction.value_or(fmt::format("deviation={}", standard)));
  if (!given.junction && !published) options.corner_tolerance = standard;
}

}  // namespace

std::optional<Options> parse_options(int argc, char** argv) {
  Options options;
  Given given;
  CLI::App app(
      "Plans a G-code program under speed, acceleration and jerk limits, samples it, and turns it into step "
      "and direction edges at their exact times.",
      "cncplan_simulate");
  app.option_defaults()->always_capture_default();
  app.add_option("PROGRAM", options.program, "G-code file, - for standard input")->required();
  add_limits(app, options);
  support::add_period(app, options);
  add_plan(app, options, given);
  add_run(app, options, given);
  if (!support::parse(app, argc, argv)) return std::nullopt;
  options.period_given = app.count("--period") > 0;
  settle_corners(options, given);
  if (given.served) options.serve = serve::parse_address(*given.served);
  support::refuse_shared_files({{"PROGRAM", options.program},
                                {"--machine", options.machine},
                                {"--events", options.events},
                                {"--motions", options.motions},
                                {"--blocks", options.blocks},
                                {"--samples", options.samples},
                                {"--steps", options.steps},
                                {"--report", options.report}});
  options.summary_aside = support::takes_standard_output({{"--motions", options.motions},
                                                          {"--blocks", options.blocks},
                                                          {"--samples", options.samples},
                                                          {"--steps", options.steps},
                                                          {"--report", options.report}},
                                                         options.json);
  support::refuse_shared_files({{"--plot", options.plot}});  // a folder: another output may be in it
  return options;
}

}  // namespace simulate
