#include "other.hpp"

#include <cncplan/cncplan.hpp>

cncplan::Limits other::limits() { return {30.0, 1000.0, 10000.0}; }
