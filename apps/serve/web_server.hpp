// A page and what it asks for, over HTTP.
#pragma once

#include <functional>
#include <string>

#include "serve/address.hpp"

namespace serve {

/// Refuses where the build had no library to serve with. Throws `Failure`.
void check_libraries();

/// What the page can ask for; called from several threads at once.
struct Handlers {
  /// A request by its name and its value, empty where it has none; false for one that is not known.
  std::function<bool(const std::string& name, const std::string& value)> ask;
  /// JSON of what is behind row `after`; may wait for about a second until there is something.
  std::function<std::string(long long after)> rows;
  /// From now on `rows` does not wait.
  std::function<void()> end;
};

/// Serves until SIGINT or SIGTERM: the page at `/`, `GET /rows?after=N`, `POST /ask/NAME?value=V`. Says on
/// standard output where it is. Throws `Failure` where the address cannot be taken.
void run_server(const Address& address, const std::string& page, const Handlers& handlers);

/// Blocks SIGINT and SIGTERM in the calling thread and those that it starts: `run_server` waits for them.
void block_signals();

}  // namespace serve
