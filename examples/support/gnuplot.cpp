#include "support/gnuplot.hpp"

#include <unistd.h>

#include <cstdlib>
#include <filesystem>
#include <system_error>

#include "support/failure.hpp"

namespace support {

namespace {

// As gnuplot reads it between single quotes.
std::string single_quoted(const std::string& text) {
  std::string result = "'";
  for (const char c : text) result += c == '\'' ? std::string("''") : std::string(1, c);
  return result + "'";
}

}  // namespace

void make_folder(const std::string& folder) {
  std::error_code error;
  std::filesystem::create_directories(folder, error);
  if (error || !std::filesystem::is_directory(folder, error) || ::access(folder.c_str(), W_OK) != 0)
    throw Failure(Exit::other, folder + ": cannot be written");
}

std::optional<Gnuplot> Gnuplot::start(const std::string& folder) {
  if (std::system("command -v gnuplot >/dev/null 2>&1") != 0) {
    fmt::print(stderr, "no pictures: gnuplot is not installed\n");
    return std::nullopt;
  }
  std::FILE* const pipe = ::popen("gnuplot", "w");
  if (pipe == nullptr) throw Failure(Exit::other, "gnuplot cannot be started");
  return Gnuplot(pipe, folder);
}

Gnuplot::Gnuplot(std::FILE* pipe, std::string folder) : pipe_(pipe, &::pclose), folder_(std::move(folder)) {
  (*this)("cd {}\nset terminal svg size 900,700 background 'white'\nset grid\nunset key\n",
          single_quoted(folder_));
}

void Gnuplot::finish() {
  if (::pclose(pipe_.release()) != 0) throw Failure(Exit::other, folder_ + ": gnuplot failed");
}

}  // namespace support
