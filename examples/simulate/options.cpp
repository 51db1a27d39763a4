#include "options.hpp"

#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <cmath>
#include <filesystem>
#include <map>
#include <string_view>
#include <utility>
#include <vector>

#include "failure.hpp"

namespace simulate {

namespace {

const CLI::Validator positive(
    [](std::string& text) {
      double value = 0.0;
      const bool number = CLI::detail::lexical_cast(text, value);
      return number && std::isfinite(value) && value > 0.0 ? std::string()
                                                           : "must be a number greater than zero: " + text;
    },
    "POSITIVE");

// Adds an option whose value goes by one of a few names; its default is the value as it stands.
template <class E>
void add_choice(CLI::App& app, const std::string& name, E& value, const std::map<std::string, E>& names,
                const std::string& text) {
  const auto standing =
      std::find_if(names.begin(), names.end(), [&](const auto& entry) { return entry.second == value; });
  app.add_option_function<std::string>(
         name, [&value, names](const std::string& chosen) { value = names.at(chosen); }, text)
      ->check(CLI::IsMember(names))
      ->default_str(standing->first);
}

// No output may overwrite an input or another output.
void refuse_shared_files(const Options& options) {
  std::vector<std::pair<std::string_view, std::filesystem::path>> seen;
  const auto look = [&](std::string_view name, const std::optional<std::string>& file) {
    std::error_code ignored;
    if (!file || std::filesystem::is_other(*file, ignored)) return;
    const auto path = std::filesystem::weakly_canonical(std::filesystem::absolute(*file), ignored);
    for (const auto& [other, used] : seen)
      if (used == path)
        throw Failure(Exit::bad_input, fmt::format("{} and {} are the same file: {}", other, name, *file));
    seen.emplace_back(name, path);
  };
  look("PROGRAM", options.program);
  look("--machine", options.machine);
  look("--motions", options.motions);
  look("--blocks", options.blocks);
  look("--samples", options.samples);
  look("--steps", options.steps);
}

}  // namespace

std::optional<Options> parse_options(int argc, char** argv) {
  Options options;
  std::string junction = "deviation=0.01";
  CLI::App app(
      "Plans a G-code program under speed, acceleration and jerk limits, samples it, and turns it into step "
      "and direction edges at their exact times.",
      "cncplan_simulate");
  app.set_version_flag("--version", fmt::format("cncplan {}.{}.{}", CNCPLAN_VERSION_MAJOR,
                                                CNCPLAN_VERSION_MINOR, CNCPLAN_VERSION_PATCH));
  app.option_defaults()->always_capture_default();
  app.add_option("PROGRAM", options.program, "G-code file")->required();
  app.add_option("--vmax", options.limits.velocity, "speed limit along the path, mm/s")->check(positive);
  app.add_option("--amax", options.limits.acceleration, "acceleration limit, mm/s^2")->check(positive);
  app.add_option("--jmax", options.limits.jerk, "jerk limit, mm/s^3")->check(positive);
  app.add_option("--period", options.period, "sample period, s")->check(positive);
  app.add_option("--junction", junction,
                 "table, table-absolute, stop, tangent=MM/S, deviation=MM, acceleration-step=MM/S^2; several "
                 "joined by +");
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
  app.add_option("--machine", options.machine, "machine file, TOML");
  app.add_option("--motions", options.motions, "write the program's motions, CSV");
  app.add_option("--blocks", options.blocks, "write the planned blocks, CSV");
  app.add_option("--samples", options.samples, "write the samples, CSV");
  app.add_option("--steps", options.steps, "write step and direction signals, VCD");
  app.add_option("--plot", options.plot, "draw pictures into this folder, SVG");
  app.add_flag("--json", options.json, "print the summary as JSON");
  app.add_flag("--quiet", options.quiet, "no progress bar and no table");
  try {
    app.parse(argc, argv);
  } catch (const CLI::ParseError& error) {
    if (error.get_exit_code() != 0) throw Failure(Exit::bad_input, error.what());
    app.exit(error);
    return std::nullopt;
  }
  options.junction = junction_choice(junction);
  refuse_shared_files(options);
  return options;
}

}  // namespace simulate
