"""Cycle time of a G-code file at each level, and where the time goes:   cycle_time.py [PROGRAM] [--out FOLDER]"""

import argparse
from pathlib import Path

import matplotlib

matplotlib.use("Agg")
import matplotlib.pyplot as plt
import numpy as np

import cncplan

here = Path(__file__).resolve().parent
parser = argparse.ArgumentParser(description=__doc__)
parser.add_argument("program", nargs="?", default=here.parents[1] / "examples/programs/pocket.ngc")
parser.add_argument("--out", type=Path, default=Path("."))
arguments = parser.parse_args()

machine = cncplan.Machine(velocity=30, acceleration=1000, jerk=10000)
problems = cncplan.read_program(arguments.program, machine).problems
for problem in problems:
    print(problem)
if problems:
    raise SystemExit(2)

figure, (speeds, path) = plt.subplots(1, 2, figsize=(10, 4), layout="constrained")
for level in ("exact", "fast", "good", "best"):
    trajectory = cncplan.plan_file(arguments.program, machine, tolerance=0.01, level=level)
    print(f"{level:6} {trajectory.duration:10.3f} s   {trajectory.length:.2f} mm")
    samples = trajectory.sample(0.002)
    speeds.plot(samples.t, np.linalg.norm(samples.velocity, axis=1), label=level, linewidth=0.8)
blocks = trajectory.blocks
slowest = np.argsort(blocks["duration"])[::-1][:5]
for block in blocks[slowest]:
    print(f"line {block['line']}: {block['duration']:.3f} s for {block['length']:.2f} mm")
speeds.set(xlabel="t, s", ylabel="speed of the tool, mm/s")
speeds.legend()
speed = np.linalg.norm(samples.velocity, axis=1)
points = path.scatter(samples.position[:, 0], samples.position[:, 1], c=speed, s=1, cmap="viridis")
path.set(xlabel="X, mm", ylabel="Y, mm", aspect="equal")
figure.colorbar(points, label="speed at the level best, mm/s")
arguments.out.mkdir(parents=True, exist_ok=True)
figure.savefig(arguments.out / "python_cycle_time.png", dpi=90)
