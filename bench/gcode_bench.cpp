// Reading G-code, beside what it costs to find the lines.
#include <benchmark/benchmark.h>

#include <cstring>
#include <sstream>
#include <string>
#include <variant>

#include "../apps/generate/programs.hpp"
#include "cncplan/gcode/read_program.hpp"
#include "cncplan/gcode/writer.hpp"

namespace {

using namespace cncplan;

// The finishing of a sphere: 35000 lines, short moves with four decimals, as CAM programs are.
const std::string& text() {
  static const std::string program = [] {
    std::ostringstream stream;
    generate::write(stream, generate::Kind::finishing);
    return stream.str();
  }();
  return program;
}

void report(benchmark::State& state, std::int64_t items) {
  state.SetItemsProcessed(items * state.iterations());
  state.SetBytesProcessed(static_cast<std::int64_t>(text().size()) * state.iterations());
}

void newline_scan(benchmark::State& state) {
  std::int64_t lines = 0;
  for (auto _ : state) {
    lines = 0;
    const char* const end = text().data() + text().size();
    for (const char* at = text().data(); at != end; ++lines)
      at = static_cast<const char*>(std::memchr(at, '\n', static_cast<std::size_t>(end - at))) + 1;
    benchmark::DoNotOptimize(lines);
  }
  report(state, lines);
}
BENCHMARK(newline_scan)->Name("floor/newline_scan");

// Items: lines.
void read(benchmark::State& state) {
  std::int64_t lines = 0;
  for (auto _ : state) {
    gcode::Reader reader;
    double sum = 0.0;
    const auto done = gcode::read_program(gcode::TextLines(text()), reader, [&sum](const gcode::Item& item) {
      if (const auto* motion = std::get_if<gcode::Motion>(&item)) sum += motion->end[0];
    });
    if (!done) state.SkipWithError("the program does not read");
    benchmark::DoNotOptimize(sum);
    lines = reader.line();
  }
  report(state, lines);
}
BENCHMARK(read)->Name("gcode/read");

void write(benchmark::State& state) {
  std::vector<gcode::Item> items;
  gcode::Reader reader;
  if (!gcode::read_program(gcode::TextLines(text()), reader,
                           [&items](const gcode::Item& item) { items.push_back(item); }))
    state.SkipWithError("the program does not read");
  std::string written;
  written.reserve(2 * text().size());
  for (auto _ : state) {
    written.clear();
    gcode::Writer writer;
    for (const gcode::Item& item : items)
      if (!writer.write(item, std::back_inserter(written))) state.SkipWithError("an item does not write");
    writer.finish(std::back_inserter(written));
    benchmark::DoNotOptimize(written.data());
  }
  state.SetItemsProcessed(static_cast<std::int64_t>(items.size()) * state.iterations());
  state.SetBytesProcessed(static_cast<std::int64_t>(written.size()) * state.iterations());
}
BENCHMARK(write)->Name("gcode/write");

}  // namespace
