#include "cncplan_tools/detail/packed.hpp"

#include <algorithm>
#include <array>
#include <numeric>
#include <utility>

namespace cncplan::tools::report {

namespace {

constexpr std::size_t group_size = 64;
constexpr unsigned header_bits = 6, whole_bits = 54;
constexpr std::uint64_t most_ones = 24;

std::uint64_t without_sign(std::int64_t n) {
  return n < 0 ? 2 * static_cast<std::uint64_t>(-(n + 1)) + 1 : 2 * static_cast<std::uint64_t>(n);
}

class Bits {
 public:
  void put(std::uint64_t value, unsigned count) {
    for (; count > 0; --count, value >>= 1U) {
      if (held_ == 0) bytes_.push_back(std::byte{0});
      bytes_.back() |= static_cast<std::byte>((value & 1U) << held_);
      held_ = (held_ + 1) % 8;
    }
  }
  [[nodiscard]] std::vector<std::byte> take() { return std::move(bytes_); }

 private:
  std::vector<std::byte> bytes_;
  unsigned held_ = 0;  // bits of the last byte
};

std::uint64_t cost(std::span<const std::uint64_t> group, unsigned k) {
  std::uint64_t bits = 0;
  for (const std::uint64_t u : group) bits += u >> k < most_ones ? (u >> k) + 1 + k : most_ones + whole_bits;
  return bits;
}

void put_group(Bits& out, std::span<const std::uint64_t> group) {
  const std::uint64_t largest = *std::max_element(group.begin(), group.end());
  if (largest == 0) return out.put(0, header_bits);
  unsigned k = 0;
  std::uint64_t least = cost(group, k);
  for (unsigned other = 1; largest >> other != 0; ++other)
    if (const std::uint64_t bits = cost(group, other); bits < least) {
      least = bits;
      k = other;
    }
  out.put(k + 1, header_bits);
  for (const std::uint64_t u : group) {
    const std::uint64_t ones = u >> k;
    if (ones < most_ones) {
      out.put((std::uint64_t{1} << ones) - 1, static_cast<unsigned>(ones) + 1);
      out.put(u, k);
    } else {
      out.put((std::uint64_t{1} << most_ones) - 1, static_cast<unsigned>(most_ones));
      out.put(u, whole_bits);
    }
  }
}

}  // namespace

std::vector<std::byte> pack(std::span<const std::int64_t> values) {
  Bits out;
  out.put(values.size(), 32);
  std::array<std::uint64_t, group_size> room;
  for (std::size_t first = 0; first < values.size(); first += group_size) {
    const auto group = values.subspan(first, std::min(group_size, values.size() - first));
    std::transform(group.begin(), group.end(), room.begin(), without_sign);
    put_group(out, std::span(room).first(group.size()));
  }
  return out.take();
}

std::vector<std::int64_t> differences(std::vector<std::int64_t> values) {
  std::adjacent_difference(values.begin(), values.end(), values.begin());
  return values;
}

}  // namespace cncplan::tools::report
