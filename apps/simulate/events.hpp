// What is asked of the machine while a program runs: the rows of an events file.
#pragma once

#include <string>
#include <vector>

namespace simulate {

enum class Request { hold, resume, feed, rapid, stop, step, pause };

struct Event {
  double time{};  ///< s from the start of the program
  Request request{};
  double value{};       ///< a share of feed or rapid rate, on or off (1 or 0), a line; 0 where there is none
  int row{}, column{};  ///< of the file, where the value stands
};

/// Reads a CSV file of `t,event,value`, in order of time. Throws `Failure` for one that cannot be read or has
/// a wrong row.
[[nodiscard]] std::vector<Event> read_events(const std::string& file);

/// The largest share of the feed that is asked for, 1 at least.
[[nodiscard]] double highest_feed(const std::vector<Event>& events);

/// Periods after which a run is given up.
inline constexpr double most_periods = 1e10;
/// Throws the `Failure` that says so.
[[noreturn]] void refuse_periods(double period);

/// As its row has it: the event and its value.
[[nodiscard]] std::string event_text(const Event& event);

}  // namespace simulate
