#include "utf8.hpp"

#include <utf8.h>

#include <cstdint>
#include <iterator>

namespace cncplan::tools::report {

std::string to_utf8(std::string_view text) {
  if (utf8::is_valid(text.begin(), text.end())) return std::string(text);
  std::string result;
  result.reserve(text.size() + text.size() / 8);
  for (const char c : text) utf8::append(static_cast<std::uint8_t>(c), std::back_inserter(result));
  return result;
}

}  // namespace cncplan::tools::report
