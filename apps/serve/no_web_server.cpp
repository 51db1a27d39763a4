// Stands in for web_server.cpp where its library is not installed.
#include "support/failure.hpp"
#include "web_server.hpp"

namespace serve {

void check_libraries() {
  throw support::Failure(
      support::Exit::other,
      "--serve: built without libcpp-httplib-dev; install and build again (tools/setup does the first)");
}

void run_server(const Address&, const std::string&, const Handlers&) { check_libraries(); }
void block_signals() {}

}  // namespace serve
