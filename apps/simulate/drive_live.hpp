// A program driven live at the levels good and best, with requests on the way.
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <memory>
#include <memory_resource>
#include <span>
#include <vector>

#include "ask.hpp"
#include "cncplan/executor_levels.hpp"
#include "events.hpp"
#include "live_record.hpp"

namespace simulate {

namespace detail {

/// s, in which all that is planned is dwelled, or driven at the clock's rate if that is constant.
template <class M, class B>
[[nodiscard]] double least_time_left(const cncplan::detail::LiveDriver<M, B>& driver) {
  if (driver.dwells()) return driver.until_change();
  const cncplan::State clock = driver.clock();
  const bool constant = clock.velocity > 0.0 && clock.acceleration == 0.0 && clock.jerk == 0.0;
  return constant ? (driver.chain().end_time() - clock.position) / clock.velocity : 0.0;
}

}  // namespace detail

/// Runs blocks with a tick each `period` (s, > 0) as an executor does that holds 300 of them: nothing is
/// known of the events before they come, which is at their exact times. It ends where the program does, where
/// it is stopped, or where it rests and nothing is to come. Errors: those of a block that cannot be planned.
/// Throws `Failure` for what does not end.
template <class M, class B>
[[nodiscard]] cncplan::Expected<cncplan::Trajectory<M, B>, cncplan::ProgramError> drive_live(
    std::span<const B> blocks, const M& machine, const cncplan::PlanOptions& options,
    const std::vector<Event>& events, double period) {
  using Driver = cncplan::detail::LiveDriver<M, B>;
  constexpr double infinity = std::numeric_limits<double>::infinity();
  constexpr std::size_t held_blocks = 300;
  constexpr int most_search = 1000;  // ticks in which a change of the rate is looked for
  const auto destroy = [](Driver* driver) { driver->destroy(); };
  const std::unique_ptr<Driver, decltype(destroy)> driver(
      Driver::make(machine, {}, std::pmr::get_default_resource(), options, held_blocks,
                   cncplan::LevelExecutorOptions{}.horizon),
      destroy);
  driver->program_stop(false);
  if (blocks.empty()) driver->end_of_program();
  LiveRecord<M, B> record(blocks);
  typename Driver::Point point;
  double time = 0.0, end = 0.0;
  std::int64_t ticks = 1;  // the next one ends at so many periods
  int idle_ticks = 0;
  std::size_t fed = 0, again = 0;
  for (auto event = events.begin();;) {
    for (; event != events.end() && event->time <= time; ++event) ask(*driver, *event);
    while (fed < blocks.size() && driver->push(blocks[fed]))
      if (++fed == blocks.size()) driver->end_of_program();
    driver->look(0.0);
    if (driver->failed()) return tl::unexpected(cncplan::ProgramError{driver->fault()});
    if ((driver->complete() && driver->finished()) || driver->stopped()) break;
    const double next_event = event != events.end() ? event->time : infinity;
    if (std::min(time + detail::least_time_left(*driver), next_event) > most_periods * period)
      refuse_periods(period);
    while (!(static_cast<double>(ticks) * period > time)) ++ticks;
    const double next = std::min(static_cast<double>(ticks) * period, next_event);
    driver->advance(0.0, point);  // many blocks in a row that neither move nor dwell take no time
    if (driver->rests() && !driver->asked_to_rest() && ++again <= blocks.size()) continue;
    again = 0;
    driver->advance(next - time, point);
    record.add(*driver, time);
    if (driver->dwelled_until() > 0.0) end = time + driver->dwelled_until();
    const bool idle = driver->driven().empty() && !driver->dwells();
    idle_ticks = idle ? idle_ticks + 1 : 0;
    if (idle && (driver->asked_to_rest() || idle_ticks > most_search)) {  // nothing is ticked then
      if (event == events.end()) break;
      time = next_event;
      ticks = static_cast<std::int64_t>(next_event / period);
      continue;
    }
    time = next;
  }
  return record.finish(machine, end);
}

}  // namespace simulate
