// Runs the built cncplan_simulate as somebody outside would, in a folder of its own.
#pragma once

#include <stdlib.h>
#include <sys/wait.h>

#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <nlohmann/json.hpp>
#include <set>
#include <stdexcept>
#include <string>

namespace cncplan::test {

inline std::string text_of(const std::filesystem::path& file) {
  std::ifstream stream(file, std::ios::binary);
  return {std::istreambuf_iterator<char>(stream), {}};
}

/// A file's name as the shell takes it.
inline std::string quoted(const std::string& name) { return "'" + name + "'"; }

inline std::string example(const std::string& name) {
  return quoted(CNCPLAN_EXAMPLES "/programs/" + name + ".ngc");
}

/// What a run left: its exit code, standard output and standard error.
struct Outcome {
  int exit{};
  std::string out;
  std::string err;

  [[nodiscard]] nlohmann::json json() const { return nlohmann::json::parse(out); }
};

/// A temporary folder to run in; it goes with the object.
class Folder {
 public:
  Folder() : path_(make()) {}
  Folder(const Folder&) = delete;
  Folder& operator=(const Folder&) = delete;
  ~Folder() {
    std::error_code ignored;
    std::filesystem::remove_all(path_, ignored);
  }

  [[nodiscard]] std::filesystem::path operator/(const std::string& name) const { return path_ / name; }
  void write(const std::string& name, const std::string& text) const {
    std::ofstream(path_ / name, std::ios::binary) << text;
  }
  /// Names of the files in it.
  [[nodiscard]] std::set<std::string> files() const {
    std::set<std::string> names;
    for (const auto& entry : std::filesystem::directory_iterator(path_))
      names.insert(entry.path().filename().string());
    return names;
  }

  /// Runs `cncplan_simulate ARGUMENTS` in it, as typed into a shell.
  [[nodiscard]] Outcome run(const std::string& arguments) const {
    const Folder streams;
    const std::string command =
        "cd " + quoted(path_.string()) + " && </dev/null " + quoted(CNCPLAN_SIMULATE) + " " + arguments +
        " >" + quoted((streams / "out").string()) + " 2>" + quoted((streams / "err").string());
    const int status = std::system(command.c_str());
    return {WIFEXITED(status) ? WEXITSTATUS(status) : -1, text_of(streams / "out"), text_of(streams / "err")};
  }
  /// The same for a program given as text.
  [[nodiscard]] Outcome run_text(const std::string& program, const std::string& options) const {
    write("program.ngc", program);
    return run("program.ngc " + options);
  }

 private:
  static std::filesystem::path make() {
    std::string name = (std::filesystem::temp_directory_path() / "cncplan-XXXXXX").string();
    if (::mkdtemp(name.data()) == nullptr) throw std::runtime_error("no temporary folder");
    return name;
  }

  std::filesystem::path path_;
};

}  // namespace cncplan::test
