// SPDX-License-Identifier: GPL-2.0-or-later
#include "settings.hpp"

#include <cctype>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <limits>
#include <memory>
#include <numbers>
#include <optional>
#include <string>
#include <string_view>

namespace cncplan::linuxcnc {
namespace {

constexpr double inch = 25.4;
constexpr double degree = std::numbers::pi / 180.0;

struct Unit {
  const char* name;
  double size;
};
// The names that LinuxCNC's task knows.
constexpr Unit linear_units[] = {
    {"mm", 1.0}, {"metric", 1.0}, {"in", inch}, {"inch", inch}, {"imperial", inch}};
constexpr Unit rotary_units[] = {{"deg", degree}, {"degree", degree},     {"rad", 1.0},
                                 {"radian", 1.0}, {"grad", 0.9 * degree}, {"gon", 0.9 * degree}};

template <class... Values>
void complain(const char* format, Values... values) {
  rtapi_print_msg(RTAPI_MSG_ERR, format, values...);
}

// LinuxCNC 2.10 takes the file's name, 2.9 an open file.
class Ini {
 public:
  explicit Ini(const char* name) : name_(name), file_(std::fopen(name, "r")) {}
  [[nodiscard]] bool is_open() const { return file_ != nullptr; }

  [[nodiscard]] std::optional<std::string> text(const char* section, const char* entry) const {
#ifdef CNCPLAN_TP_JERK
    char found[1024];
    if (iniFindString(name_, entry, section, found, sizeof found) != 0) return std::nullopt;
    return found;
#else
    const char* const found = iniFind(file_.get(), entry, section);
    return found != nullptr ? std::optional<std::string>(found) : std::nullopt;
#endif
  }

 private:
  struct Close {
    void operator()(std::FILE* file) const { std::fclose(file); }
  };
  [[maybe_unused]] const char* name_;
  std::unique_ptr<std::FILE, Close> file_;
};

template <std::size_t count>
std::optional<double> unit(const std::optional<std::string>& name, const Unit (&units)[count]) {
  if (!name) return units[0].size;
  for (const Unit& one : units)
    if (strcasecmp(name->c_str(), one.name) == 0) return one.size;
  return std::nullopt;
}

// A number above 0, or one that is not to be had.
std::optional<double> positive(const char* what, const std::string& text) {
  char* end = nullptr;
  const double number = std::strtod(text.c_str(), &end);
  while (end != nullptr && std::isspace(static_cast<unsigned char>(*end)) != 0) ++end;
  if (end != text.c_str() && *end == '\0' && std::isfinite(number) && number > 0.0) return number;
  complain("cncplan_tp: error: %s: '%s' is no number above 0\n", what, text.c_str());
  return std::nullopt;
}

// What may be missing, and is `otherwise` then.
std::optional<double> positive_or(const char* what, const std::optional<std::string>& text,
                                  double otherwise) {
  return text ? positive(what, *text) : otherwise;
}
std::optional<std::string> given(const char* parameter) {
  return parameter != nullptr && *parameter != '\0' ? std::optional<std::string>(parameter) : std::nullopt;
}

bool read_coordinates(const Ini& ini, Settings& settings) {
  const std::string text = ini.text("TRAJ", "COORDINATES").value_or("XYZ");
  for (const char letter : text) {
    if (std::isspace(static_cast<unsigned char>(letter)) != 0) continue;
    const char* const at = std::strchr(coordinate_letters, std::toupper(static_cast<unsigned char>(letter)));
    if (at == nullptr) {
      complain("cncplan_tp: error: [TRAJ]COORDINATES: '%s' names no axis\n", text.c_str());
      return false;
    }
    settings.used[static_cast<std::size_t>(at - coordinate_letters)] = true;
  }
  return true;
}

bool read_jerks(const Ini& ini, const Parameters& parameters, Settings& settings) {
  for (int i = 0; i < coordinate_count; ++i) {
    const auto slot = static_cast<std::size_t>(i);
    settings.jerk[slot] = std::numeric_limits<double>::infinity();
    if (!settings.used[slot]) continue;
    const std::string section = std::string("AXIS_") + coordinate_letters[i];
    const std::string what = '[' + section + "]MAX_JERK";
    const char* const name = is_rotary(i) ? "rotary_jerk" : "jerk";
    const auto of_axis = ini.text(section.c_str(), "MAX_JERK");
    const auto of_all = given(is_rotary(i) ? parameters.rotary_jerk : parameters.jerk);
    if (!of_axis && !of_all) {
      complain("cncplan_tp: error: axis %c has no jerk limit: set %s, or say TPMOD = cncplan_tp %s=...\n",
               coordinate_letters[i], what.c_str(), name);
      return false;
    }
    const auto jerk = of_axis ? positive(what.c_str(), *of_axis) : positive(name, *of_all);
    if (!jerk) return false;
    settings.jerk[slot] = *jerk * settings.units.of(i);
  }
  return true;
}

bool read_level(const Parameters& parameters, Settings& settings) {
  const std::string level = given(parameters.level).value_or("fast");
  if (level != "fast" && level != "good") {
    complain("cncplan_tp: error: level: '%s' is neither fast nor good\n", level.c_str());
    return false;
  }
  settings.level = level == "good" ? Level::good : Level::fast;
  if (settings.level == Level::fast || planned_coordinates(settings) <= 6) return true;
  complain("cncplan_tp: error: level: good is for X Y Z A B C; [TRAJ]COORDINATES has others\n");
  return false;
}

}  // namespace

bool read_settings(const Parameters& parameters, Settings& settings) {
  settings = {};
  const char* const name = std::getenv("INI_FILE_NAME");
  const Ini ini(name != nullptr ? name : "");
  if (!ini.is_open()) {
    complain("cncplan_tp: error: the ini cannot be read (INI_FILE_NAME: %s)\n",
             name != nullptr ? name : "not set");
    return false;
  }
  const auto linear = unit(ini.text("TRAJ", "LINEAR_UNITS"), linear_units);
  const auto rotary = unit(ini.text("TRAJ", "ANGULAR_UNITS"), rotary_units);
  if (!linear || !rotary) {
    complain("cncplan_tp: error: [TRAJ]%s is no unit\n", linear ? "ANGULAR_UNITS" : "LINEAR_UNITS");
    return false;
  }
  settings.units = {*linear, *rotary};
  if (!read_coordinates(ini, settings) || !read_jerks(ini, parameters, settings) ||
      !read_level(parameters, settings))
    return false;

  constexpr double none = std::numeric_limits<double>::infinity();
  const auto velocity =
      positive_or("[TRAJ]MAX_LINEAR_VELOCITY", ini.text("TRAJ", "MAX_LINEAR_VELOCITY"), none);
  const auto jerk = positive_or("[TRAJ]MAX_LINEAR_JERK", ini.text("TRAJ", "MAX_LINEAR_JERK"), none);
  const auto tolerance = positive_or("tolerance", given(parameters.tolerance), settings.tolerance / *linear);
  const auto rotary_tolerance = positive_or("rotary_tolerance", given(parameters.rotary_tolerance),
                                            settings.rotary_tolerance / *rotary);
  if (!velocity || !jerk || !tolerance || !rotary_tolerance) return false;
  settings.tool_velocity = *velocity * *linear;
  settings.tool_jerk = *jerk * *linear;
  settings.tolerance = *tolerance * *linear;
  settings.rotary_tolerance = *rotary_tolerance * *rotary;
  return true;
}

int planned_coordinates(const Settings& settings) {
  int most = 3;
  for (int i = 3; i < coordinate_count; ++i)
    if (settings.used[static_cast<std::size_t>(i)]) most = i < 6 ? 6 : 9;
  return most;
}

}  // namespace cncplan::linuxcnc
