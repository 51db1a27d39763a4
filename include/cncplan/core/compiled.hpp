// The two forms of the library: headers only, or linked with the library `cncplan::compiled`.
#pragma once

#include <Eigen/Core>

#include "cncplan/core/compiler.hpp"

/// CNCPLAN_COMPILED is defined by the target `cncplan::compiled`. Functions that are no templates are defined
/// in that library then; without it they are inline.
#ifdef CNCPLAN_COMPILED
#define CNCPLAN_INLINE
#else
#define CNCPLAN_INLINE inline
#endif

#ifdef CNCPLAN_COMPILED
namespace cncplan::detail {

/// Vectors lie in memory as Eigen aligns them, so a program and the library have to agree on that. The
/// library defines this for its own alignment only: another one does not link.
template <int eigen_alignment>
bool compiled_with_alignment();

[[gnu::used]] inline bool (*const same_alignment)() = &compiled_with_alignment<EIGEN_MAX_ALIGN_BYTES>;

}  // namespace cncplan::detail
#endif
