"""The fastest motion of six joints through poses, at a low limit of jerk and at a high one:   joints.py [--out FOLDER]"""

import argparse
from pathlib import Path

import matplotlib

matplotlib.use("Agg")
import matplotlib.pyplot as plt
import numpy as np

import cncplan

parser = argparse.ArgumentParser(description=__doc__)
parser.add_argument("--out", type=Path, default=Path("."))
arguments = parser.parse_args()

poses = np.radians([[0, 0, 0, 0, 0, 0], [30, -20, 45, 10, 60, -30], [80, -10, 20, 40, 20, 10], [60, 30, -15, 90, -30, 60],
                    [10, 20, 10, 45, 0, 0]])

figure, plots = plt.subplots(2, 1, figsize=(8, 6), sharex=True, layout="constrained")
for plot, jerk in zip(plots, (3600, 100000), strict=True):
    motion = cncplan.time_optimal(poses, velocity=np.pi, acceleration=4 * np.pi, jerk=np.radians(jerk))
    t = np.linspace(0, motion.duration, 2000)
    state = motion.at(t)
    acceleration = np.degrees(state.acceleration)
    print(f"jerk {jerk} deg/s^3: {motion.duration:.3f} s, largest velocity {np.degrees(np.abs(state.velocity)).max():.1f} "
          f"deg/s, acceleration {np.abs(acceleration).max():.1f} deg/s^2")
    plot.plot(t, acceleration)
    plot.set(ylabel="acceleration, deg/s$^2$", title=f"jerk {jerk} deg/s$^3$")
plots[1].set(xlabel="time, s")
arguments.out.mkdir(parents=True, exist_ok=True)
figure.savefig(arguments.out / "python_joints.png", dpi=90)
