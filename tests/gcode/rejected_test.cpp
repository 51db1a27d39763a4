#include <algorithm>
#include <filesystem>
#include <fstream>
#include <set>
#include <sstream>
#include <vector>

#include "gcode/support.hpp"
#include "support/catch.hpp"

using namespace cncplan;

TEST_CASE("every rejected program fails with the sentence on its first line") {
  std::vector<std::filesystem::path> files;
  for (const auto& entry : std::filesystem::directory_iterator(CNCPLAN_REJECTED))
    files.push_back(entry.path());
  std::sort(files.begin(), files.end());
  REQUIRE(files.size() > 80);
  for (const auto& file : files) {
    std::ifstream stream(file, std::ios::binary);
    std::stringstream text;
    text << stream.rdbuf();
    const std::string program = text.str();
    INFO(file.filename().string());
    const std::string expected = program.substr(2, program.find('\n') - 2);  // behind "; "
    gcode::Reader reader;
    const auto done = gcode::read_program(gcode::TextLines(program), reader, [](const gcode::Item&) {});
    REQUIRE_FALSE(done);
    const std::string found = gcode::to_text("", done.error());
    CHECK(found == expected);
  }
}
