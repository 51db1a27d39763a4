// Runs the built cncplan_tire_mold as somebody outside would, in a folder of its own.
#pragma once

#include <cstdlib>
#include <sstream>
#include <string>
#include <vector>

#include "support/program_run.hpp"

namespace cncplan::test {

struct Folder : TemporaryFolder {
  [[nodiscard]] Outcome run(const std::string& arguments) const {
    return run_program(CNCPLAN_TIRE_MOLD, arguments);
  }
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
