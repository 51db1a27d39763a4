// Runs the built cncplan_tire_mold as somebody outside would, in a folder of its own.
#pragma once

#include <stdlib.h>
#include <sys/wait.h>

#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <nlohmann/json.hpp>
#include <sstream>
#include <stdexcept>
#include <string>
#include <vector>

namespace cncplan::test {

struct Outcome {
  int exit{};
  std::string out;
  std::string err;
};

/// A temporary folder to run in; it goes with the object.
class Folder {
 public:
  Folder() {
    std::string name = (std::filesystem::temp_directory_path() / "cncplan-XXXXXX").string();
    if (::mkdtemp(name.data()) == nullptr) throw std::runtime_error("no temporary folder");
    path_ = name;
  }
  Folder(const Folder&) = delete;
  Folder& operator=(const Folder&) = delete;
  ~Folder() {
    std::error_code ignored;
    std::filesystem::remove_all(path_, ignored);
  }

  void write(const std::string& name, const std::string& text) const {
    std::ofstream(path_ / name, std::ios::binary) << text;
  }
  [[nodiscard]] std::string read(const std::string& name) const {
    std::ifstream stream(path_ / name, std::ios::binary);
    return {std::istreambuf_iterator<char>(stream), {}};
  }
  [[nodiscard]] bool has(const std::string& name) const { return std::filesystem::exists(path_ / name); }

  [[nodiscard]] Outcome run(const std::string& arguments) const {
    const std::string command =
        "cd '" + path_.string() + "' && </dev/null '" CNCPLAN_TIRE_MOLD "' " + arguments + " >.out 2>.err";
    const int status = std::system(command.c_str());
    return {WIFEXITED(status) ? WEXITSTATUS(status) : -1, read(".out"), read(".err")};
  }

 private:
  std::filesystem::path path_;
};

/// Numbers of a CSV file without its first line.
inline std::vector<std::vector<double>> rows_of(const std::string& text) {
  std::vector<std::vector<double>> rows;
  std::istringstream lines(text);
  std::string line;
  std::getline(lines, line);
  while (std::getline(lines, line)) {
    auto& row = rows.emplace_back();
    const char* at = line.c_str();
    for (char* end = nullptr;; at = end + 1) {
      row.push_back(std::strtod(at, &end));
      if (*end != ',') break;
    }
  }
  return rows;
}

/// A DXF file of the given entities, each a list of "code value" pairs by lines.
inline std::string dxf(const std::string& entities) {
  return "  0\nSECTION\n  2\nENTITIES\n" + entities + "  0\nENDSEC\n  0\nEOF\n";
}
inline std::string dxf_line(double x0, double y0, double x1, double y1) {
  std::ostringstream text;
  text.precision(12);
  text << "  0\nLINE\n  8\n0\n 10\n" << x0 << "\n 20\n" << y0 << "\n 11\n" << x1 << "\n 21\n" << y1 << "\n";
  return text.str();
}
inline std::string dxf_arc(double x, double y, double radius, double from, double to) {
  std::ostringstream text;
  text.precision(12);
  text << "  0\nARC\n  8\n0\n 10\n"
       << x << "\n 20\n"
       << y << "\n 40\n"
       << radius << "\n 50\n"
       << from << "\n 51\n"
       << to << "\n";
  return text.str();
}

}  // namespace cncplan::test
