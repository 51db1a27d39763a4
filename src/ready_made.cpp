// The ready-made machines by their names.
#include "cncplan/kinematics/ready_made-inl.hpp"
