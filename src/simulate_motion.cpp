// Whole runs of a motion executor.
#include "cncplan/detail/executor/simulate_motion-inl.hpp"
