#include "conversion.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <optional>

#include "support/failure.hpp"

namespace tire_mold {

namespace {

using namespace cncplan;
using Joints = VectorN<double, 4>;

// G2, G3 and the splines G5 to G5.3 and G6.2, which become straight rows.
bool is_curve_code(double code) { return code == 2 || code == 3 || std::floor(code) == 5 || code == 6.2; }

// NURBS, of which each line says a control.
bool is_nurbs_code(double code) { return code == 5.2 || code == 6.2; }

// G0, G1 and whatever else a motion code can be: G33 to G38.x, G73 to G89.
bool is_motion_code(double code) {
  return code <= 1 || is_curve_code(code) || (code >= 33 && code < 39) || (code >= 73 && code < 90);
}

// Words that say where to go, and not what else to do: these become a row. K, L, P, Q and R belong to curves
// here; a line with a code that passes through keeps them.
bool says_where(const gcode::Word& word, bool curve) {
  constexpr std::string_view points = "XYZIJ", of_curves = "KLPQR";
  return points.find(word.letter) != std::string_view::npos || word.letter == 'K' ||
         (curve && of_curves.find(word.letter) != std::string_view::npos);
}

constexpr double cut_rounding = 1e-9;  // lengths of rows

// Takes effect when the motion of its line is over.
bool comes_last(const gcode::Word& word) {
  return word.letter == 'M' && (word.number <= 2 || word.number == 30 || word.number == 60);
}

class Converter {
 public:
  Converter(const Artwork& artwork, const kinematics::Sidewall& sidewall, const Machine& machine,
            const Options& options, const TableTurns& table)
      : artwork_(artwork),
        sidewall_(sidewall),
        machine_(machine),
        options_(options),
        table_(table),
        cutter_(sidewall, smallest_radius(machine)) {}

  Conversion run() {
    for (index_ = 0; index_ < artwork_.lines.size(); ++index_) write(artwork_.lines[index_]);
    return std::move(result_);
  }

 private:
  void write(const Line& line) {
    std::vector<Joints> rows;
    bool curved = false;
    for (const Move& move : line.moves) {
      curved = curved || move.segment.line() == nullptr;
      if (here_ || leads_to_mold(move)) map(move, rows);
    }
    if (!rows.empty()) ++result_.points;
    bool curve_code = false;
    for (const gcode::Word& word : line.words)
      if (word.letter == 'G' && is_motion_code(word.number) && !passes_through(word)) {
        curve_code = is_curve_code(word.number);
        mode_ = word.number;
      }
    const bool curve =
        curved || curve_code || is_nurbs_code(mode_) || (is_curve_code(mode_) && !rows.empty());
    const bool places = std::any_of(line.words.begin(), line.words.end(),
                                    [curve](const gcode::Word& word) { return says_where(word, curve); });
    if (rows.empty() && places && here_ && !is_nurbs_code(mode_))
      rows.push_back(*here_);  // the place where it already stands
    rewrite(line, curve, rows);
    result_.rows.insert(result_.rows.end(), rows.begin(), rows.end());
  }

  // The rows of a move; the first move of all has one, its end.
  void map(const Move& move, std::vector<Joints>& rows) {
    const auto segment = here_ ? move.segment : first_way(move.segment, sidewall_, machine_, options_);
    std::vector<WallPart> parts;
    if (auto ok = cutter_.cut(segment, parts); !ok) refuse_move(artwork_, index_, move, ok.error());
    if (!here_) {
      if (parts.empty()) {  // it stands at its end
        auto joints = sidewall_.joints(segment.end());
        if (!joints) refuse_move(artwork_, index_, move, joints.error());
        (*joints)[3] = kinematics::near_turn((*joints)[3], table_.added);
        add(move, *joints, rows);
        return;
      }
      add(move, wall_joints(parts.front(), 0.0, table_.added), rows);
    }
    row_start_ = 0.0;
    row_length_ = length_of_rows(segment);
    left_out_ = move.segment.length() - segment.length();
    next_cut_ = std::floor(left_out_ / row_length_ + cut_rounding) + 1.0;
    cuts_ = cuts_of(move.segment);
    for (std::size_t i = 0; i < parts.size(); ++i)
      if (options_.subdivide && !parts[i].kink)
        add_by_length(move, parts[i], i + 1 == parts.size() || parts[i + 1].kink, rows);
      else
        add_by_tolerance(move, parts[i], rows);
  }

  void add_by_tolerance(const Move& move, const WallPart& part, std::vector<Joints>& rows) {
    const auto division = divide(part, options_.tolerance);
    result_.chord_error = std::max(result_.chord_error, division.error);
    const double end = part.parameter_end(), width = end / division.rows;
    for (int k = 1; k <= division.rows; ++k) {
      const double u = k == division.rows ? end : width * k;
      add(move, wall_joints(part, u, (*here_)[3]), rows);
    }
  }

  // The length of fixed rows along a move: K17 measures on the surface, so moves up and down are not cut.
  // Arcs that stand upright count in full.
  [[nodiscard]] double length_of_rows(const ArtworkPath& segment) const {
    const Vector3 way = segment.derivative(0.0);
    const bool upright = segment.arc() != nullptr && segment.arc()->plane() != Plane::xy;
    const double share = upright ? 1.0 : std::hypot(way.x(), way.y()) / way.norm();
    return options_.subdivide.value_or(0.0) / share;
  }

  // K17 cuts at whole multiples of the length, and leaves the last cut out: the last row of a move is longer
  // than the others, and a move of less than two lengths is one row.
  [[nodiscard]] double cuts_of(const ArtworkPath& segment) const {
    return std::floor(segment.length() / row_length_ + cut_rounding) - 1.0;
  }

  // Rows at the cuts of the move that lie on a part, and where it ends or a kink is.
  void add_by_length(const Move& move, const WallPart& part, bool to_end, std::vector<Joints>& rows) {
    const auto row = [&](double u, const Joints& joints) {
      result_.chord_error = std::max(result_.chord_error, wall_error(part.artwork, joints, u));
      add(move, joints, rows);
      row_start_ = u;
    };
    constexpr double rounding = 1e-9;
    const double until = part.artwork.length_at(part.to) - rounding;
    const auto cut = [&] { return next_cut_ * row_length_ - left_out_; };
    for (; next_cut_ <= cuts_ && cut() < until; ++next_cut_) {
      const double u = part.artwork.parameter_at(cut());
      row(u, cut_joints(part, u));
    }
    if (to_end) row(part.to, wall_joints(part, part.to - part.from, (*here_)[3]));
  }

  // K17 writes its cuts into the flat program, with that program's decimals, before it maps them.
  [[nodiscard]] Joints cut_joints(const WallPart& part, double u) const {
    Vector3 point = part.artwork.position(u);
    const double scale = std::pow(10.0, options_.decimals);
    for (double& coordinate : point) coordinate = std::round(coordinate * scale) / scale;
    auto joints = sidewall_.joints(point);
    if (!joints) return wall_joints(part, u - part.from, (*here_)[3]);  // rounded off the wall's end
    (*joints)[3] = kinematics::near_turn((*joints)[3], (*here_)[3]);
    return *joints;
  }

  // As chord_error, for a row that may cross from one piece of the profile to the next.
  [[nodiscard]] double wall_error(const ArtworkPath& artwork, const Joints& joints, double to) const {
    const kinematics::TireMold machine{.tool_length = sidewall_.tool_length()};
    double worst = 0.0;
    for (int k = 1; k < 8; ++k) {
      const double share = k / 8.0;
      const double u = row_start_ + share * (to - row_start_);
      const WallPart on{artwork, sidewall_.map(sidewall_.piece_at(radius_at(artwork, u))), 0.0, to};
      const Vector3 tip = machine.forward(*here_ + share * (joints - *here_)).position;
      worst = std::max(worst, off_wall(on, u, tip));
    }
    return worst;
  }

  void add(const Move& move, const Joints& joints, std::vector<Joints>& rows) {
    for (std::size_t i = 0; i < 4; ++i) {
      const support::MachineAxis& axis = machine_.axes[i];
      const double joint = joints[static_cast<Eigen::Index>(i)];
      if (joint >= axis.low * axis.unit() && joint <= axis.high * axis.unit()) continue;
      throw support::Failure(
          support::Exit::bad_input,
          fmt::format("{}:{}:{}: error: {}{}", artwork_.file, index_ + 1, move.column,
                      support::beyond_travel(axis, joint), i == 3 ? why_no_turn(axis) : ""));
    }
    rows.push_back(joints);
    here_ = joints;
  }

  // The table goes on without a jump, so all its angles take the same whole turns.
  [[nodiscard]] std::string why_no_turn(const support::MachineAxis& axis) const {
    const double low = (table_.low + table_.added) / axis.unit();
    const double high = (table_.high + table_.added) / axis.unit();
    const bool back = low + high > axis.low + axis.high;
    const double turn = back ? -360.0 : 360.0;
    return fmt::format(
        ": the program turns it from {:.6g} to {:.6g}, a whole turn {} from {:.6g} to {:.6g}, and neither "
        "lies within",
        low, high, back ? "back" : "on", low + turn, high + turn);
  }

  [[nodiscard]] bool passes_through(const gcode::Word& word) const {
    const auto& passed = machine_.dialect.pass_through;
    return std::any_of(passed.begin(), passed.end(), [&](const gcode::PassThrough& entry) {
      return entry.letter == word.letter && (!entry.number || *entry.number == word.number);
    });
  }

  [[nodiscard]] std::string row_text(const Joints& joints) const {
    std::string text;
    for (std::size_t i = 0; i < 4; ++i) {
      std::string number =
          fmt::format("{:.{}f}", machine_.shown(i, joints[static_cast<Eigen::Index>(i)]), options_.decimals);
      if (number.starts_with('-') && number.find_first_of("123456789") == std::string::npos)
        number.erase(0, 1);
      text += fmt::format("{}{}{}", i == 0 ? "" : " ", machine_.axes[i].letter, number);
    }
    return text;
  }

  // The line with its axis words replaced by the first row; the other rows follow on lines of their own.
  void rewrite(const Line& line, bool curve, const std::vector<Joints>& rows) {
    std::string& out = result_.text;
    std::string last_words;
    bool placed = rows.empty();
    std::size_t copied = 0;
    for (std::size_t i = 0; i < line.words.size(); ++i) {
      const gcode::Word& word = line.words[i];
      const auto begin = static_cast<std::size_t>(word.column) - 1;
      const std::size_t end = end_of(line, i);
      std::optional<std::string> instead;
      if (says_where(word, curve)) {
        instead = placed ? "" : row_text(rows.front());
        placed = true;
      } else if (rows.size() > 1 && comes_last(word)) {
        last_words += ' ' + line.text.substr(begin, end - begin);
        instead = "";
      } else {
        instead = translated(word);
      }
      if (!instead) continue;
      out.append(line.text, copied, begin - copied);
      copied = end;
      if (instead->empty())
        while (copied < line.text.size() && line.text[copied] == ' ') ++copied;
      out += *instead;
    }
    out.append(line.text, copied);
    while (out.ends_with(' ') && copied > 0) out.pop_back();
    out += '\n';
    for (std::size_t i = 1; i < rows.size(); ++i)
      out += row_text(rows[i]) + (i + 1 == rows.size() ? last_words : "") + '\n';
  }

  // Behind the number of a word: blanks and comments that follow it are not its own.
  static std::size_t end_of(const Line& line, std::size_t word) {
    const auto from = static_cast<std::size_t>(line.words[word].column);
    const std::size_t end = line.text.find_first_not_of("0123456789+-. \t", from);
    const std::size_t last = line.text.find_last_of("0123456789.", end == std::string::npos ? end : end - 1);
    return last + 1;
  }

  // The output is absolute, in millimetres, and has no arcs.
  std::optional<std::string> translated(const gcode::Word& word) {
    if (word.letter == 'F' && inches_) return fmt::format("F{:.4f}", word.number * 25.4);
    if (word.letter != 'G') return std::nullopt;
    if (passes_through(word)) return std::nullopt;
    if (word.number == 5.3) return "";
    if (is_curve_code(word.number)) return "G01";
    if (word.number == 91) return "G90";
    if (word.number == 90.1 || word.number == 91.1) return "";
    if (word.number == 20 || word.number == 21) inches_ = word.number == 20;
    return word.number == 20 ? std::optional<std::string>("G21") : std::nullopt;
  }

  const Artwork& artwork_;
  const kinematics::Sidewall& sidewall_;
  const Machine& machine_;
  const Options& options_;
  TableTurns table_;
  WallCutter cutter_;
  std::size_t index_ = 0;
  std::optional<Joints> here_;
  bool inches_ = false;
  double mode_ = -1.0;       // the last motion code
  double row_start_ = 0.0;   // parameter of the move where the row under way began
  double row_length_ = 0.0;  // mm along the move from row to row
  double next_cut_ = 1.0;    // a count: the next cut of the move is this many lengths along it
  double cuts_ = 0.0;        // of the move
  double left_out_ = 0.0;    // mm of the move before the part that is mapped
  Conversion result_;
};

}  // namespace

bool leads_to_mold(const Move& move) {
  const Vector3 way = move.segment.chord();
  return way.x() != 0.0 || way.y() != 0.0;
}

ArtworkPath first_way(const ArtworkPath& segment, const kinematics::Sidewall& sidewall,
                      const Machine& machine, const Options& options) {
  const Vector3 start = segment.start(), end = segment.end();
  const double from = std::hypot(start.x(), start.y()), to = std::hypot(end.x(), end.y());
  const double entry = std::max(sidewall.start_radius(), smallest_radius(machine));
  if (!options.approach || segment.line() == nullptr || to <= entry) return path::Line<3>(end, end);
  const double share = std::max(0.0, (entry - from) / (to - from));
  return path::Line<3>(start + share * (end - start), end);
}

void refuse_move(const Artwork& artwork, std::size_t line, const Move& move, const Error& error) {
  const std::string why =
      error.code == ErrorCode::above_limit
          ? fmt::format("a radius of {:.6g} mm lies beyond the profile, which ends at {:.6g}", error.value,
                        error.bound)
          : fmt::format("a radius of {:.6g} mm is below {:.6g}, the least that is mapped", error.value,
                        error.bound);
  throw support::Failure(support::Exit::bad_input,
                         fmt::format("{}:{}:{}: error: {}", artwork.file, line + 1, move.column, why));
}

Conversion convert(const Artwork& artwork, const kinematics::Sidewall& sidewall, const Machine& machine,
                   const Options& options, const TableTurns& table) {
  return Converter(artwork, sidewall, machine, options, table).run();
}

}  // namespace tire_mold
