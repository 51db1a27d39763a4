// Prints what a map costs: a program planned for a mill, and for the same mill behind the identity map. Times
// of motion, and processor time a block, reading excluded: medians of five, taken by turns.
//   cncplan_identity_map FILE [LINES]    the first so many lines; 3000 if not given
#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdio>
#include <cstdlib>
#include <ctime>
#include <fstream>
#include <string>
#include <utility>
#include <vector>

#include "cncplan/core/jet.hpp"
#include "cncplan/plan_program.hpp"

namespace {

using namespace cncplan;

constexpr int repeats = 5;

// Joints that are the programmed coordinates.
struct Identity {
  using Scalar = double;
  static constexpr int axis_count = 3;

  template <NumberOver<double> T>
  [[nodiscard]] std::array<T, 3> joints(const std::array<T, 3>& point) const {
    return point;
  }
};

template <class M>
M mill() {
  M machine{.limits = {.velocity = 30, .acceleration = 1000, .jerk = 1e4}};
  for (std::size_t i = 0; i < 3; ++i)
    machine.axes[i] = {.letter = "XYZ"[i], .velocity = 30, .acceleration = 1000, .jerk = 1e4};
  return machine;
}

// s of motion; the processor's microseconds a block.
struct Cost {
  double motion{}, work{};
};

template <class M>
Cost cost(const Program<M>& program, const M& machine, const PlanOptions& options) {
  const std::clock_t begin = std::clock();
  const auto planned = plan_program(program, machine, options);
  const double work = 1e6 * static_cast<double>(std::clock() - begin) / CLOCKS_PER_SEC;
  if (!planned) {
    std::fprintf(stderr, "%s\n", to_text(planned.error()).c_str());
    std::exit(1);
  }
  return {planned->duration(), work / static_cast<double>(program.blocks().size())};
}

double median(std::array<double, repeats> values) {
  std::sort(values.begin(), values.end());
  return values[repeats / 2];
}

}  // namespace

int main(int argc, char** argv) {
  if (argc < 2) {
    std::fprintf(stderr, "usage: cncplan_identity_map FILE [LINES]\n");
    return 2;
  }
  const long most = argc > 2 ? std::strtol(argv[2], nullptr, 10) : 3000;
  std::ifstream file(argv[1]);
  std::string text, line;
  for (long i = 0; i < most && std::getline(file, line); ++i) text += line + "\n";
  const auto plain = mill<Machine<3>>();
  const auto mapped = mill<MappedMachine<Identity>>();
  const auto program = read_text(text, plain);
  const auto behind_map = read_text(text, mapped);
  if (text.empty() || program.failed() || behind_map.failed()) {
    std::fprintf(stderr, "%s: error: it does not read\n", argv[1]);
    return 2;
  }
  std::printf("%zu blocks\n", program.blocks().size());
  std::printf("| level | motion, s | with the map, s | more, %% | us a block | with the map, us | times |\n");
  std::printf("|---|---|---|---|---|---|---|\n");
  const std::array<std::pair<const char*, SmoothLevel>, 4> levels{{{"exact", SmoothLevel::exact},
                                                                   {"fast", SmoothLevel::fast},
                                                                   {"good", SmoothLevel::good},
                                                                   {"best", SmoothLevel::best}}};
  for (const auto& [name, level] : levels) {
    const PlanOptions options{.tolerance = level == SmoothLevel::exact ? 0 : 0.01, .level = level};
    std::array<double, repeats> own{}, other{};
    Cost without, with;
    for (std::size_t i = 0; i < repeats; ++i) {
      own[i] = (without = cost(program, plain, options)).work;
      other[i] = (with = cost(behind_map, mapped, options)).work;
    }
    std::printf("| %s | %.3f | %.3f | %.2f | %.1f | %.1f | %.2f |\n", name, without.motion, with.motion,
                100 * (with.motion / without.motion - 1), median(own), median(other),
                median(other) / median(own));
    std::fflush(stdout);
  }
  return 0;
}
