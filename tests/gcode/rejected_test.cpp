#include <algorithm>
#include <filesystem>
#include <fstream>
#include <set>
#include <sstream>
#include <vector>

#include "cncplan/gcode/language/program_lines.hpp"
#include "gcode/support.hpp"
#include "support/catch.hpp"

using namespace cncplan;

namespace {

/// Runs every file of a folder: `read` gives the error of a program, whose first line says what it should be.
template <class Read>
std::size_t check_folder(const std::filesystem::path& folder, Read&& read) {
  std::vector<std::filesystem::path> files;
  for (const auto& entry : std::filesystem::directory_iterator(folder)) files.push_back(entry.path());
  std::sort(files.begin(), files.end());
  for (const auto& file : files) {
    std::ifstream stream(file, std::ios::binary);
    std::stringstream text;
    text << stream.rdbuf();
    const std::string program = text.str();
    INFO(file.filename().string());
    const std::string expected = program.substr(2, program.find('\n') - 2);  // behind "; "
    const auto done = read(program);
    REQUIRE_FALSE(done);
    const std::string found = gcode::to_text("", done.error());
    CHECK(found == expected);
  }
  return files.size();
}

}  // namespace

TEST_CASE("every rejected program fails with the sentence on its first line") {
  const std::size_t files = check_folder(CNCPLAN_REJECTED, [](const std::string& program) {
    gcode::Reader reader;
    return gcode::read_program(gcode::TextLines(program), reader, [](const gcode::Item&) {});
  });
  CHECK(files > 80);
}

TEST_CASE("every rejected program of the language fails with the sentence on its first line") {
  const std::size_t files = check_folder(CNCPLAN_REJECTED_LANGUAGE, [](const std::string& program) {
    gcode::Reader reader;
    gcode::TextLines text(program);
    gcode::ProgramLines lines(text, reader);
    return gcode::read_program(lines, reader, [](const gcode::Item&) {});
  });
  CHECK(files >= 20);
}
