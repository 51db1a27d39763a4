"""How the time of a program depends on jerk and tolerance:   jerk_and_tolerance.py [PROGRAM] [--out FOLDER]"""

import argparse
from pathlib import Path

import matplotlib

matplotlib.use("Agg")
import matplotlib.pyplot as plt
import numpy as np

import cncplan

here = Path(__file__).resolve().parent
parser = argparse.ArgumentParser(description=__doc__)
parser.add_argument("program", nargs="?", default=here.parents[1] / "examples/programs/short_lines.ngc")
parser.add_argument("--out", type=Path, default=Path("."))
arguments = parser.parse_args()

jerks = np.geomspace(1e3, 1e6, 10)
tolerances = [0, 0.001, 0.01, 0.1]  # mm
print("jerk, mm/s^3", *(f"{tolerance:g} mm" for tolerance in tolerances), sep="\t")
times = np.empty((len(jerks), len(tolerances)))
for i, jerk in enumerate(jerks):
    machine = cncplan.Machine(velocity=30, acceleration=1000, jerk=jerk)
    for k, tolerance in enumerate(tolerances):
        times[i, k] = cncplan.plan_file(arguments.program, machine, tolerance, level="good").duration
    print(f"{jerk:.0f}", *(f"{time:.4f} s" for time in times[i]), sep="\t")

figure, axes = plt.subplots(figsize=(6, 4), layout="constrained")
for k, tolerance in enumerate(tolerances):
    axes.loglog(jerks, times[:, k], "o-", markersize=3, label=f"{tolerance:g} mm" if tolerance else "exact path")
axes.set(xlabel="jerk limit, mm/s$^3$", ylabel="time, s")
axes.legend(title="tolerance")
axes.grid(which="both", linewidth=0.3)
arguments.out.mkdir(parents=True, exist_ok=True)
figure.savefig(arguments.out / "python_jerk_and_tolerance.png", dpi=90)
