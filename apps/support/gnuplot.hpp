// Pictures by gnuplot.
#pragma once

#include <fmt/format.h>

#include <cstdio>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace support {

/// Makes the folder if it is missing. Throws `Failure` for one that cannot be made or written.
void make_folder(const std::string& folder);

/// A running gnuplot. It draws into memory, as it does not notice a full disk; the pictures are written when
/// all are there.
class Gnuplot {
 public:
  /// Says on standard error where there is no gnuplot. `quiet`: without gnuplot's own warnings.
  [[nodiscard]] static std::optional<Gnuplot> start(const std::string& folder, bool quiet = false);

  template <class... Values>
  void operator()(fmt::format_string<Values...> text, Values&&... values) {
    fmt::print(pipe_.get(), text, std::forward<Values>(values)...);
  }

  /// What is drawn from now on is this picture of the folder.
  void picture(std::string_view name);

  /// Waits for its end and writes the pictures. Throws `Failure` where one of the two failed.
  void finish();

 private:
  using File = std::unique_ptr<std::FILE, int (*)(std::FILE*)>;
  struct Picture {
    std::string path;
    File drawn;
  };

  Gnuplot(std::FILE* pipe, std::string folder);

  File pipe_;
  std::string folder_;
  std::vector<Picture> pictures_;
};

}  // namespace support
