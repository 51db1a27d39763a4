// Edges as a compact stream of bytes, three a step as a rule; docs/step-output.md has the format.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <iterator>
#include <limits>
#include <optional>
#include <span>
#include <utility>

#include "cncplan/core/error.hpp"
#include "cncplan/step/edge.hpp"

namespace cncplan::step {

/// First bytes of every stream: a name and the version of the format.
inline constexpr std::array<std::uint8_t, 5> binary_signature{'C', 'N', 'C', 'S', 1};

/// Most axes that a stream has room for.
inline constexpr int binary_axes = 8;

/// Writes edges to an output iterator of bytes, times rounded to the nanosecond. A model of `Backend`.
template <std::output_iterator<std::uint8_t> Out>
class BinaryWriter {
 public:
  using Scalar = double;

  explicit BinaryWriter(Out out) : out_(std::move(out)) {
    for (const std::uint8_t byte : binary_signature) put(byte);
  }

  /// An edge of axis 0 to 7, no earlier than the one before it or time 0 (less half a nanosecond, which falls
  /// on it). Errors: those of `check`.
  Expected<void> accept(const BasicEdge<double>& edge) {
    constexpr double latest = 5e8;  // s, 16 years: what nine bytes hold
    if (auto ok = check(edge, binary_axes, not_before_, latest); !ok) return ok;
    not_before_ = edge.time;
    const std::int64_t time = std::max<std::int64_t>(std::llround(edge.time * 1e9), 0);
    const auto gap = static_cast<std::uint64_t>(time - time_);
    time_ = time;
    std::uint64_t value = gap << 4 | static_cast<std::uint64_t>(edge.axis) << 1 |
                          static_cast<std::uint64_t>(edge.direction > 0);
    for (; value >= 0x80; value >>= 7) put(static_cast<std::uint8_t>(value | 0x80));
    put(static_cast<std::uint8_t>(value));
    return {};
  }

  /// The output iterator, past the last byte.
  [[nodiscard]] Out finish() const { return out_; }

 private:
  void put(std::uint8_t byte) { *out_++ = byte; }

  Out out_;
  double not_before_ = -0.5e-9;  // s
  std::int64_t time_ = 0;        // ns
};

/// Reads such a stream back. The bytes must outlive the reader.
class BinaryReader {
 public:
  /// A reader at the first edge, or an error where the signature is another.
  [[nodiscard]] static Expected<BinaryReader> make(std::span<const std::uint8_t> bytes) {
    for (std::size_t i = 0; i < binary_signature.size(); ++i)
      if (i >= bytes.size() || bytes[i] != binary_signature[i]) return malformed(i);
    return BinaryReader(bytes);
  }

  /// The next edge, none behind the last. An error, with the place of the first byte of what is no edge.
  [[nodiscard]] Expected<std::optional<Edge>> next() {
    if (at_ == bytes_.size()) return std::optional<Edge>();
    std::uint64_t value = 0;
    for (std::size_t i = 0; i < longest && at_ + i < bytes_.size(); ++i) {
      const std::uint64_t byte = bytes_[at_ + i];
      value |= (byte & 0x7f) << (7 * i);
      if (byte < 0x80) {
        const auto gap = static_cast<std::int64_t>(value >> 4);
        if (gap > std::numeric_limits<std::int64_t>::max() - time_) return malformed(at_);
        at_ += i + 1;
        time_ += gap;
        const int axis = static_cast<int>(value >> 1 & 7);
        return std::optional<Edge>({static_cast<double>(time_) * 1e-9, axis, (value & 1) != 0 ? 1 : -1});
      }
    }
    return malformed(at_);
  }

 private:
  static constexpr std::size_t longest = 9;  // bytes of an edge: 63 bits

  explicit BinaryReader(std::span<const std::uint8_t> bytes) : bytes_(bytes), at_(binary_signature.size()) {}

  static tl::unexpected<Error> malformed(std::size_t place) {
    return tl::unexpected(Error{ErrorCode::malformed, "step stream", static_cast<double>(place), 0.0});
  }

  std::span<const std::uint8_t> bytes_;
  std::size_t at_;
  std::int64_t time_ = 0;  // ns
};

}  // namespace cncplan::step
