#include "address.hpp"

#include <fmt/format.h>

#include <charconv>

#include "support/failure.hpp"

namespace serve {

Address parse_address(std::string_view text) {
  Address address;
  std::string_view port = text;
  if (const std::size_t colon = text.rfind(':'); colon != std::string_view::npos) {
    std::string_view host = text.substr(0, colon);
    port = text.substr(colon + 1);
    if (host.starts_with('[') && host.ends_with(']')) host = host.substr(1, host.size() - 2);
    address.host = host;
  }
  const auto [end, code] = std::from_chars(port.data(), port.data() + port.size(), address.port);
  if (address.host.empty() || code != std::errc{} || end != port.data() + port.size() || address.port < 0 ||
      address.port > 65535)
    throw support::Failure(support::Exit::bad_input,
                           fmt::format("--serve: '{}' is no PORT or ADDRESS:PORT", text));
  return address;
}

}  // namespace serve
