#include "options.hpp"

#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <cmath>

#include "cncplan/version.hpp"
#include "failure.hpp"

namespace tire_mold {

namespace {

using simulate::Exit;
using simulate::Failure;

CLI::Validator at_least_zero(bool zero_allowed) {
  return {[zero_allowed](std::string& text) {
            double value = 0.0;
            const bool number = CLI::detail::lexical_cast(text, value) && std::isfinite(value);
            if (number && (value > 0.0 || (zero_allowed && value == 0.0))) return std::string();
            return "must be a number " + std::string(zero_allowed ? "not below" : "greater than") +
                   " zero: " + text;
          },
          zero_allowed ? "NOT NEGATIVE" : "POSITIVE"};
}

}  // namespace

std::optional<Options> parse_options(int argc, char** argv) {
  Options options;
  const auto positive = at_least_zero(false);
  const auto not_negative = at_least_zero(true);
  CLI::App app(
      "Maps a flat G-code program onto the curved sidewall of a tire mold, for a machine with a radial, a "
      "vertical, a tilting and a rotary axis.",
      "cncplan_tire_mold");
  app.set_version_flag("--version", fmt::format("cncplan {}.{}.{}", CNCPLAN_VERSION_MAJOR,
                                                CNCPLAN_VERSION_MINOR, CNCPLAN_VERSION_PATCH));
  app.add_option("PROFILE", options.profile, "drawing of the mold's profile, DXF")->required();
  app.add_option("ART", options.artwork, "flat program, G-code")->required();
  app.add_option("--tool-length", options.tool_length, "from the tilt axis to the tool's tip, mm")
      ->required()
      ->check(positive);
  app.add_option("--start-radius", options.start_radius,
                 "the artwork radius that falls on the profile's first point, mm")
      ->required()
      ->check(not_negative);
  app.add_flag("--reverse", options.reverse, "turn the profile round");
  app.option_defaults()->always_capture_default();
  auto* tolerance =
      app.add_option("--tolerance", options.tolerance, "largest distance of a row from the wall, mm")
          ->check(positive);
  app.add_option("--chain-tolerance", options.chain_tolerance, "largest gap between entities, mm")
      ->check(not_negative);
  app.add_option("--decimals", options.decimals, "of the numbers written")->check(CLI::Range(0, 15));
  app.add_option("--corner-time", options.corner_time,
                 "s within which a corner may change what an axis does at its limits; 0 stops at corners")
      ->check(not_negative);
  app.add_option("--period", options.period, "sample period, s")->check(positive);
  app.option_defaults()->always_capture_default(false);
  app.add_option("--subdivide", options.subdivide, "rows of this length along the artwork instead, mm")
      ->check(positive)
      ->excludes(tolerance);
  app.add_option("--machine", options.machine, "machine file, TOML");
  app.add_option("--out", options.out, "write the 4-axis program here");
  app.add_option("--samples", options.samples, "write samples of the planned motion, CSV");
  app.add_option("--steps", options.steps, "write step and direction signals, VCD");
  app.add_option("--plot", options.plot, "draw pictures into this folder, SVG");
  app.add_flag("--json", options.json, "print the summary as JSON; without --out no program is written");
  app.add_flag("--quiet", options.quiet, "no summary");
  try {
    app.parse(argc, argv);
  } catch (const CLI::ParseError& error) {
    if (error.get_exit_code() != 0) throw Failure(Exit::bad_input, error.what());
    app.exit(error);
    return std::nullopt;
  }
  return options;
}

}  // namespace tire_mold
