#include "dxf.hpp"

#include <fmt/format.h>

#include <charconv>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <string_view>
#include <utility>

#include "support/failure.hpp"

namespace tire_mold {

namespace {

using support::Exit;
using support::Failure;

[[noreturn]] void refuse(const std::string& file, int line, std::string_view why) {
  throw Failure(Exit::bad_input, fmt::format("{}:{}:1: error: {}", file, line, why));
}

std::string_view trimmed(std::string_view text) {
  constexpr std::string_view blanks = " \t\r";
  const auto first = text.find_first_not_of(blanks);
  if (first == std::string_view::npos) return {};
  return text.substr(first, text.find_last_not_of(blanks) - first + 1);
}

// Two lines at a time: a group code and its value.
class Pairs {
 public:
  explicit Pairs(const std::string& file) : file_(file), stream_(file, std::ios::binary) {
    if (!stream_ || std::filesystem::is_directory(file))
      throw Failure(Exit::bad_input, fmt::format("{}: cannot be read", file));
    if (stream_.peek() == std::ifstream::traits_type::eof()) refuse(file, 1, "the drawing is empty");
  }

  /// The next pair; refuses the end of the file, as EOF comes before it.
  DxfPair next() {
    std::string code_text, value;
    if (!std::getline(stream_, code_text) || !std::getline(stream_, value))
      refuse(file_, line_ + 1, "the drawing ends before its EOF");
    line_ += 2;
    DxfPair pair;
    const std::string_view digits = trimmed(code_text);
    const auto [end, error] = std::from_chars(digits.data(), digits.data() + digits.size(), pair.code);
    if (error != std::errc{} || end != digits.data() + digits.size())
      refuse(file_, line_ - 1, "is not a DXF drawing: a group code should stand here");
    pair.value = trimmed(value);
    pair.line = line_;
    return pair;
  }

 private:
  const std::string& file_;
  std::ifstream stream_;
  int line_ = 0;
};

bool begins(const DxfPair& pair, std::string_view what) { return pair.code == 0 && pair.value == what; }

}  // namespace

std::vector<DxfEntity> read_dxf_entities(const std::string& file) {
  Pairs pairs(file);
  std::vector<DxfEntity> entities;
  bool among_entities = false;
  std::vector<DxfPair>* taker = nullptr;  // of the pairs that come
  for (DxfPair pair = pairs.next(); !begins(pair, "EOF"); pair = pairs.next()) {
    if (begins(pair, "SECTION")) {
      const DxfPair name = pairs.next();
      among_entities = name.code == 2 && name.value == "ENTITIES";
    } else if (begins(pair, "ENDSEC")) {
      among_entities = false;
      taker = nullptr;
    } else if (among_entities && begins(pair, "SEQEND")) {
      taker = nullptr;
    } else if (among_entities && begins(pair, "VERTEX")) {
      if (entities.empty() || entities.back().type != "POLYLINE")
        refuse(file, pair.line, "a VERTEX without POLYLINE");
      taker = &entities.back().vertices.emplace_back();
    } else if (among_entities && pair.code == 0) {
      entities.push_back({pair.value, pair.line, {}, {}});
      taker = &entities.back().pairs;
    } else if (taker != nullptr) {
      taker->push_back(std::move(pair));
    }
  }
  return entities;
}

double dxf_number(const std::string& file, const DxfPair& pair) {
  double value = 0.0;
  const char* first = pair.value.data();
  const char* const last = first + pair.value.size();
  if (first != last && *first == '+') ++first;
  const auto [end, error] = std::from_chars(first, last, value);
  if (error != std::errc{} || end != last || !std::isfinite(value))
    refuse(file, pair.line, fmt::format("'{}' is not a number", pair.value));
  return value;
}

}  // namespace tire_mold
