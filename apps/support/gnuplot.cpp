#include "support/gnuplot.hpp"

#include <sys/mman.h>
#include <unistd.h>

#include <array>
#include <cstdlib>
#include <filesystem>
#include <system_error>

#include "support/failure.hpp"
#include "support/output_file.hpp"
#include "support/small_svg.hpp"

namespace support {

void make_folder(const std::string& folder) {
  std::error_code error;
  std::filesystem::create_directories(folder, error);
  if (error || !std::filesystem::is_directory(folder, error) || ::access(folder.c_str(), W_OK) != 0)
    throw Failure(Exit::other, folder + ": cannot be written");
}

std::optional<Gnuplot> Gnuplot::start(const std::string& folder, bool quiet) {
  if (std::system("command -v gnuplot >/dev/null 2>&1") != 0) {
    fmt::print(stderr, "no pictures: gnuplot is not installed\n");
    return std::nullopt;
  }
  std::FILE* const pipe = ::popen(quiet ? "gnuplot 2>/dev/null" : "gnuplot", "w");
  if (pipe == nullptr) throw Failure(Exit::other, "gnuplot cannot be started");
  return Gnuplot(pipe, folder);
}

Gnuplot::Gnuplot(std::FILE* pipe, std::string folder) : pipe_(pipe, &::pclose), folder_(std::move(folder)) {
  (*this)("set terminal svg size 900,700 background 'white'\nset grid\nunset key\n");
}

void Gnuplot::picture(std::string_view name) {
  const int memory = ::memfd_create("picture", 0);
  if (memory < 0) throw Failure(Exit::other, "no memory for a picture");
  pictures_.push_back({fmt::format("{}/{}", folder_, name), File(::fdopen(memory, "rb"), &std::fclose)});
  // gnuplot runs already and does not inherit the file
  (*this)("set output '/proc/{}/fd/{}'\n", ::getpid(), memory);
}

void Gnuplot::finish() {
  if (::pclose(pipe_.release()) != 0) throw Failure(Exit::other, folder_ + ": gnuplot failed");
  OutputFiles files;
  for (const Picture& picture : pictures_) {
    std::string drawn;
    std::array<char, 4096> part{};
    for (std::size_t size = 0; (size = std::fread(part.data(), 1, part.size(), picture.drawn.get())) > 0;)
      drawn.append(part.data(), size);
    *files.open(picture.path) << small_svg(drawn);
  }
  files.finish();
  files.commit();
}

}  // namespace support
