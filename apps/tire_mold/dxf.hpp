// The entities of a DXF file, as the pairs of lines of which it is made.
#pragma once

#include <string>
#include <vector>

namespace tire_mold {

struct DxfPair {
  int code{};
  std::string value;
  int line{};  ///< of the value
};

struct DxfEntity {
  std::string type;
  int line{};
  std::vector<DxfPair> pairs;
  std::vector<std::vector<DxfPair>> vertices;  ///< of a POLYLINE, one list each
};

/// The ENTITIES section of a text DXF file. Read here, as Debian's DXF libraries keep coordinates in 24 bits
/// (dime) or would make the program GPL (dxflib). Throws `Failure` with the line for what is no DXF.
[[nodiscard]] std::vector<DxfEntity> read_dxf_entities(const std::string& file);

/// The number of a pair. Throws `Failure`.
[[nodiscard]] double dxf_number(const std::string& file, const DxfPair& pair);

}  // namespace tire_mold
