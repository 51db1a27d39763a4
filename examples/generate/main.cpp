// cncplan_generate KIND [--seed N] [--plane 17|18|19]: a program like those of KK22's experiments, on
// standard output.
#include <CLI/CLI.hpp>
#include <cstdint>
#include <iostream>
#include <string>

#include "programs.hpp"

int main(int count, char** arguments) {
  std::string name;
  std::uint64_t seed = 2022;
  int plane = 17;
  CLI::App app("Writes a program like those of KK22's experiments: R-format arcs, no feeds.",
               "cncplan_generate");
  app.add_option("kind", name, "roughing, finishing or pocket")
      ->required()
      ->check(CLI::IsMember({"roughing", "finishing", "pocket"}));
  app.add_option("--seed", seed, "another program of the same kind")->capture_default_str();
  app.add_option("--plane", plane, "17, 18 or 19")->check(CLI::IsMember({17, 18, 19}))->capture_default_str();
  try {
    app.parse(count, arguments);
  } catch (const CLI::ParseError& error) {
    return app.exit(error) == 0 ? 0 : 2;
  }
  cncplan::generate::Kind kind{};
  cncplan::generate::parse(name, kind);
  std::ios::sync_with_stdio(false);
  cncplan::generate::write(std::cout, kind, seed, plane);
  return std::cout.flush() ? 0 : 1;
}
