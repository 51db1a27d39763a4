// The version of the library: CMake reads it from here, so it is written once.
#pragma once

#define CNCPLAN_VERSION_MAJOR 0
#define CNCPLAN_VERSION_MINOR 2
#define CNCPLAN_VERSION_PATCH 0
