// Says how this library was compiled: see core/compiled.hpp.
#include "cncplan/core/compiled.hpp"

template <>
const bool cncplan::detail::CompiledWithAlignment<EIGEN_MAX_ALIGN_BYTES>::value = true;
