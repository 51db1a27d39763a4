// How the example programs give up: a sentence and the exit code of the contract.
#pragma once

#include <stdexcept>
#include <string>

namespace support {

enum class Exit { done = 0, other = 1, bad_input = 2 };

struct Failure : std::runtime_error {
  Failure(Exit exit, const std::string& text) : std::runtime_error(text), code(exit) {}
  Exit code;
};

}  // namespace support
