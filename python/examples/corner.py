"""The axes' accelerations at a corner: with G64 P0.05, and with an exact stop (G61.1):   corner.py [--out FOLDER]"""

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

axes = [cncplan.Axis(letter, velocity=50, acceleration=800, jerk=20000) for letter in "XYZ"]
machine = cncplan.Machine(velocity=40, acceleration=1000, jerk=20000, axes=axes)
corner = "G1 F2400 X20\nX30 Y17.32\n"  # by 60 degrees, at X20 Y0

figure, (accelerations, paths) = plt.subplots(1, 2, figsize=(10, 4), layout="constrained")
for mode, style in (("G64 P0.05", "-"), ("G61.1", "--")):
    trajectory = cncplan.plan_text(f"{mode}\n{corner}", machine)
    samples = trajectory.sample(0.0005)
    nearest = np.argmin(np.linalg.norm(samples.position[:, :2] - [20, 0], axis=1))
    t = samples.t - samples.t[nearest]
    speed = np.linalg.norm(samples.velocity[nearest])
    print(f"{mode}: {trajectory.duration:.4f} s; {speed:.2f} mm/s at the corner, "
          f"{np.linalg.norm(samples.position[nearest, :2] - [20, 0]):.4f} mm from it; "
          f"largest acceleration {np.linalg.norm(samples.acceleration, axis=1).max():.1f} mm/s^2")
    for axis, color in ((0, "C0"), (1, "C1")):
        accelerations.plot(t, samples.acceleration[:, axis], style, color=color, label=f"{'XY'[axis]}, {mode}")
    paths.plot(samples.position[:, 0], samples.position[:, 1], style, color="C2", label=mode)
accelerations.set(xlim=(-0.15, 0.15), xlabel="time from the corner, s", ylabel="acceleration, mm/s$^2$")
accelerations.legend(fontsize="small")
paths.set(xlim=(19.6, 20.3), ylim=(-0.05, 0.5), xlabel="X, mm", ylabel="Y, mm")
paths.legend()
arguments.out.mkdir(parents=True, exist_ok=True)
figure.savefig(arguments.out / "python_corner.png", dpi=90)
