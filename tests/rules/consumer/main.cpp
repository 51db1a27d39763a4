// A user's program outside the tree. It includes everything, in two files, so that a function that is not
// inline shows when they are linked.
#include <cncplan/cncplan.hpp>

#include "other.hpp"

int main() { return cncplan::validate(cncplan::Limits{30.0, 1000.0, 10000.0}) == other::limits() ? 0 : 1; }
