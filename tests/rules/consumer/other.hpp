// What the second file gives the first.
#pragma once

#include <cncplan/core/limits.hpp>

namespace other {

cncplan::Limits limits();

}  // namespace other
