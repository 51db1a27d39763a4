// Plans a G-code program, from a text or a file, into a trajectory (set-up).
#pragma once

#include <algorithm>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "cncplan/block_builder.hpp"
#include "cncplan/core/compiled.hpp"
#include "cncplan/plan_blocks.hpp"
#include "cncplan/program.hpp"

namespace cncplan {

/// The words of a program that others act on, each with the time at which a trajectory that was planned of
/// its blocks, of all of them, comes to it: for `Trajectory::set_words`.
template <class T>
[[nodiscard]] std::vector<TimedWord> timed_words(const ProgramRecord& program, const T& trajectory) {
  std::vector<TimedWord> words;
  words.reserve(program.words().size());
  for (const ProgramWord& word : program.words())
    words.push_back({word.word, static_cast<double>(trajectory.start_time(word.block))});
  return words;
}

namespace detail {

/// Nothing, or why a program cannot be planned: its first error, or a start that is not the one it was read
/// with.
[[nodiscard]] inline Expected<void, ProgramError> plannable(const ProgramRecord& program,
                                                            const std::array<double, 9>& start) {
  if (const Problem* error = program.first_error()) return tl::unexpected(ProgramError(*error));
  const auto [read, given] = std::mismatch(program.start().begin(), program.start().end(), start.begin());
  if (given == start.end()) return {};
  return tl::unexpected(ProgramError{{{ErrorCode::not_as_read, "start", *given, *read}, 0, 0, {}}});
}

/// What a trajectory tells of the program that it was planned of.
template <class T>
void tell(T& trajectory, const ProgramRecord& program, bool smoothed) {
  trajectory.set_words(timed_words(program, trajectory));
  std::vector<std::string> warnings;
  for (const Problem& problem : program.problems()) warnings.push_back(to_text(problem));
  if (!smoothed)
    for (const Problem& problem : program.if_not_smoothed()) warnings.push_back(to_text(problem));
  trajectory.set_warnings(std::move(warnings));
}

/// A program planned by `plan_of`, which takes its blocks.
template <MachineModel M, class Plan>
[[nodiscard]] Expected<Trajectory<M, ProgramBlock<M>>, ProgramError> planned(
    const ProgramRecord& program, const std::array<double, 9>& start, bool smoothed, Plan&& plan_of) {
  if (auto ok = plannable(program, start); !ok) return tl::unexpected(std::move(ok.error()));
  auto trajectory = plan_of();
  if (trajectory)
    tell(*trajectory, program, smoothed);
  else
    trajectory.error().file = program.file_of(trajectory.error().block.value_or(0));
  return trajectory;
}

}  // namespace detail

/// Plans a program; of the options, those that act when it is read (dialect, arcs, subprograms) do not act
/// again. Errors: the first one of the program; not_as_read for another start; those of `plan_blocks`.
template <MachineModel M>
[[nodiscard]] Expected<Trajectory<M, ProgramBlock<M>>, ProgramError> plan_program(
    const Program<M>& program, const M& machine, const PlanOptions& options = {}) {
  return detail::planned<M>(program, options.start, level_of(options) != SmoothLevel::exact,
                            [&] { return plan_blocks(program.blocks(), machine, options); });
}
/// The same, with the blocks of the program itself.
template <MachineModel M>
[[nodiscard]] Expected<Trajectory<M, ProgramBlock<M>>, ProgramError> plan_program(
    Program<M>&& program, const M& machine, const PlanOptions& options = {}) {
  return detail::planned<M>(program, options.start, level_of(options) != SmoothLevel::exact,
                            [&] { return plan_blocks(std::move(program).take_blocks(), machine, options); });
}

/// Plans a program on the exact path, with a policy of one's own for junctions (`JunctionPolicy`) and a law
/// for changes of speed (`profile::FivePhase`, `profile::SevenPhase`). Errors as above; the start is the
/// program's.
template <MachineModel M, JunctionPolicy<typename M::Scalar> Policy,
          profile::RampLaw<typename M::Scalar> Law = profile::SevenPhase>
[[nodiscard]] Expected<Trajectory<M, ProgramBlock<M>>, ProgramError> plan_program(const Program<M>& program,
                                                                                  const M& machine,
                                                                                  const Policy& policy,
                                                                                  const Law& law = {}) {
  return detail::planned<M>(program, program.start(), false,
                            [&] { return plan_blocks(program.blocks(), machine, policy, law); });
}

/// Plans the text of a program: `read_text` and `plan_program`.
template <MachineModel M>
[[nodiscard]] Expected<Trajectory<M, ProgramBlock<M>>, ProgramError> plan_text(
    std::string_view text, const M& machine, const PlanOptions& options = {}) {
  return plan_program(read_text(text, machine, options), machine, options);
}

/// Plans a file, with the files of its folder as subprograms: `read_file` and `plan_program`.
template <MachineModel M>
[[nodiscard]] Expected<Trajectory<M, ProgramBlock<M>>, ProgramError> plan_file(
    const std::string& file, const M& machine, const PlanOptions& options = {}) {
  return plan_program(read_file(file, machine, options), machine, options);
}

}  // namespace cncplan

#ifdef CNCPLAN_COMPILED
#include "cncplan/compiled/plan_program.hpp"
#endif
