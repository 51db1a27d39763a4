// Reads the waveforms of --steps: what a logic analyser would see.
#pragma once

#include <algorithm>
#include <charconv>
#include <cstdint>
#include <filesystem>
#include <functional>
#include <map>
#include <stdexcept>
#include <string>
#include <string_view>
#include <vector>

#include "simulate/run.hpp"

namespace cncplan::test {

/// A rising edge of NAME_step, with NAME_dir as it stands then.
struct VcdEdge {
  std::int64_t time{};
  int direction{};
};

struct VcdAxis {
  std::vector<VcdEdge> edges;
  std::int64_t shortest_high = INT64_MAX;
  std::int64_t longest_high = 0;
  int direction = 1;  ///< as it stands
  bool high = false;  ///< the step signal, as it stands

  [[nodiscard]] std::int64_t net() const {
    std::int64_t sum = 0;
    for (const VcdEdge& edge : edges) sum += edge.direction;
    return sum;
  }
};

class Vcd {
 public:
  std::int64_t nanoseconds_per_unit = 0;

  /// Throws for times that do not grow, unknown signals, and pulses that never end.
  explicit Vcd(const std::filesystem::path& file) {
    const std::string text = text_of(file);
    Words words(text);
    std::string_view token;
    while (words >> token && token != "$enddefinitions") {
      if (token == "$timescale") {
        std::string_view count, unit;
        words >> count >> unit;
        if (unit == "ns") nanoseconds_per_unit = number(count);
      } else if (token == "$var") {
        std::string_view type, width, code, name;
        words >> type >> width >> code >> name;
        const bool is_step = name.ends_with("_step");
        if (type != "wire" || width != "1" || !(is_step || name.ends_with("_dir")))
          throw std::runtime_error("an odd signal: " + std::string(name));
        const std::string axis(name.substr(0, name.find('_')));
        signals_.push_back({code, &axes_[axis], is_step});
      }
    }
    words >> token;  // $end
    std::int64_t time = -1;
    bool dumping = false;
    while (words >> token) {
      if (token == "$dumpvars")
        dumping = true;
      else if (token == "$end")
        dumping = false;
      else if (token[0] == '#')
        time = later(time, number(token.substr(1)));
      else
        change(token.substr(1), token[0] == '1', time, dumping);
    }
    for (const auto& [name, axis] : axes_)
      if (axis.high) throw std::runtime_error("a pulse that does not end");
  }
  Vcd(const Vcd&) = delete;
  Vcd& operator=(const Vcd&) = delete;

  [[nodiscard]] const VcdAxis& axis(const std::string& name) const { return axes_.at(name); }

 private:
  struct Signal {
    std::string_view code;  // within the text, while it is read
    VcdAxis* axis;
    bool is_step{};
  };

  // Words between blanks.
  class Words {
   public:
    explicit Words(std::string_view text) : rest_(text) {}
    Words& operator>>(std::string_view& word) {
      rest_.remove_prefix(std::min(rest_.find_first_not_of(" \n"), rest_.size()));
      good_ = !rest_.empty();
      word = rest_.substr(0, rest_.find_first_of(" \n"));
      rest_.remove_prefix(word.size());
      return *this;
    }
    explicit operator bool() const { return good_; }

   private:
    std::string_view rest_;
    bool good_ = true;
  };

  static std::int64_t number(std::string_view digits) {
    std::int64_t value = 0;
    const auto [end, code] = std::from_chars(digits.data(), digits.data() + digits.size(), value);
    if (code != std::errc{} || end != digits.data() + digits.size())
      throw std::runtime_error("no whole number: " + std::string(digits));
    return value;
  }

  static std::int64_t later(std::int64_t before, std::int64_t time) {
    if (time <= before) throw std::runtime_error("time stands still or goes back");
    return time;
  }

  void change(std::string_view code, bool level, std::int64_t time, bool dumping) {
    const auto signal =
        std::find_if(signals_.begin(), signals_.end(), [&](const Signal& s) { return s.code == code; });
    if (signal == signals_.end()) throw std::runtime_error("an unknown signal: " + std::string(code));
    VcdAxis& axis = *signal->axis;
    if (!signal->is_step) {
      axis.direction = level ? 1 : -1;
      return;
    }
    if (level == axis.high && !dumping) throw std::runtime_error("a change that is none");
    if (level) {
      axis.edges.push_back({time, axis.direction});
    } else if (axis.high) {
      axis.shortest_high = std::min(axis.shortest_high, time - axis.edges.back().time);
      axis.longest_high = std::max(axis.longest_high, time - axis.edges.back().time);
    }
    axis.high = level;
  }

  std::vector<Signal> signals_;
  std::map<std::string, VcdAxis, std::less<>> axes_;
};

}  // namespace cncplan::test
