// cncplan_generate KIND [--seed N] [--plane 17|18|19] [--arcs radius|center|split|lines] [--degrees D]: a
// program like those of KK22's experiments, on standard output; cncplan_generate --rewrite FILE: that
// program, its arcs as asked for.
#include <CLI/CLI.hpp>
#include <cstdint>
#include <fstream>
#include <iterator>
#include <numbers>
#include <optional>
#include <sstream>
#include <string>

#include "cncplan/arc_words.hpp"
#include "cncplan/gcode/diagnostic_text.hpp"
#include "cncplan/gcode/read_program.hpp"
#include "cncplan/gcode/stream_lines.hpp"
#include "cncplan/gcode/writer.hpp"
#include "programs.hpp"
#include "support/arguments.hpp"
#include "support/failure.hpp"
#include "support/main_program.hpp"

namespace {

using namespace cncplan;
using support::Exit;
using support::Failure;

// A program read and written anew, its arcs as asked for: center, by centre; radius, by radius where that
// says them, else by centre; split, all by radius, in parts where need be; lines, straight lines of so many
// degrees at most (U09 3.2.2).
std::string rewritten(std::istream& program, const std::string& name, const std::string& arcs,
                      double degrees) {
  std::string text;
  gcode::Reader reader;
  gcode::Writer writer;
  const auto write = [&](const gcode::Item& item) {
    if (const auto done = writer.write(item, std::back_inserter(text)); !done)
      throw Failure(Exit::bad_input, name + ": " + to_text(done.error()));
  };
  const auto arcs_written = [&](const gcode::Item& item) {
    const auto* motion = std::get_if<gcode::Motion>(&item);
    if (motion == nullptr) return write(item);
    if (arcs == "split") return split_by_radius(*motion, write);
    if (arcs == "lines") {
      if (const auto done = split_into_lines(*motion, degrees * std::numbers::pi / 180.0, write); !done)
        throw Failure(Exit::bad_input, gcode::to_text(name, {done.error(), motion->line, motion->column}));
      return;
    }
    write(arcs == "radius" ? by_radius(*motion) : by_center(*motion).value_or(*motion));
  };
  const auto read = gcode::read_program(gcode::StreamLines(program), reader, arcs_written);
  if (!read) throw Failure(Exit::bad_input, gcode::to_text(name, read.error()));
  writer.finish(std::back_inserter(text));
  return text;
}

}  // namespace

int main(int count, char** arguments) {
  return support::main_program([&] {
    std::optional<std::string> kind, file;
    std::string arcs = "radius";
    std::uint64_t seed = 2022;
    double degrees = 1.0;
    int plane = 17;
    CLI::App app("Writes a program like those of KK22's experiments: R-format arcs, no feeds.",
                 "cncplan_generate");
    auto* named = app.add_option("kind", kind, "roughing, finishing or pocket")
                      ->check(CLI::IsMember({"roughing", "finishing", "pocket"}));
    app.add_option("--seed", seed, "another program of the same kind")->capture_default_str();
    app.add_option("--plane", plane, "17, 18 or 19")
        ->check(CLI::IsMember({17, 18, 19}))
        ->capture_default_str();
    app.add_option(
           "--arcs", arcs,
           "radius: R, by centre what R cannot say well; center: I J K; split: R, such arcs in parts; "
           "lines: G1")
        ->check(CLI::IsMember({"radius", "center", "split", "lines"}))
        ->capture_default_str();
    app.add_option("--degrees", degrees, "with --arcs lines: that each line turns at most")
        ->check(support::positive())
        ->capture_default_str();
    app.add_option("--rewrite", file, "no new program: this one, with its arcs by --arcs")->excludes(named);
    if (!support::parse(app, count, arguments)) return 0;
    if (!kind && !file) throw Failure(Exit::bad_input, "a kind of program, or --rewrite, is needed");

    std::stringstream program;
    if (file) {
      const std::ifstream stream(*file);
      program << stream.rdbuf();
      if (!stream || program.fail()) throw Failure(Exit::bad_input, *file + ": cannot be read");
    } else {
      generate::Kind made{};
      generate::parse(*kind, made);
      generate::write(program, made, seed, plane);
    }
    const bool as_it_is = arcs == "radius" && !file;
    support::print(as_it_is ? program.str() : rewritten(program, file ? *file : *kind, arcs, degrees));
    return 0;
  });
}
