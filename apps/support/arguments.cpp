#include "support/arguments.hpp"

#include <fmt/format.h>
#include <CLI/CLI.hpp>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <filesystem>
#include <numeric>
#include <string>
#include <string_view>
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
            constexpr double most = 1e100;  // the third power of what is beyond is no number
            if (number && value > most) return fmt::format("must be {:.0e} at most: {}", most, text);
            if (number && (value > 0.0 || (with_zero && value == 0.0))) return std::string();
            return fmt::format("must be a number {} zero: {}", with_zero ? "not below" : "greater than",
                               text);
          },
          with_zero ? "NOT NEGATIVE" : "POSITIVE"};
}

// How many letters have to be put in, left out or exchanged to make one word of another.
std::size_t distance(std::string_view a, std::string_view b) {
  std::vector<std::size_t> row(b.size() + 1);
  std::iota(row.begin(), row.end(), std::size_t{0});
  for (std::size_t i = 0; i < a.size(); ++i) {
    std::size_t corner = row[0]++;
    for (std::size_t k = 0; k < b.size(); ++k) {
      const std::size_t exchanged = corner + (a[i] == b[k] ? 0 : 1);
      corner = row[k + 1];
      row[k + 1] = std::min({exchanged, row[k] + 1, corner + 1});
    }
  }
  return row.back();
}

// The option of a program that is most like a word, if there is one that is much like it.
std::string like(const CLI::App& app, std::string_view word) {
  std::size_t least = word.size() / 3 + 1;  // so many letters are too many
  std::string found;
  for (const CLI::Option* option : app.get_options())
    for (const std::string& name : option->get_lnames()) {
      const std::size_t apart = distance(word, "--" + name);
      if (apart < least) {
        least = apart;
        found = "--" + name;
      }
    }
  return found;
}

// What is left of a command line: the first option that is not known, else all.
std::string unexpected(const CLI::App& app) {
  const std::vector<std::string> left = app.remaining();
  for (const std::string& word : left) {
    if (!word.starts_with("--")) continue;
    const std::string name = word.substr(0, word.find('='));
    const std::string other = like(app, name);
    return fmt::format("{} is not known{}", name, other.empty() ? "" : fmt::format(": {}?", other));
  }
  return fmt::format("not expected: {}", fmt::join(left, " "));
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
    if (error.get_exit_code() != 0)  // what is missing may be there, misspelt
      throw Failure(Exit::bad_input, app.remaining().empty() ? error.what() : unexpected(app));
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
