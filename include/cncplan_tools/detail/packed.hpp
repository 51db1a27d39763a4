// Columns of whole numbers in few bytes.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <vector>

namespace cncplan::tools::report {

/// Numbers that `pack` takes are below this, and above its negative: a page reads them without rounding.
inline constexpr std::int64_t packed_end = std::int64_t{1} << 52U;

/// How many there are (32 bits), then groups of 64, bits from the lowest of each byte on. A group begins with
/// 6 bits: 0 where all of it is 0, else k + 1 with the k that makes it short. A number n is 2 n, or -2 n - 1
/// where it is negative: what is left of that above its k lowest bits as so many ones and a zero, then these
/// k bits (Rice's code). Where these would be 24 ones or more, 24 stand before all 54 bits of it.
[[nodiscard]] std::vector<std::byte> pack(std::span<const std::int64_t> values);

/// The first value, and of each other one what it differs from the one before.
[[nodiscard]] std::vector<std::int64_t> differences(std::vector<std::int64_t> values);

/// A packed column, and what the page calls it.
struct Column {
  std::string name;
  std::vector<std::byte> bytes;
};

}  // namespace cncplan::tools::report
