// SPDX-License-Identifier: GPL-2.0-or-later
// LinuxCNC's headers, in an order in which C++ can read them, and what differs between its versions.
#pragma once

#include <posemath.h>

extern "C" {
#include <rtapi.h>

#include <hal.h>
#include <motion.h>
#include <motion_types.h>
#include <tp.h>
}

#if __has_include(<inifile.h>)
#include <inifile.h>
#else
#error "inifile.h is missing: install linuxcnc-uspace-dev"
#endif

/// LinuxCNC 2.10 hands the jerk limit of its ini to the three functions that add moves; 2.9 has no such
/// argument. The Makefile reads tp.h and sets CNCPLAN_TP_JERK where it has.
#ifdef CNCPLAN_TP_JERK
#define CNCPLAN_TP_JERK_PARAMETER double ini_maxjerk,
#define CNCPLAN_TP_JERK_ARGUMENT(jerk) (jerk),
#define CNCPLAN_TP_KEEP_JERK(move) (move).jerk = ini_maxjerk
#else
#define CNCPLAN_TP_JERK_PARAMETER
#define CNCPLAN_TP_JERK_ARGUMENT(jerk)
#define CNCPLAN_TP_KEEP_JERK(move) static_cast<void>(move)
#endif
