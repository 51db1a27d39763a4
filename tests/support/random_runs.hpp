// Programs of lines that nearly are one, under G64 Q.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdio>
#include <string>
#include <vector>

#include "support/random.hpp"

namespace cncplan::test {

/// Runs along headings that bend or jump, with noise around each run; feeds, words, stops, tolerances,
/// rapids, arcs and moves back in between, all within `tolerance` mm at most. `letters` move as well, along
/// each run in proportion.
inline std::vector<std::string> random_runs(Random& random, int runs, const std::string& letters,
                                            double reach, double tolerance = 0.01) {
  std::vector<std::string> lines;
  char text[200];
  const auto add = [&](const char* format, auto... arguments) {
    std::snprintf(text, sizeof text, format, arguments...);
    lines.emplace_back(text);
  };
  double x = 0, y = 0, z = 0, heading = 0;
  std::vector<double> others(letters.size());
  add("F%.0f", random.log_uniform(300, 3000));
  const auto merge = [&](double share) {
    add("G64 P%.8f Q%.8f", share * tolerance, tolerance * random.log_uniform(0.05, 2));
  };
  merge(1);
  for (int run = 0; run < runs; ++run) {
    switch (random.integer(0, 14)) {
      case 0:
        add("F%.0f", random.log_uniform(300, 3000));
        break;
      case 1:
        merge(random.log_uniform(0.1, 1));
        break;
      case 2:
        lines.emplace_back(random.coin() ? "G64" : "G61.1");
        break;
      case 3:
        lines.emplace_back("G4 P0.01");
        break;
      case 4:
        lines.emplace_back("M8");
        break;
      case 5:
        add("G0 X%.6f", x += random.uniform(-1, 1));
        break;
      case 6:
        merge(1);
        break;
      case 7:
        add("G1 X%.6f Y%.6f", x, y);
        add("G3 X%.6f Y%.6f I0.5 J0", x + 1, y);
        x += 1;
        break;
      default:
        break;
    }
    const double noise = random.coin() ? tolerance * random.log_uniform(1e-3, 1) : 0;
    const double step = random.log_uniform(0.01, 1), bend = random.coin() ? random.uniform(-0.05, 0.05) : 0;
    heading = std::hypot(x, y) > reach ? std::atan2(-y, -x)
                                       : heading + random.uniform(-1, 1) * random.uniform(0, 3);
    std::vector<double> rates;
    for (std::size_t i = 0; i < letters.size(); ++i)
      rates.push_back(random.integer(0, 2) == 0 ? random.uniform(-2, 2) : 0);
    for (int i = random.integer(1, 30); i > 0; --i) {
      heading += bend;
      const double way = step * (random.integer(0, 40) == 0 ? -0.01 : random.uniform(0.5, 1));
      x += way * std::cos(heading), y += way * std::sin(heading), z += 0.1 * way;
      std::string words;
      for (std::size_t k = 0; k < letters.size(); ++k) {
        others[k] += rates[k] * way;
        std::snprintf(text, sizeof text, " %c%.6f", letters[k],
                      others[k] + 10 * noise * random.uniform(-1, 1));
        words += text;
      }
      add("G1 X%.6f Y%.6f Z%.6f%s", x + noise * random.uniform(-1, 1), y + noise * random.uniform(-1, 1), z,
          words.c_str());
      if (random.integer(0, 60) == 0) lines.emplace_back(random.coin() ? "M8" : "M9");
    }
  }
  lines.emplace_back("M30");
  return lines;
}

}  // namespace cncplan::test
