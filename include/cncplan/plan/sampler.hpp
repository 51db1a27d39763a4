// The samples of a whole program, one by one or many at once.
#pragma once

#include <algorithm>
#include <array>
#include <concepts>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>

#include "cncplan/core/points.hpp"
#include "cncplan/interpolate/evaluate.hpp"
#include "cncplan/interpolate/grid.hpp"
#include "cncplan/plan/block.hpp"
#include "cncplan/plan/cursor.hpp"

namespace cncplan::plan {

/// A sample, and the block it lies in. `sample.along.position` counts from the start of the program.
template <std::floating_point S>
struct BasicProgramSample {
  std::size_t block{};
  interpolate::BasicSample<S, BasicVector3<S>> sample;
};

using ProgramSample = BasicProgramSample<double>;

/// Walks a planned program on the grid k period from its first to its last block: unused time goes from block
/// to block by itself, as times are never counted within a block. The last sample stands at the program's end
/// on its end point; without blocks there is none. Blocks, spans and lengths belong to the caller. No heap; a
/// call takes as long as it passes blocks and spans.
template <std::floating_point S>
class BasicSampler {
 public:
  using Scalar = S;

  BasicSampler(std::span<const BasicBlock<S>> blocks, std::span<const BasicSpan<S>> spans,
               std::span<const S> lengths, S period)
      : blocks_(blocks),
        cursor_(spans, lengths),
        grid_{period, plan::duration(spans)},
        size_(blocks.empty() ? 0 : grid_.size()) {}

  [[nodiscard]] const interpolate::BasicGrid<S>& grid() const { return grid_; }
  [[nodiscard]] std::int64_t size() const { return size_; }
  /// The number of the next sample.
  [[nodiscard]] std::int64_t index() const { return next_; }

  /// The next sample, none behind the last.
  [[nodiscard]] std::optional<BasicProgramSample<S>> next() {
    if (next_ == size_) return std::nullopt;
    const S time = grid_.time(next_++);
    const BasicPlace<S> place = cursor_.at(time);
    BasicState<S> within = place.state;
    within.position = place.along;
    BasicProgramSample<S> result{place.block,
                                 interpolate::evaluate(blocks_[place.block].segment, within, time)};
    result.sample.along = place.state;
    return result;
  }

  /// Writes the positions of the next samples into the columns of `out`, as many as there are of both, and
  /// returns how many. Equal to those of `next` to rounding.
  Eigen::Index positions(BasicPoints<S> out) {
    std::array<S, 64> along;
    Eigen::Index written = 0;
    while (written < out.cols() && next_ < size_) {
      const std::int64_t left = std::min<std::int64_t>(out.cols() - written, size_ - 1 - next_);
      if (left == 0) {
        out.col(written++) = next()->sample.position;
        break;
      }
      const auto room = static_cast<std::size_t>(std::min<std::int64_t>(left, along.size()));
      const auto run = cursor_.run(grid_.period, next_, std::span(along).first(room));
      const auto count = static_cast<Eigen::Index>(run.count);
      blocks_[run.block].segment.positions_at(std::span<const S>(along).first(run.count),
                                              BasicPoints<S>(out.col(written).data(), 3, count));
      written += count;
      next_ += count;
    }
    return written;
  }

 private:
  std::span<const BasicBlock<S>> blocks_;
  BasicCursor<S> cursor_;
  interpolate::BasicGrid<S> grid_;
  std::int64_t size_;
  std::int64_t next_ = 0;
};

using Sampler = BasicSampler<double>;

}  // namespace cncplan::plan
