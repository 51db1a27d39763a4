#include "web_server.hpp"

#include <fmt/format.h>
#include <httplib.h>
#include <pthread.h>
#include <sys/socket.h>

#include <algorithm>
#include <charconv>
#include <csignal>
#include <thread>

#include "support/failure.hpp"
#include "support/main_program.hpp"

namespace serve {

namespace {

using support::Exit;
using support::Failure;

sigset_t end_signals() {
  sigset_t set;
  sigemptyset(&set);
  sigaddset(&set, SIGINT);
  sigaddset(&set, SIGTERM);
  return set;
}

// A number, all of the text.
template <class T>
bool read_number(std::string_view text, T& value) {
  const auto [end, code] = std::from_chars(text.data(), text.data() + text.size(), value);
  return code == std::errc{} && end == text.data() + text.size();
}

// As it is: the library would compress a body, which takes longer than sending it to this machine.
void answer(httplib::Response& response, std::string text, const char* type) {
  const std::size_t size = text.size();
  response.set_content_provider(
      size, type, [text = std::move(text)](std::size_t offset, std::size_t length, httplib::DataSink& sink) {
        return sink.write(text.data() + offset, length);
      });
}

void refuse(httplib::Response& response, int status, const std::string& why) {
  response.status = status;
  response.set_content(why + '\n', "text/plain");
}

// Another site's page, open in the same browser, must not move anything.
bool from_own_page(const httplib::Request& request) {
  return !request.has_header("Origin") ||
         request.get_header_value("Origin") == "http://" + request.get_header_value("Host");
}

// A request says all in its address; what else comes is read and left.
bool skip_body(const httplib::Request& request, const httplib::ContentReader& body) {
  if (!request.has_header("Content-Length") && !request.has_header("Transfer-Encoding")) return true;
  return !request.is_multipart_form_data() && body([](const char*, std::size_t) { return true; });
}

}  // namespace

void check_libraries() {}

void block_signals() {
  const sigset_t set = end_signals();
  pthread_sigmask(SIG_BLOCK, &set, nullptr);
}

void run_server(const Address& address, const std::string& page, const Handlers& handlers) {
  httplib::Server server;
  server.new_task_queue = [] { return new httplib::ThreadPool(16); };  // a page waits in one of them
  server.set_keep_alive_timeout(1);                                    // s; nothing but this waits at the end
  server.set_socket_options([](socket_t socket) {  // not SO_REUSEPORT: a port in use is to be refused
    const int yes = 1;
    setsockopt(socket, SOL_SOCKET, SO_REUSEADDR, &yes, sizeof yes);
  });
  server.Get("/", [&](const httplib::Request&, httplib::Response& response) {
    answer(response, page, "text/html; charset=utf-8");
  });
  server.Get("/rows", [&](const httplib::Request& request, httplib::Response& response) {
    long long after = 0;
    if (!read_number(request.get_param_value("after"), after))
      return refuse(response, 400, "after: a number is needed");
    answer(response, handlers.rows(after), "application/json");
  });
  // With a reader of content, for the library waits for a body that was not announced, and then refuses.
  server.Post("/ask/(\\w+)", [&](const httplib::Request& request, httplib::Response& response,
                                 const httplib::ContentReader& body) {
    if (!from_own_page(request)) return refuse(response, 403, "another site's page cannot ask");
    if (!skip_body(request, body)) return refuse(response, 400, "the body of the request cannot be read");
    const std::string name = request.matches[1].str(), value = request.get_param_value("value");
    response.status = 204;
    if (!handlers.ask(name, value))
      refuse(response, 400, fmt::format("no request '{}' with the value '{}'", name, value));
  });
  server.set_error_handler([](const httplib::Request& request, httplib::Response& response) {
    if (response.body.empty())
      refuse(response, response.status,
             fmt::format("{} {}: no such page or request", request.method, request.path));
  });

  const int port = address.port > 0 ? (server.bind_to_port(address.host, address.port) ? address.port : -1)
                                    : server.bind_to_any_port(address.host);
  if (port < 0)
    throw Failure(Exit::other, fmt::format("--serve: {} port {} cannot be taken: {}", address.host,
                                           address.port, std::generic_category().message(errno)));
  const bool has_colon = address.host.find(':') != std::string::npos;
  support::print(fmt::format("http://{}:{}/\n", has_colon ? "[" + address.host + "]" : address.host, port));
  std::thread listener([&server] { server.listen_after_bind(); });
  const sigset_t set = end_signals();
  int signal = 0;
  sigwait(&set, &signal);
  handlers.end();
  server.stop();
  listener.join();
}

}  // namespace serve
