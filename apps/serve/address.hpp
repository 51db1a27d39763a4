// Where a program is served.
#pragma once

#include <string>
#include <string_view>

namespace serve {

struct Address {
  std::string host = "127.0.0.1";
  int port{};  ///< 0: any that is free
};

/// Of PORT, ADDRESS:PORT or [ADDRESS]:PORT. Throws `Failure`.
[[nodiscard]] Address parse_address(std::string_view text);

}  // namespace serve
