#include "cncplan_tools/machine_file.hpp"

#include <fmt/format.h>
#include <toml++/toml.h>

#include <charconv>
#include <cmath>
#include <filesystem>
#include <stdexcept>
#include <string>
#include <string_view>
#include <system_error>

#include "cncplan/gcode/controls.hpp"
#include "cncplan/gcode/work_coordinates.hpp"

namespace cncplan::tools {

namespace {

// What a file has to say differently: it ends the reading of it, inside this file only.
struct Wrong : std::runtime_error {
  using std::runtime_error::runtime_error;
};

// A table of the file, with the means to complain about what is in it.
class Section {
 public:
  Section(const std::string& file, const toml::table& table, std::string name)
      : file_(file), table_(table), name_(std::move(name)) {}

  [[noreturn]] void refuse(const toml::node& node, const std::string& why) const {
    const auto at = node.source().begin;
    throw Wrong(fmt::format("{}:{}:{}: error: {}", file_, at.line, at.column, why));
  }

  void allow(const std::vector<std::string_view>& keys) const {
    for (const auto& [key, node] : table_)
      if (std::find(keys.begin(), keys.end(), key.str()) == keys.end()) {
        const auto at = key.source().begin;
        throw Wrong(fmt::format("{}:{}:{}: error: unknown key '{}'{}", file_, at.line, at.column, key.str(),
                                name_.empty() ? "" : " in " + name_));
      }
  }

  [[nodiscard]] const toml::node* find(std::string_view key) const { return table_.get(key); }

  [[nodiscard]] double number(const toml::node& node, std::string_view what) const {
    const auto value = node.value<double>();
    if (!value || !std::isfinite(*value) || !node.is_number())
      refuse(node, fmt::format("{} must be a number", what));
    return *value;
  }
  void positive(std::string_view key, double& into, double unit = 1.0) const {
    if (const toml::node* node = find(key)) {
      const double value = number(*node, key);
      if (value <= 0.0) refuse(*node, fmt::format("{} must be greater than zero", key));
      into = value * unit;
    }
  }
  void not_negative(std::string_view key, double& into, double unit = 1.0) const {
    if (const toml::node* node = find(key)) {
      const double value = number(*node, key);
      if (value < 0.0) refuse(*node, fmt::format("{} must not be negative", key));
      into = value * unit;
    }
  }
  [[nodiscard]] std::vector<double> numbers(const toml::node& node, std::string_view what,
                                            std::size_t count) const {
    const toml::array* array = node.as_array();
    if (array == nullptr || array->size() != count)
      refuse(node, fmt::format("{} must be a list of {} numbers", what, count));
    std::vector<double> values;
    for (const toml::node& item : *array) values.push_back(number(item, what));
    return values;
  }
  [[nodiscard]] std::string text(const toml::node& node, std::string_view what) const {
    const auto value = node.value<std::string>();
    if (!value) refuse(node, fmt::format("{} must be a text", what));
    return *value;
  }
  [[nodiscard]] bool flag(const toml::node& node, std::string_view what) const {
    if (!node.is_boolean()) refuse(node, fmt::format("{} must be true or false", what));
    return **node.as_boolean();
  }
  [[nodiscard]] Section section(std::string_view key, const toml::node& node) const {
    if (!node.is_table()) refuse(node, fmt::format("{} must be a table", key));
    return part(key, *node.as_table());
  }
  [[nodiscard]] Section part(std::string_view key, const toml::table& table) const {
    return {file_, table, std::string(key)};
  }
  [[nodiscard]] const std::string& file() const { return file_; }
  [[nodiscard]] const toml::table& table() const { return table_; }

 private:
  const std::string& file_;
  const toml::table& table_;
  std::string name_;
};

constexpr double radians(double degrees) { return degrees * gcode::radians_per_degree; }

void read_drive(const Section& section, double unit, step::Drive& drive) {
  if (const toml::node* node = section.find("steps_per_unit")) {
    const double steps = section.number(*node, "steps_per_unit");
    if (steps == 0.0) section.refuse(*node, "steps_per_unit must not be zero");
    drive.steps_per_unit = std::abs(steps) / unit;
    drive.inverted = steps < 0.0;
  }
  if (const toml::node* node = section.find("inverted")) {
    if (drive.inverted) section.refuse(*node, "inverted and a negative steps_per_unit say the same");
    drive.inverted = section.flag(*node, "inverted");
  }
  section.positive("max_step_rate", drive.max_rate);
  section.positive("pulse_width", drive.high_time);
  section.not_negative("pulse_gap", drive.low_time);
  section.not_negative("direction_setup", drive.direction_setup);
  section.not_negative("direction_hold", drive.direction_hold);
  section.not_negative("backlash", drive.backlash, unit);
}

// Behind the axis' limits and its first drive.
void read_second_motor(const Section& section, double unit, MachineAxis& axis) {
  constexpr double most_steps = 1e6;
  section.allow({"inverted", "offset"});
  SecondMotor& motor = axis.second.emplace(SecondMotor{.inverted = axis.drive.inverted});
  if (const toml::node* node = section.find("inverted")) motor.inverted = section.flag(*node, "inverted");
  if (const toml::node* node = section.find("offset")) {
    motor.offset = section.number(*node, "offset") * unit;
    const auto& limits = axis.limits;
    if (!std::isfinite(limits.velocity + limits.acceleration + limits.jerk))
      section.refuse(*node, "an axis with an offset needs velocity, acceleration and jerk");
    if (!(std::abs(motor.offset) * axis.drive.steps_per_unit <= most_steps))
      section.refuse(*node, fmt::format("offset must not be more than {:.0f} steps", most_steps));
  }
}

void read_axis(const Section& section, MachineFile& machine) {
  section.allow({"letter", "kind", "travel", "velocity", "acceleration", "jerk", "steps_per_unit", "inverted",
                 "max_step_rate", "pulse_width", "pulse_gap", "direction_setup", "direction_hold", "backlash",
                 "second_motor"});
  MachineAxis axis;
  gcode::Axis word{};
  const toml::node* letter = section.find("letter");
  if (letter == nullptr) section.refuse(section.table(), "an axis needs a letter");
  const std::string name = section.text(*letter, "letter");
  if (name.size() != 1) section.refuse(*letter, "letter must be one letter");
  axis.letter = word.letter = name[0];
  if (const toml::node* kind = section.find("kind")) {
    const std::string value = section.text(*kind, "kind");
    if (value != "linear" && value != "rotary")
      section.refuse(*kind, "kind must be \"linear\" or \"rotary\"");
    axis.rotary = value == "rotary";
    word.kind = axis.rotary ? gcode::AxisKind::rotary : gcode::AxisKind::linear;
  }
  const double unit = axis.rotary ? 1.0 : machine.unit;
  section.positive("velocity", axis.limits.velocity, unit);
  section.positive("acceleration", axis.limits.acceleration, unit);
  section.positive("jerk", axis.limits.jerk, unit);
  if (const toml::node* travel = section.find("travel")) {
    const auto range = section.numbers(*travel, "travel", 2);
    if (!(range[0] < range[1])) section.refuse(*travel, "travel must go from the lower to the higher end");
    axis.low = range[0] * unit;
    axis.high = range[1] * unit;
  }
  read_drive(section, unit, axis.drive);
  axis.limits.velocity = std::min(axis.limits.velocity, step::max_speed(axis.drive));
  if (const toml::node* node = section.find("second_motor"))
    read_second_motor(section.section("second_motor", *node), unit, axis);
  machine.axes.push_back(axis);
  machine.dialect.axes.push_back(word);
}

gcode::Position position(const Section& section, const toml::node& node, std::string_view what,
                         const MachineFile& machine) {
  const auto values = section.numbers(node, what, machine.dialect.axes.size());
  gcode::Position result{};
  for (std::size_t i = 0; i < values.size(); ++i)
    result[i] = machine.dialect.axes[i].kind == gcode::AxisKind::rotary ? radians(values[i])
                                                                        : values[i] * machine.unit;
  return result;
}

void read_tools(const Section& section, MachineFile& machine) {
  for (const auto& [key, node] : section.table()) {
    int number = 0;
    const std::string_view digits = key.str();
    const auto [end, code] = std::from_chars(digits.data(), digits.data() + digits.size(), number);
    if (code != std::errc{} || end != digits.data() + digits.size() || number < 0)
      section.refuse(node, fmt::format("'{}' is not a tool number", digits));
    for (const gcode::Tool& tool : machine.dialect.tools)
      if (tool.number == number) section.refuse(node, fmt::format("tool {} is there twice", number));
    gcode::Tool tool{.number = number};
    if (node.is_table()) {
      const Section of_tool = section.section(digits, node);
      std::vector<std::string_view> keys{"length", "diameter"};
      const auto& axes = machine.dialect.axes;
      for (const gcode::Axis& axis : axes)
        if (axis.letter != 'Z') keys.push_back(gcode::name(axis.letter));
      of_tool.allow(keys);
      for (std::size_t i = 0; i < axes.size(); ++i) {
        const toml::node* beside =
            axes[i].letter == 'Z' ? nullptr : of_tool.find(gcode::name(axes[i].letter));
        if (beside != nullptr)
          tool.beside[i] =
              of_tool.number(*beside, "tool offset") *
              (axes[i].kind == gcode::AxisKind::rotary ? gcode::radians_per_degree : machine.unit);
      }
      if (const toml::node* length = of_tool.find("length"))
        tool.length = of_tool.number(*length, "tool length") * machine.unit;
      if (const toml::node* diameter = of_tool.find("diameter"))
        tool.diameter = of_tool.number(*diameter, "tool diameter") * machine.unit;
    } else {
      tool.length = section.number(node, "tool length") * machine.unit;
    }
    machine.dialect.tools.push_back(tool);
  }
}

void read_offsets(const Section& section, MachineFile& machine) {
  constexpr std::array<std::string_view, gcode::work_systems> names{"G54", "G55",   "G56",   "G57",  "G58",
                                                                    "G59", "G59.1", "G59.2", "G59.3"};
  for (const auto& [key, node] : section.table()) {
    const auto it = std::find(names.begin(), names.end(), key.str());
    if (it == names.end())
      section.refuse(node, fmt::format("'{}' is not a work coordinate system", key.str()));
    machine.dialect.work_offsets[static_cast<std::size_t>(it - names.begin())] =
        position(section, node, *it, machine);
  }
}

void read_pass_through(const Section& section, const toml::node& node, MachineFile& machine) {
  const toml::array* words = node.as_array();
  if (words == nullptr) section.refuse(node, "pass_through must be a list of words");
  for (const toml::node& item : *words) {
    const std::string word = section.text(item, "a word to pass through");
    gcode::PassThrough passed{};
    if (word.empty() || word[0] < 'A' || word[0] > 'Z')
      section.refuse(item, "a word begins with a letter A to Z");
    passed.letter = word[0];
    if (word.size() > 1) {
      double value = 0.0;
      const auto [end, code] =
          std::from_chars(word.data() + 1, word.data() + word.size(), value, std::chars_format::fixed);
      std::string_view owned(end, static_cast<std::size_t>(word.data() + word.size() - end));
      const bool owns = passed.letter == 'M' && owned.starts_with(' ');
      if (owns) owned.remove_prefix(1);
      const bool letters = owned.find_first_not_of("ABCDEFHIJKLPQRSTUVWXYZ") == std::string_view::npos;
      if (code != std::errc{} || !(owns ? letters : owned.empty()))
        section.refuse(item, "'" + word + "' is not a word");
      passed.number = value;
      if (owns) passed.words = gcode::bits(owned);
    }
    const bool moves = std::any_of(machine.dialect.axes.begin(), machine.dialect.axes.end(),
                                   [&](const gcode::Axis& axis) { return axis.letter == passed.letter; });
    if (moves || passed.letter == 'F' || gcode::takes_axis_words(passed))
      section.refuse(item, fmt::format("{} {}", word, message(ErrorCode::not_to_pass)));
    machine.dialect.pass_through.push_back(passed);
  }
}

// "one", "two" or "three".
std::string alternatives(const std::vector<std::string_view>& names) {
  std::string text;
  for (std::size_t i = 0; i < names.size(); ++i)
    text += fmt::format("{}\"{}\"", i == 0 ? "" : i + 1 < names.size() ? ", " : " or ", names[i]);
  return text;
}

// The numbers that a ready-made machine is made with, mm and rad, in the order of its parameters.
std::vector<double> read_lengths(const Section& lengths, const kinematics::ReadyMade& made, double unit) {
  using Kind = kinematics::ParameterKind;
  std::vector<std::string_view> names;
  for (const auto& parameter : made.parameters) names.push_back(parameter.name);
  lengths.allow(names);
  std::vector<double> numbers;
  for (const auto& [name, kind] : made.parameters) {
    const toml::node* const node = lengths.find(name);
    if (node == nullptr)
      numbers.insert(numbers.end(), kinematics::size_of(kind), 0.0);
    else if (kind == Kind::place)
      for (const double number : lengths.numbers(*node, name, 3)) numbers.push_back(number * unit);
    else if (kind == Kind::flag)
      numbers.push_back(lengths.flag(*node, name) ? 1.0 : 0.0);
    else
      numbers.push_back(lengths.number(*node, name) * (kind == Kind::lean ? radians(1.0) : unit));
  }
  return numbers;
}

// The ready-made machine that a file names.
kinematics::ReadyMadeMap read_ready_made(const Section& top, const toml::node& node,
                                         const kinematics::ReadyMade& made, double unit) {
  const toml::table none;
  const toml::node* const found = top.find("lengths");
  const bool needs = std::any_of(made.parameters.begin(), made.parameters.end(), [](const auto& parameter) {
    return kinematics::is_required(parameter.kind);
  });
  if (found == nullptr && needs)
    top.refuse(node, fmt::format("{} needs a table of lengths: [lengths]", made.name));
  const Section lengths = found == nullptr ? top.part("lengths", none) : top.section("lengths", *found);
  for (const auto& [name, kind] : made.parameters)
    if (kinematics::is_required(kind) && lengths.find(name) == nullptr)
      top.refuse(*found, fmt::format("{} of {} is missing", name, made.name));
  const auto map = kinematics::make(made, read_lengths(lengths, made, unit));
  if (map) return *map;
  const Error& error = map.error();
  const toml::node& culprit = *lengths.find(error.field);
  switch (error.code) {
    case ErrorCode::above_limit:
      lengths.refuse(culprit, fmt::format("{} must be 90 at most", error.field));
    case ErrorCode::below_limit:
      lengths.refuse(culprit, fmt::format("{} must be more than {:.6g}", error.field, error.bound / unit));
    default:
      lengths.refuse(culprit, fmt::format("{} {}", error.field, message(error.code)));
  }
}

// Where the joints of a machine behind a map stand at the start: at 0, or where the file says.
void read_start(const Section& top, const toml::node& kinematics, MachineFile& machine) {
  std::vector<double>& start = machine.map.start;
  start.assign(machine.axes.size(), 0.0);
  const toml::node* const node = top.find("start");
  if (node != nullptr) {
    const auto numbers = top.numbers(*node, "start", start.size());
    for (std::size_t i = 0; i < start.size(); ++i)
      start[i] = numbers[i] * (machine.axes[i].rotary ? radians(1.0) : machine.unit);
  }
  const bool stands = std::visit(
      [&](const auto& map) {
        std::array<double, std::remove_cvref_t<decltype(map)>::axis_count> joints{};
        std::copy(start.begin(), start.end(), joints.begin());
        const auto there = map.joints(map.point(joints));
        for (std::size_t i = 0; i < joints.size(); ++i) {
          const double off = machine.axes[i].rotary ? std::remainder(there[i] - joints[i], radians(360.0))
                                                    : there[i] - joints[i];
          if (!(std::abs(off) <= 1e-6)) return false;
        }
        return true;
      },
      machine.map.map);
  if (stands) return;
  if (node != nullptr) top.refuse(*node, fmt::format("{} cannot stand at this start", machine.map.name));
  top.refuse(kinematics, fmt::format("{} cannot stand where all joints are 0: start must say where they are",
                                     machine.map.name));
}

void read_orientation(const Section& top, const kinematics::ReadyMade& made, MachineFile& machine) {
  const toml::node* const node = top.find("orientation");
  if (node == nullptr) return;
  if (!machine.map.has_tool_point_control())
    top.refuse(*node, fmt::format("orientation is for five-axis machines, {} is none", made.name));
  const std::string way = top.text(*node, "orientation");
  if (way != "joints" && way != "great-circle")
    top.refuse(*node, "orientation must be joints or great-circle");
  if (way == "great-circle") machine.map.orientation = Orientation::great_circle;
}

// A machine whose file names its kinematics.
void read_map(const Section& top, const toml::node& node, MachineFile& machine) {
  const std::string name = top.text(node, "kinematics");
  const kinematics::ReadyMade* const made = kinematics::find_ready_made(name);
  if (made == nullptr) {
    std::vector<std::string_view> names;
    for (const kinematics::ReadyMade& each : kinematics::ready_made) names.push_back(each.name);
    top.refuse(node, "kinematics must be " + alternatives(names));
  }
  std::string letters, kinds;
  for (const MachineAxis& axis : machine.axes) {
    if (letters.find(axis.letter) != std::string::npos) top.refuse(node, "an axis is there twice");
    letters += axis.letter;
    kinds += axis.rotary ? 'R' : 'L';
  }
  if (made->named_axes && letters != made->coordinates)
    top.refuse(node, fmt::format("the axes of {} must be {}, in this order", name, made->coordinates));
  if (kinds != made->axes) {
    std::string wanted;
    for (const char kind : made->axes)
      wanted += fmt::format("{}{}", wanted.empty() ? "" : ", ", kind == 'R' ? "rotary" : "linear");
    top.refuse(node, fmt::format("the axes of {} must be {}", name, wanted));
  }
  machine.kinematics = Kinematics::mapped;
  machine.map.name = name;
  machine.map.map = read_ready_made(top, node, *made, machine.unit);
  machine.dialect.axes.clear();
  for (const char letter : made->coordinates)
    machine.dialect.axes.push_back(
        {letter, letter < 'X' ? gcode::AxisKind::rotary : gcode::AxisKind::linear});
  read_orientation(top, *made, machine);
  read_start(top, node, machine);
}

// Which machine its axes make, and what its programs name.
void settle_kinematics(const Section& top, MachineFile& machine) {
  if (const toml::node* node = top.find("kinematics")) {
    if (const toml::node* center = top.find("table_center"))
      top.refuse(*center, "table_center is for machines of two slides and a rotary table");
    if (machine.smallest_radius) top.refuse(*node, "smallest_radius is for machines with a rotary table");
    return read_map(top, *node, machine);
  }
  if (const toml::node* lengths = top.find("lengths"))
    top.refuse(*lengths, "lengths are those of the machine that kinematics names");
  if (const toml::node* start = top.find("start"))
    top.refuse(*start, "start is where the joints of the machine are that kinematics names");
  if (const toml::node* orientation = top.find("orientation"))
    top.refuse(*orientation, "orientation is that of the five-axis machine that kinematics names");
  const auto refuse = [&](const char* why) {
    throw Wrong(fmt::format("{}:1:1: error: {}", top.file(), why));
  };
  std::string letters, kinds;
  for (const MachineAxis& axis : machine.axes) {
    if (letters.find(axis.letter) != std::string::npos) refuse("an axis is there twice");
    letters += axis.letter;
    kinds += axis.rotary ? 'R' : 'L';
  }
  const bool mill = letters == "XY" || (letters.starts_with("XYZ") && letters.size() <= gcode::max_axes &&
                                        letters.find_first_not_of("ABCUVW", 3) == std::string::npos);
  if (mill && kinds.substr(0, 3).find('R') == std::string::npos) {
    machine.kinematics = Kinematics::cartesian;
  } else if (kinds == "LLRR") {
    machine.kinematics = Kinematics::tire_mold;
  } else if (kinds == "LLR") {
    machine.kinematics = Kinematics::polar;
    machine.dialect.axes = gcode::Dialect{}.axes;
  } else {
    refuse(
        "the axes must be X, Y, Z, in this order, and up to three of A, B, C, U, V, W behind them, or X, Y; "
        "or "
        "two slides, maybe a tilting axis, and a rotary table");
  }
  if (machine.smallest_radius && machine.kinematics == Kinematics::cartesian)
    refuse("smallest_radius is for machines with a rotary table");
  if (const toml::node* node = top.find("table_center")) {
    if (machine.kinematics != Kinematics::polar)
      top.refuse(*node, "table_center is for machines of two slides and a rotary table");
    const auto place = top.numbers(*node, "table_center", 2);
    machine.table_center = {place[0] * machine.unit, place[1] * machine.unit};
  }
}

MachineFile interpret(const std::string& file, const toml::table& root) {
  const Section top(file, root, "");
  top.allow({"name", "dialect", "g18", "unit", "rapid_rate", "feed_limit", "axis", "tools", "offsets", "home",
             "pass_through", "smallest_radius", "table_center", "kinematics", "lengths", "start",
             "orientation"});
  MachineFile machine;
  if (const toml::node* name = top.find("name")) (void)top.text(*name, "name");
  if (const toml::node* dialect = top.find("dialect")) {
    const auto control = gcode::find_control(top.text(*dialect, "dialect"));
    if (!control)
      top.refuse(*dialect, "dialect must be \"linuxcnc\", \"grbl\", \"fanuc\", \"marlin\" or \"mach3\"");
    machine.dialect = gcode::with(machine.dialect, *control);
  }
  if (const toml::node* node = top.find("g18")) {
    const std::string value = top.text(*node, "g18");
    if (value != "zx" && value != "xz") top.refuse(*node, "g18 must be \"zx\" or \"xz\"");
    machine.dialect.g18 = value == "xz" ? Plane::xz_printed : Plane::zx;
  }
  if (const toml::node* unit = top.find("unit")) {
    const std::string value = top.text(*unit, "unit");
    if (value != "mm" && value != "inch") top.refuse(*unit, "unit must be \"mm\" or \"inch\"");
    machine.unit = value == "inch" ? 25.4 : 1.0;
  }
  if (top.find("rapid_rate") != nullptr)
    top.positive("rapid_rate", machine.rapid_rate.emplace(), machine.unit);
  top.positive("feed_limit", machine.feed_limit, machine.unit);
  if (top.find("smallest_radius") != nullptr)
    top.positive("smallest_radius", machine.smallest_radius.emplace(), machine.unit);
  if (const toml::node* node = top.find("axis")) {
    const toml::array* list = node->as_array();
    if (list == nullptr || list->empty()) top.refuse(*node, "axis must be a list of tables, [[axis]]");
    machine.axes.clear();
    machine.dialect.axes.clear();
    for (const toml::node& item : *list) read_axis(top.section("axis", item), machine);
  }
  settle_kinematics(top, machine);
  if (const toml::node* node = top.find("tools")) read_tools(top.section("tools", *node), machine);
  if (const toml::node* node = top.find("offsets")) read_offsets(top.section("offsets", *node), machine);
  if (const toml::node* node = top.find("home")) {
    const Section home = top.section("home", *node);
    home.allow({"G28", "G30"});
    if (const toml::node* place = home.find("G28"))
      machine.dialect.home_g28 = position(home, *place, "G28", machine);
    if (const toml::node* place = home.find("G30"))
      machine.dialect.home_g30 = position(home, *place, "G30", machine);
  }
  if (const toml::node* node = top.find("pass_through")) read_pass_through(top, *node, machine);
  // The language has a Z whatever the mill; where that lacks one, its places have two numbers.
  if (machine.axes.size() == 2) machine.dialect.axes.push_back({'Z', gcode::AxisKind::linear});
  if (const auto valid = gcode::validate(machine.dialect); !valid)
    throw Wrong(fmt::format("{}:1:1: error: {} {}", file, valid.error().field, message(valid.error().code)));
  return machine;
}

std::string syntax_error(const std::string& file, const toml::parse_error& error) {
  const auto at = error.source().begin;
  return fmt::format("{}:{}:{}: error: {}", file, at.line, at.column, error.description());
}

}  // namespace

Axis MachineFile::axis(std::size_t i) const {
  const MachineAxis& told = axes[i];
  const double scale = told.unit();
  step::Drive drive = told.drive;
  drive.steps_per_unit /= scale;
  drive.backlash *= scale;
  return {.letter = told.letter,
          .kind = told.rotary ? AxisKind::rotary : AxisKind::linear,
          .velocity = told.limits.velocity * scale,
          .acceleration = told.limits.acceleration * scale,
          .jerk = told.limits.jerk * scale,
          .low = told.low * scale,
          .high = told.high * scale,
          .motors = told.second ? Motors{drive, drive} : Motors{drive}};
}

std::string beyond_travel(const MachineAxis& axis, double place, bool at_start) {
  return fmt::format("axis {} {} {:.6g}, beyond its travel of {:.6g} to {:.6g}", axis.letter,
                     at_start ? "starts at" : "would move to", place / axis.unit(), axis.low, axis.high);
}

MachineFile with_table_map(MachineFile machine) {
  if (machine.kinematics != Kinematics::polar) return machine;
  const kinematics::PolarMap map{.center = machine.table_center};
  const auto start = map.joints(std::array<double, 3>{});
  double& low = machine.axes[0].low;  // of the slide, mm
  low = std::max(low, machine.least_radius());
  machine.kinematics = Kinematics::mapped;
  machine.map = {"polar", kinematics::ThreeJoints(map), {start.begin(), start.end()}, Orientation::joints};
  return machine;
}

tl::expected<MachineFile, std::string> read_machine(const std::string& file) {
  const auto unreadable = [&] { return tl::unexpected(fmt::format("{}: cannot be read", file)); };
  std::error_code unknown;
  if (std::filesystem::is_directory(file, unknown)) return unreadable();
  try {
    return interpret(file, toml::parse_file(file));
  } catch (const toml::parse_error& error) {
    return error.source().begin.line == 0 ? unreadable() : tl::unexpected(syntax_error(file, error));
  } catch (const Wrong& wrong) {
    return tl::unexpected(std::string(wrong.what()));
  }
}

tl::expected<MachineFile, std::string> parse_machine(const std::string& text, const std::string& name) {
  try {
    return interpret(name, toml::parse(text, name));
  } catch (const toml::parse_error& error) {
    return tl::unexpected(syntax_error(name, error));
  } catch (const Wrong& wrong) {
    return tl::unexpected(std::string(wrong.what()));
  }
}

}  // namespace cncplan::tools
