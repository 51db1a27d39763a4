// The frame of a program: what it prints, and how it complains.
#pragma once

#include <fmt/format.h>

#include <algorithm>
#include <cerrno>
#include <cstdio>
#include <exception>
#include <string>
#include <string_view>
#include <utility>

#include "support/failure.hpp"

namespace support {

/// Writes to standard output, or to standard error. Throws `Failure` where standard output takes no more.
inline void print(std::string_view text, std::FILE* to = stdout) {
  const bool written = std::fwrite(text.data(), 1, text.size(), to) == text.size() && std::fflush(to) == 0;
  if (!written && to == stdout)
    throw Failure(Exit::other,
                  "standard output cannot be written: " + std::generic_category().message(errno));
}

/// One line on standard error, whatever it quotes.
inline void complain(std::string text) {
  std::replace(text.begin(), text.end(), '\n', ' ');
  fmt::print(stderr, "{}{}\n", text.find(": error: ") == std::string::npos ? "error: " : "", text);
}

/// The program's exit code: what `run` returns, or that of the failure that it throws.
template <class Run>
int main_program(Run&& run) {
  try {
    return std::forward<Run>(run)();
  } catch (const Failure& failure) {
    complain(failure.what());
    return static_cast<int>(failure.code);
  } catch (const std::exception& error) {
    complain(error.what());
    return static_cast<int>(Exit::other);
  }
}

}  // namespace support
