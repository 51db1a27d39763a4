// cncplan_kk22 MACHINE [--plot DIR] [--program NAME...] [--figures] [--planar]: the experiments of KK22,
// paper and ours side by side; docs/kk22.md shows what it prints. MACHINE is examples/machines/kk22.toml.
#include <CLI/CLI.hpp>
#include <optional>
#include <string>
#include <vector>

#include "experiments.hpp"
#include "support/arguments.hpp"
#include "support/main_program.hpp"

int main(int argc, char** argv) {
  return support::main_program([&] {
    std::string machine;
    std::optional<std::string> folder;
    std::vector<std::string> programs{"roughing", "finishing", "pocket"};
    bool figures = false, planar = false;
    CLI::App app("Runs the experiments of KK22 and prints paper and cncplan side by side.", "cncplan_kk22");
    app.add_option("machine", machine, "machine file, TOML")->required();
    app.add_option("--plot", folder, "draw the figures into this folder, SVG");
    app.add_option("--program", programs, "these of the three programs")->check(CLI::IsMember(programs));
    app.add_flag("--figures", figures, "the figures alone, without the programs");
    app.add_flag(
        "--planar", planar,
        "plan as published by the arcs' lengths in their planes, R theta (section 3.1), not in space");
    if (!support::parse(app, argc, argv)) return 0;

    const support::Machine table = support::read_machine(machine);
    std::optional<support::Gnuplot> plot;
    if (folder) {
      support::make_folder(*folder);
      plot = support::Gnuplot::start(*folder);
    }
    support::Gnuplot* const pictures = plot ? &*plot : nullptr;
    kk22::figure7(pictures);
    kk22::figure8(pictures);
    kk22::figure9(pictures);
    kk22::figure11(pictures);
    const auto lengths = planar ? kk22::Lengths::planar : kk22::Lengths::in_space;
    kk22::figure14(lengths, pictures);
    kk22::pictures(pictures);
    if (!figures) kk22::programs(table, programs, lengths, pictures);
    if (plot) plot->finish();
    return 0;
  });
}
