// Bytes as text.
#pragma once

#include <cstddef>
#include <span>
#include <string>

namespace cncplan::tools::report {

/// RFC 4648, with padding.
[[nodiscard]] std::string base64(std::span<const std::byte> bytes);

}  // namespace cncplan::tools::report
