#!/usr/bin/env python3
# SPDX-License-Identifier: GPL-2.0-or-later
"""Differences the joints of a sampler's log, in coordinated mode:  joints.py LOG [velocity acceleration jerk]
Prints the time from the first to the last motion and how many times its limit each difference is at most;
exit 1 where one is more than 1.001 times."""
import sys

PERIOD = 1e-3
LIMITS = [float(x) for x in sys.argv[2:5]] or [30.0, 1000.0, 10000.0]
# halsampler prints a millionth of a micrometre
ROUNDING = [4e-10 * 2**order / PERIOD**order for order in (1, 2, 3)]

rows, lost = [], 0
for line in open(sys.argv[1]):
    fields = line.split()
    if "overrun" in line or len(fields) < 5:
        lost += 1
        continue
    rows.append((int(fields[0]), [1e-3 * float(x) for x in fields[1:4]], fields[4] in ("1", "TRUE")))

worst, moving = [0.0, 0.0, 0.0], []
for i in range(3, len(rows)):
    window = rows[i - 3 : i + 1]
    # jogs and homing are LinuxCNC's own; where the mode changes all is at rest
    if window[-1][0] - window[0][0] != 3 or not all(row[2] for row in window):
        continue
    for joint in range(3):
        p = [row[1][joint] for row in window]
        differences = (
            (p[3] - p[2]) / PERIOD,
            (p[3] - 2 * p[2] + p[1]) / PERIOD**2,
            (p[3] - 3 * p[2] + 3 * p[1] - p[0]) / PERIOD**3,
        )
        if p[3] != p[2]:
            moving.append(i)
        for order in range(3):
            share = max(abs(differences[order]) - ROUNDING[order], 0.0) / LIMITS[order]
            worst[order] = max(worst[order], share)
print("joints: %d samples, %d lost, %.3f s of motion; of the limits: velocity %.4f, acceleration %.4f, jerk %.4f"
      % (len(rows), lost, PERIOD * (moving[-1] - moving[0] + 1) if moving else 0.0, *worst))
if not moving:
    sys.exit("joints: nothing moved")
sys.exit(1 if max(worst) > 1.001 else 0)
