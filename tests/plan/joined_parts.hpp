// A program that is planned in parts, as one trajectory.
#pragma once

#include <cstddef>
#include <utility>
#include <vector>

#include "cncplan/plan/smooth_stream.hpp"

namespace cncplan::test {

/// What a stream that holds so many blocks gives, one part behind the other; into `parts` when each one ends.
template <class B, MachineModel M>
Expected<Trajectory<M, plan::SmoothBlockOf<B>>, ProgramError> plan_in_parts(
    const std::vector<B>& given, const M& machine, const PlanOptions& options, SmoothLevel level,
    std::size_t held, std::vector<double>* parts = nullptr) {
  using Stream = SmoothStream<M, B>;
  Stream stream(machine, options, level, held);
  std::vector<typename Stream::Block> blocks;
  std::vector<typename Stream::Part::Phase> phases;
  typename Stream::Part::Smoothing smoothing;
  double time = 0;
  const auto take = [&] {
    if (!stream.ready()) return;
    const auto part = stream.take();
    for (auto phase : part.phases()) {
      phase.phase.time += time;
      phase.block += blocks.size();
      phases.push_back(phase);
    }
    for (std::size_t b = 0; b < part.program().size(); ++b) {
      smoothing.blocks.emplace_back();
      if (part.smoothing().blocks.empty()) continue;
      smoothing.blocks.back() = part.smoothing().blocks[b];
      smoothing.blocks.back().first += smoothing.corrections.size();
    }
    const auto& corrections = part.smoothing().corrections;
    smoothing.corrections.insert(smoothing.corrections.end(), corrections.begin(), corrections.end());
    blocks.insert(blocks.end(), part.program().begin(), part.program().end());
    time += part.duration();
    if (parts != nullptr) parts->push_back(time);
  };
  for (const B& block : given) {
    if (const auto ok = stream.push(block); !ok) return tl::unexpected(ok.error());
    take();
  }
  if (const auto ok = stream.finish(); !ok) return tl::unexpected(ok.error());
  take();
  return typename Stream::Part(machine, std::move(blocks), std::move(phases), std::move(smoothing));
}

}  // namespace cncplan::test
