#include "options.hpp"

#include <CLI/CLI.hpp>

#include <string>
#include <utility>

#include "support/failure.hpp"

namespace tire_mold {

std::optional<Options> parse_options(int argc, char** argv) {
  Options options;
  CLI::App app(
      "Maps a flat G-code program onto the curved sidewall of a tire mold, for a machine with a radial, a "
      "vertical, a tilting and a rotary axis.",
      "cncplan_tire_mold");
  app.add_option("PROFILE", options.profile, "drawing of the mold's profile, DXF")->required();
  app.add_option("ART", options.artwork, "flat program, G-code")->required();
  app.add_option("--tool-length", options.tool_length, "from the tilt axis to the tool's tip, mm")
      ->required()
      ->check(support::positive());
  app.add_option("--start-radius", options.start_radius,
                 "the artwork radius that falls on the profile's first point, mm")
      ->required()
      ->check(support::not_negative());
  app.add_flag("--reverse", options.reverse, "turn the profile round");
  std::string side = "right";
  app.add_option("--side", side, "of the profile, in its direction, that the tool stands on")
      ->check(CLI::IsMember({"left", "right"}))
      ->capture_default_str();
  app.option_defaults()->always_capture_default();
  auto* tolerance =
      app.add_option("--tolerance", options.tolerance, "largest distance of a row from the wall, mm")
          ->check(support::positive());
  app.add_option("--chain-tolerance", options.chain_tolerance, "largest gap between entities, mm")
      ->check(support::not_negative());
  app.add_option("--decimals", options.decimals, "of the numbers written")->check(CLI::Range(0, 15));
  support::add_period(app, options);
  app.option_defaults()->always_capture_default(false);
  app.add_option("--subdivide", options.subdivide, "rows of this length along the artwork instead, mm")
      ->check(support::positive())
      ->excludes(tolerance);
  std::string smooth;
  app.add_option("--smooth", smooth,
                 "smooth the motion within --tolerance at the wall, at this level; exact without it")
      ->check(CLI::IsMember({"fast", "good", "best"}));
  app.add_flag("--approach", options.approach,
               "map the way of the first move too, from where it comes over the profile");
  app.add_option(
      "--out", options.out,
      "write the 4-axis program here, - for standard output; with --json and without this it is not "
      "written");
  support::add_run_options(app, options);
  if (!support::parse(app, argc, argv)) return std::nullopt;
  for (const auto level :
       {cncplan::SmoothLevel::fast, cncplan::SmoothLevel::good, cncplan::SmoothLevel::best})
    if (smooth == to_text(level)) options.smooth = level;
  for (const auto& [given, name] :
       {std::pair{options.steps.has_value(), "--steps"}, std::pair{options.plot.has_value(), "--plot"},
        std::pair{options.report.has_value(), "--report"}})
    if (options.smooth && given)
      throw support::Failure(support::Exit::bad_input, std::string("--smooth does not go with ") + name);
  if (side == "left") options.side = cncplan::kinematics::Side::left;
  support::refuse_shared_files({{"PROFILE", options.profile},
                                {"ART", options.artwork},
                                {"--machine", options.machine},
                                {"--out", options.out},
                                {"--samples", options.samples},
                                {"--steps", options.steps},
                                {"--report", options.report}});
  if (!options.json && !options.out) options.out = "-";
  options.summary_aside = support::takes_standard_output({{"--out", options.out},
                                                          {"--samples", options.samples},
                                                          {"--steps", options.steps},
                                                          {"--report", options.report}},
                                                         options.json);
  return options;
}

}  // namespace tire_mold
