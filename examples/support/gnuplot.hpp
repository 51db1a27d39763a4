// Pictures by gnuplot.
#pragma once

#include <fmt/format.h>

#include <cstdio>
#include <memory>
#include <optional>
#include <string>
#include <utility>

namespace support {

/// Makes the folder if it is missing. Throws `Failure` for one that cannot be made or written.
void make_folder(const std::string& folder);

/// A running gnuplot that writes into a folder.
class Gnuplot {
 public:
  /// Says on standard error where there is no gnuplot.
  [[nodiscard]] static std::optional<Gnuplot> start(const std::string& folder);

  template <class... Values>
  void operator()(fmt::format_string<Values...> text, Values&&... values) {
    fmt::print(pipe_.get(), text, std::forward<Values>(values)...);
  }

  /// Waits for its end. Throws `Failure` where it failed.
  void finish();

 private:
  Gnuplot(std::FILE* pipe, std::string folder);

  std::unique_ptr<std::FILE, int (*)(std::FILE*)> pipe_;
  std::string folder_;
};

}  // namespace support
