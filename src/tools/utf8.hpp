// Text of any origin as UTF-8.
#pragma once

#include <string>
#include <string_view>

namespace cncplan::tools::report {

/// The text itself where it is UTF-8; else each byte is a character of Latin-1.
[[nodiscard]] std::string to_utf8(std::string_view text);

}  // namespace cncplan::tools::report
