#include "events.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <limits>
#include <string_view>

#include "support/failure.hpp"

namespace simulate {

using support::Exit;
using support::Failure;

namespace {

// What may stand in a row's last field.
enum class Value { none, share, number };

struct Kind {
  std::string_view name;
  Request request;
  Value value;
  double most;
};

constexpr std::array<Kind, 7> kinds{{{"hold", Request::hold, Value::none, 0.0},
                                     {"resume", Request::resume, Value::none, 0.0},
                                     {"feed", Request::feed, Value::share, 2.0},
                                     {"rapid", Request::rapid, Value::share, 1.0},
                                     {"stop", Request::stop, Value::none, 0.0},
                                     {"step", Request::step, Value::number, 1.0},
                                     {"pause", Request::pause, Value::number, 1e9}}};

constexpr std::string_view header = "t,event,value";

// One row, field by field.
class Row {
 public:
  Row(const std::string& file, int line, std::string_view text) : file_(file), line_(line), text_(text) {}

  [[nodiscard]] Event event(double not_before) {
    Event event;
    const Field time = next("time");
    event.time = number(time, "time");
    if (!(event.time >= 0.0)) refuse(time, "a time below 0");
    if (event.time < not_before) refuse(time, "a time before that of the row above");
    const Field name = next("event");
    const auto* const kind =
        std::find_if(kinds.begin(), kinds.end(), [&](const Kind& k) { return k.name == name.text; });
    if (kind == kinds.end()) refuse(name, fmt::format("'{}' is no event", name.text));
    event.request = kind->request;
    const Field value = done_ ? Field{text_.size() + 1, {}} : next("value");
    event.row = line_;
    event.column = static_cast<int>(value.column);
    if (!done_) refuse({value.column + value.text.size(), {}}, "more than three fields");
    if (kind->value == Value::none) {
      if (!value.text.empty()) refuse(value, fmt::format("{} takes no value", kind->name));
    } else {
      event.value = kind->value == Value::share ? share(value) : whole(value);
      if (!(event.value >= 0.0 && event.value <= kind->most))
        refuse(value, fmt::format("{} takes 0 to {}", kind->name, kind->most));
    }
    return event;
  }

 private:
  struct Field {
    std::size_t column;  ///< from 1
    std::string_view text;
  };

  [[noreturn]] void refuse(const Field& where, const std::string& why) const {
    throw Failure(Exit::bad_input, fmt::format("{}:{}:{}: error: {}", file_, line_, where.column, why));
  }

  [[nodiscard]] Field next(std::string_view what) {
    if (done_) refuse({text_.size() + 1, {}}, fmt::format("no {}", what));
    const std::size_t comma = std::min(text_.find(',', at_), text_.size());
    Field field{at_ + 1, text_.substr(at_, comma - at_)};
    while (field.text.starts_with(' ')) field.text.remove_prefix(1), ++field.column;
    while (field.text.ends_with(' ')) field.text.remove_suffix(1);
    done_ = comma == text_.size();
    at_ = comma + 1;
    return field;
  }

  [[nodiscard]] double number(const Field& field, std::string_view what) const {
    double value = 0.0;
    const char* const end = field.text.data() + field.text.size();
    const auto [stop, code] = std::from_chars(field.text.data(), end, value);
    if (code != std::errc{} || stop != end || !(std::abs(value) <= std::numeric_limits<double>::max()))
      refuse(field, fmt::format("'{}' is no {}", field.text, what));
    return value;
  }

  // 0.8 or 80%.
  [[nodiscard]] double share(Field field) const {
    const bool percent = field.text.ends_with('%');
    if (percent) field.text.remove_suffix(1);
    return number(field, "share") / (percent ? 100.0 : 1.0);
  }

  [[nodiscard]] double whole(const Field& field) const {
    const double value = number(field, "whole number");
    if (value != std::floor(value)) refuse(field, fmt::format("'{}' is no whole number", field.text));
    return value;
  }

  const std::string& file_;
  int line_;
  std::string_view text_;
  std::size_t at_ = 0;
  bool done_ = false;
};

}  // namespace

std::vector<Event> read_events(const std::string& file) {
  const Failure unreadable(Exit::bad_input, fmt::format("{}: cannot be read", file));
  std::ifstream stream(file, std::ios::binary);
  if (!stream || std::filesystem::is_directory(file)) throw unreadable;
  std::vector<Event> events;
  std::string line;
  for (int number = 1; std::getline(stream, line); ++number) {
    if (number == 1 && line.starts_with("\xEF\xBB\xBF")) line.erase(0, 3);  // byte order mark
    if (line.ends_with('\r')) line.pop_back();
    if (line.empty() || (number == 1 && line == header)) continue;
    events.push_back(Row(file, number, line).event(events.empty() ? 0.0 : events.back().time));
  }
  if (stream.bad()) throw unreadable;
  return events;
}

std::string event_text(const Event& event) {
  const auto* const kind =
      std::find_if(kinds.begin(), kinds.end(), [&](const Kind& k) { return k.request == event.request; });
  return kind->value == Value::none ? std::string(kind->name)
                                    : fmt::format("{} {:.6g}", kind->name, event.value);
}

void refuse_periods(double period) {
  throw support::Failure(support::Exit::bad_input,
                         fmt::format("with its events the program takes more than {:.0e} periods of {:.6g} s",
                                     most_periods, period));
}

double highest_feed(const std::vector<Event>& events) {
  double highest = 1.0;
  for (const Event& event : events)
    if (event.request == Request::feed) highest = std::max(highest, event.value);
  return highest;
}

}  // namespace simulate
