#include "support/arguments.hpp"

#include <fmt/format.h>

#include <cmath>
#include <filesystem>
#include <system_error>
#include <utility>
#include <vector>

#include "cncplan/version.hpp"
#include "support/failure.hpp"
#include "support/output_file.hpp"

namespace support {

namespace {

CLI::Validator number_from_zero(bool with_zero) {
  return {[with_zero](std::string& text) {
            double value = 0.0;
            const bool number = CLI::detail::lexical_cast(text, value) && std::isfinite(value);
            if (number && (value > 0.0 || (with_zero && value == 0.0))) return std::string();
            return fmt::format("must be a number {} zero: {}", with_zero ? "not below" : "greater than",
                               text);
          },
          with_zero ? "NOT NEGATIVE" : "POSITIVE"};
}

}  // namespace

const CLI::Validator& positive() {
  static const CLI::Validator validator = number_from_zero(false);
  return validator;
}
const CLI::Validator& not_negative() {
  static const CLI::Validator validator = number_from_zero(true);
  return validator;
}

void add_period(CLI::App& app, RunOptions& options) {
  app.add_option("--period", options.period, "sample period, s")->check(positive())->capture_default_str();
}

void add_run_options(CLI::App& app, RunOptions& options) {
  app.add_option("--machine", options.machine, "machine file, TOML");
  app.add_option("--samples", options.samples, "write the samples, CSV; - for standard output");
  app.add_option("--steps", options.steps, "write step and direction signals, VCD; - for standard output");
  app.add_option("--plot", options.plot, "draw pictures into this folder, SVG")
      ->check([](const std::string& folder) {
        return folder == standard_output ? "pictures go into a folder, not to standard output" : "";
      });
  app.add_option("--report", options.report,
                 "write a report that a browser shows, HTML; - for standard output");
  app.add_flag("--json", options.json, "print the summary as JSON");
  app.add_flag("--quiet", options.quiet, "no progress bar and no table");
}

bool parse(CLI::App& app, int argc, char** argv) {
  app.set_version_flag("--version", fmt::format("cncplan {}.{}.{}", CNCPLAN_VERSION_MAJOR,
                                                CNCPLAN_VERSION_MINOR, CNCPLAN_VERSION_PATCH));
  try {
    app.parse(argc, argv);
  } catch (const CLI::ParseError& error) {
    if (error.get_exit_code() != 0) throw Failure(Exit::bad_input, error.what());
    app.exit(error);
    return false;
  }
  return true;
}

void refuse_shared_files(std::initializer_list<NamedFile> files) {
  std::vector<std::pair<std::string_view, std::filesystem::path>> seen;
  for (const auto& [option, file] : files) {
    std::error_code ignored;
    if (file && file->empty())
      throw Failure(Exit::bad_input, fmt::format("{}: the file name is empty", option));
    if (!file || *file == standard_output || std::filesystem::is_other(*file, ignored)) continue;
    const auto path = std::filesystem::weakly_canonical(std::filesystem::absolute(*file), ignored);
    for (const auto& [other, used] : seen)
      if (used == path)
        throw Failure(Exit::bad_input, fmt::format("{} and {} are the same file: {}", other, option, *file));
    seen.emplace_back(option, path);
  }
}

bool takes_standard_output(std::initializer_list<NamedFile> outputs, bool json) {
  std::string_view taken = json ? "--json" : "";
  bool takes = false;
  for (const auto& [option, file] : outputs) {
    if (file != standard_output) continue;
    if (!taken.empty())
      throw Failure(Exit::bad_input, fmt::format("{} and {} both go to standard output", taken, option));
    taken = option;
    takes = true;
  }
  return takes;
}

}  // namespace support
