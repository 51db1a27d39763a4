// Whole runs of a player.
#include "cncplan/plan/player/play-inl.hpp"
