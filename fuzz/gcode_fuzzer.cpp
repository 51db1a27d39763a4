// libFuzzer's entry: any bytes are G-code to somebody.
#include <cstddef>
#include <cstdint>

#include "check_gcode.hpp"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  cncplan::fuzz::check_gcode({reinterpret_cast<const char*>(data), size});
  return 0;
}
