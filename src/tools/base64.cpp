#include "base64.hpp"

#include <cstdint>
#include <string_view>

namespace cncplan::tools::report {

std::string base64(std::span<const std::byte> bytes) {
  constexpr std::string_view digits = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
  std::string text;
  text.reserve((bytes.size() + 2) / 3 * 4);
  for (std::size_t i = 0; i < bytes.size(); i += 3) {
    const auto byte = [&](std::size_t k) {
      return k < bytes.size() ? std::to_integer<std::uint32_t>(bytes[k]) : 0U;
    };
    const std::uint32_t three = byte(i) << 16U | byte(i + 1) << 8U | byte(i + 2);
    for (unsigned shift = 24; shift > 0;) text += digits[three >> (shift -= 6) & 63U];
  }
  if (const std::size_t rest = bytes.size() % 3; rest > 0)
    for (std::size_t k = rest; k < 3; ++k) text[text.size() - (3 - k)] = '=';
  return text;
}

}  // namespace cncplan::tools::report
