// What the command lines of the programs share.
#pragma once

#include <initializer_list>
#include <optional>
#include <string>
#include <string_view>

namespace CLI {
class App;
class Validator;
}  // namespace CLI

namespace support {

/// A number greater than zero, or not below.
[[nodiscard]] const CLI::Validator& positive();
[[nodiscard]] const CLI::Validator& not_negative();

/// The tail of every command line.
struct RunOptions {
  double period = 0.001;  ///< s
  std::optional<std::string> machine;
  std::optional<std::string> samples;
  std::optional<std::string> steps;
  std::optional<std::string> plot;
  std::optional<std::string> report;
  bool json = false;
  bool quiet = false;
  bool summary_aside = false;  ///< the table goes to standard error: an output has standard output
};

void add_period(CLI::App& app, RunOptions& options);
/// All but the period.
void add_run_options(CLI::App& app, RunOptions& options);

/// False after `--help` or `--version`, which print what they promise. Throws `Failure` for bad arguments.
[[nodiscard]] bool parse(CLI::App& app, int argc, char** argv);

/// A file and the option that names it.
struct NamedFile {
  std::string_view option;
  std::optional<std::string> file;
};

/// No output may overwrite an input or another output, and no name is empty; throws `Failure` where one is.
void refuse_shared_files(std::initializer_list<NamedFile> files);

/// Whether one of the outputs goes to standard output. Throws `Failure` where two do, or where the summary as
/// JSON goes there as well.
[[nodiscard]] bool takes_standard_output(std::initializer_list<NamedFile> outputs, bool json);

}  // namespace support
