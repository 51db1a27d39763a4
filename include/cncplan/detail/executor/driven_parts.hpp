// Parts of a plan that a clock drives one behind the other: what they tell, and where their blocks begin
// (set-up).
#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <optional>

namespace cncplan::detail {

/// By the time of a chain of all parts. `Planner`: a `PartPlanner`, or what has its functions; it has the
/// parts.
template <class Planner>
class DrivenParts {
 public:
  using Clocked = typename Planner::Clocked;
  using S = typename Clocked::S;
  using Word = typename Clocked::Word;

  /// A part in the chain.
  struct Driven {
    S start{}, tail_start{};  ///< s
    std::size_t motions{};    ///< of the chain
    bool has_tail{};          ///< that is driven
  };

  explicit DrivenParts(const Planner& planner) : planner_(&planner) {}

  [[nodiscard]] Driven& operator[](std::int64_t number) { return known_[place(number)]; }
  [[nodiscard]] const Driven& operator[](std::int64_t number) const { return known_[place(number)]; }
  /// The oldest that is kept, and behind the last one.
  [[nodiscard]] std::int64_t oldest() const { return oldest_; }
  [[nodiscard]] std::int64_t end() const { return end_; }
  [[nodiscard]] Driven& last() { return (*this)[end_ - 1]; }
  /// Another one, which begins so late.
  Driven& take(S start) { return (*this)[end_++] = {start, S(0), 0, false}; }
  /// Whether the oldest is told, and others are.
  [[nodiscard]] bool oldest_is_told() const { return told_part_ > oldest_; }
  void forget_oldest() { ++oldest_; }

  /// Words before a time of the first part count as told.
  void begin_words_at(S time) {
    const auto& words = planner_->part(0).motion->words;
    told_ = static_cast<std::size_t>(
        std::ranges::partition_point(words, [&](const Word& word) { return word.time < time; }) -
        words.begin());
  }
  /// The word that is to be told next, by the time of the chain; nothing where there is none.
  [[nodiscard]] std::optional<Word> next_word() {
    while (told_part_ < end_) {
      const Driven& now = (*this)[told_part_];
      const auto& words = words_of(told_part_);
      if (told_ < words.size()) {
        Word result = words[told_];
        result.time += tells_tail_ ? now.tail_start : now.start;
        return result;
      }
      if (!tells_tail_ && now.has_tail) {
        tells_tail_ = true;
      } else if (told_part_ + 1 < end_) {
        ++told_part_;
        tells_tail_ = false;
      } else {
        return std::nullopt;
      }
      told_ = 0;
    }
    return std::nullopt;
  }
  void pass_word() { ++told_; }
  [[nodiscard]] bool all_told() const {
    return end_ == 0 || (told_part_ + 1 == end_ && tells_tail_ == (*this)[told_part_].has_tail &&
                         told_ == words_of(told_part_).size());
  }

  /// Calls visit(word) for those that have been told, from a time on, by the time of the chain.
  template <class Visit>
  void each_told_from(S from, Visit&& visit) const {
    const auto in = [&](const auto& words, S start, std::size_t told) {
      for (std::size_t i = 0; i < std::min(told, words.size()); ++i)
        if (Word word = words[i]; !((word.time += start) < from)) visit(word);
    };
    constexpr std::size_t all = std::numeric_limits<std::size_t>::max();
    for (std::int64_t i = oldest_; i < end_ && i <= told_part_; ++i) {
      const auto& part = planner_->part(i);
      const bool last = i == told_part_;
      in(part.motion->words, (*this)[i].start, last && !tells_tail_ ? told_ : all);
      if ((*this)[i].has_tail && (!last || tells_tail_))
        in(part.tail->words, (*this)[i].tail_start, last ? told_ : all);
    }
  }

  /// Calls visit(time, start of a block) for those of all that is driven, from a time on, until it says that
  /// it is enough. `tail_ahead`: the last one's tail counts, too.
  template <class Visit>
  void each_begin_from(S from, bool tail_ahead, Visit&& visit) const {
    const auto in = [&](const Clocked& motion, S start) {
      const auto& all = motion.begins;
      auto one = std::ranges::partition_point(all, [&](const auto& own) { return own.time < from - start; });
      for (; one != all.end(); ++one)
        if (visit(start + one->time, *one)) return true;
      return false;
    };
    for (std::int64_t i = oldest_; i < end_; ++i) {
      const auto& part = planner_->part(i);
      const Driven& now = (*this)[i];
      if (in(*part.motion, now.start)) return;
      if ((now.has_tail || (tail_ahead && i + 1 == end_)) && in(*part.tail, now.tail_start)) return;
    }
  }

 private:
  static constexpr auto most = static_cast<std::size_t>(Planner::most_parts);

  [[nodiscard]] static std::size_t place(std::int64_t number) {
    return static_cast<std::size_t>(number) % most;
  }
  [[nodiscard]] const auto& words_of(std::int64_t number) const {
    const auto& part = planner_->part(number);
    return tells_tail_ ? part.tail->words : part.motion->words;
  }

  const Planner* planner_;
  std::int64_t oldest_ = 0, end_ = 0;
  std::array<Driven, most> known_{};
  // The next word.
  std::int64_t told_part_ = 0;
  std::size_t told_ = 0;
  bool tells_tail_ = false;
};

}  // namespace cncplan::detail
