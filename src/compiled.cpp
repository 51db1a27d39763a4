// Says how this library was compiled: see core/compiled.hpp.
#include "cncplan/core/compiled.hpp"

namespace cncplan::detail {

template <int eigen_alignment>
bool compiled_with_alignment() {
  return true;
}
template bool compiled_with_alignment<EIGEN_MAX_ALIGN_BYTES>();

}  // namespace cncplan::detail
