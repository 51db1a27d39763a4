"""A controller in a loop, with random holds and overrides:   controller.py [SEED] [--out FOLDER]"""

import argparse
import random
from pathlib import Path

import matplotlib

matplotlib.use("Agg")
import matplotlib.pyplot as plt
import numpy as np

import cncplan

here = Path(__file__).resolve().parent
parser = argparse.ArgumentParser(description=__doc__)
parser.add_argument("seed", nargs="?", type=int, default=1)
parser.add_argument("--out", type=Path, default=Path("."))
arguments = parser.parse_args()

period = 0.001
machine = cncplan.Machine(velocity=30, acceleration=1000, jerk=10000)
executor = cncplan.Executor(machine, tolerance=0.01)
program = (here.parents[1] / "examples/programs/pocket.ngc").read_text().splitlines()
chance = random.Random(arguments.seed)
points, overrides = [], []
override, resume_at = 1.0, None


def tick():
    """One period: now and then somebody turns a knob, or presses hold."""
    global override, resume_at
    now = len(points) * period
    if resume_at is not None and now >= resume_at:
        executor.resume()
        resume_at = None
    elif chance.random() < period / 2:  # every two seconds
        if chance.random() < 0.3:
            executor.feed_hold()
            resume_at = now + 0.3
        else:
            override = chance.uniform(0.3, 1.2)
            executor.feed_override(override)
    points.append(executor.tick(period))
    overrides.append(0.0 if resume_at is not None else override)


for line in program:
    while not executor.push(line):
        tick()
executor.end_of_program()
while not executor.finished:
    tick()
if executor.error:
    raise SystemExit(str(executor.error))

t = np.array([point.t for point in points])
speed = np.linalg.norm([point.velocity for point in points], axis=1)
jerk = np.linalg.norm([point.jerk for point in points], axis=1)
print(f"{t[-1]:.3f} s, {len(points)} set points; largest jerk {jerk.max():.1f} mm/s^3 of 10000")
figure, (above, below) = plt.subplots(2, 1, figsize=(9, 4.5), sharex=True, layout="constrained")
above.plot(t, overrides, color="C1")
above.set(ylabel="override")
below.plot(t, speed, linewidth=0.8)
below.set(xlabel="t, s", ylabel="speed, mm/s")
arguments.out.mkdir(parents=True, exist_ok=True)
figure.savefig(arguments.out / "python_controller.png", dpi=90)
