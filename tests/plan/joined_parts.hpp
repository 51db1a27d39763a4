// A program that is planned in parts, as one trajectory.
#pragma once

#include <cstddef>
#include <memory_resource>
#include <tuple>
#include <utility>
#include <vector>

#include "cncplan/smooth_stream.hpp"
#include "plan/at_level.hpp"

namespace cncplan::test {

/// Takes the parts of a stream, one behind the other.
template <class B, MachineModel M>
class JoinedParts {
 public:
  using Part = typename SmoothStream<M, B>::Part;

  void take(SmoothStream<M, B>& stream) {
    if (!stream.ready()) return;
    const Part part = stream.take();
    for (auto phase : part.phases()) {
      phase.phase.time += time_;
      phase.piece += pieces_.size();
      phases_.push_back(phase);
    }
    for (const auto& piece : part.pieces()) {
      pieces_.push_back(piece);
      pieces_.back().block += part.first_block();
    }
    for (std::size_t b = 0; b < part.program().size(); ++b) {
      const std::size_t number = part.first_block() + b;
      if (number < blocks_.size()) {  // it goes on in this part, which has its end
        const auto word = blocks_[number].word;
        blocks_[number] = part.program()[b];
        blocks_[number].word = word;
        continue;
      }
      blocks_.push_back(part.program()[b]);
      smoothing_.blocks.emplace_back();
      if (part.smoothing().blocks.empty()) continue;
      smoothing_.blocks.back() = part.smoothing().blocks[b];
      smoothing_.blocks.back().first += smoothing_.corrections.size();
    }
    const auto& corrections = part.smoothing().corrections;
    smoothing_.corrections.insert(smoothing_.corrections.end(), corrections.begin(), corrections.end());
    time_ += part.duration();
    ends_.push_back(time_);
  }

  /// When each part ends.
  [[nodiscard]] const std::vector<double>& ends() const { return ends_; }
  [[nodiscard]] Part trajectory(const M& machine) const {
    auto [blocks, phases, smoothing, pieces] = std::tuple(blocks_, phases_, smoothing_, pieces_);
    return {machine, std::move(blocks), std::move(phases), std::move(smoothing), std::move(pieces)};
  }

 private:
  std::pmr::vector<typename Part::Block> blocks_;
  std::pmr::vector<typename Part::Piece> pieces_;
  std::pmr::vector<typename Part::Phase> phases_;
  typename Part::Smoothing smoothing_;
  double time_ = 0;
  std::vector<double> ends_;
};

/// What a stream that holds so many blocks gives; into `ends` when each part ends.
template <class B, MachineModel M>
Expected<Trajectory<M, B>, ProgramError> plan_in_parts(const std::vector<B>& given, const M& machine,
                                                       const PlanOptions& options, SmoothLevel level,
                                                       std::size_t held,
                                                       std::vector<double>* ends = nullptr) {
  SmoothStream<M, B> stream(machine, at_level(level, options), held);
  JoinedParts<B, M> parts;
  for (const B& block : given) {
    if (const auto ok = stream.push(block); !ok) return tl::unexpected(ok.error());
    parts.take(stream);
  }
  if (const auto ok = stream.finish(); !ok) return tl::unexpected(ok.error());
  parts.take(stream);
  if (ends != nullptr) *ends = parts.ends();
  return parts.trajectory(machine);
}

}  // namespace cncplan::test
