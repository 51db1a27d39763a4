// The lines that an events file asks to pause at.
#pragma once

#include <string>
#include <vector>

namespace simulate {

/// `value` of a row `t,pause,value`, and where it stands.
struct PausePlace {
  int line{};  ///< of the program
  int row{}, column{};
};

/// Throws `Failure` as `read_events` does.
[[nodiscard]] std::vector<PausePlace> pause_places(const std::string& file);

}  // namespace simulate
