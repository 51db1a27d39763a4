"""KK22's Figs. 5 and 7: five-phase profiles, and five arcs at three sets of speeds:   kk22.py [--out FOLDER]"""

import argparse
from pathlib import Path

import matplotlib

matplotlib.use("Agg")
import matplotlib.pyplot as plt
import numpy as np

import cncplan

here = Path(__file__).resolve().parent
parser = argparse.ArgumentParser(description=__doc__)
parser.add_argument("--out", type=Path, default=Path("."))
arguments = parser.parse_args()
limits = {"velocity": 30, "acceleration": 1000, "jerk": 10000}

figure, (kinds, arcs) = plt.subplots(1, 2, figsize=(10, 4), layout="constrained")
# Fig. 5: with a cruise, without one, from and to speeds, to a speed that the length allows.
for length, start, end in ((5, 0, 0), (2, 0, 0), (4, 10, 20), (3, 25, 5)):
    profile = cncplan.profile(length, start, end, phases=5, **limits)
    t = np.linspace(0, profile.duration, 400)
    kinds.plot(t, profile.at(t).v, label=f"{length} mm, {start} to {end} mm/s")
kinds.set(xlabel="t, s", ylabel="v, mm/s", title="Fig. 5: five-phase profiles")
kinds.legend(fontsize="small")

# Fig. 7: block by block as published, by the speeds at the four junctions; and with look-ahead.
program = here.parents[1] / "examples/programs/kk22_figure7.ngc"
machine = cncplan.Machine(**limits)
motions = cncplan.read_program(program, machine).motions
lengths = motions["length"][motions["kind"] == "arc"]
print(f"{len(lengths)} arcs, {lengths.sum():.3f} mm")
for speeds in ((15, 15, 15, 15), (30, 15, 15, 30), (30, 30, 30, 30)):
    ends = [0, *speeds, 0]
    profiles = [cncplan.profile(length, ends[i], ends[i + 1], phases=5, **limits) for i, length in enumerate(lengths)]
    print(speeds, f"{sum(profile.duration for profile in profiles):.3f} s")
    offset = 0.0
    t, v = [], []
    for profile in profiles:
        times = np.linspace(0, profile.duration, 100)
        t.append(times + offset)
        v.append(profile.at(times).v)
        offset += profile.duration
    arcs.plot(np.concatenate(t), np.concatenate(v), linewidth=1, label=f"as published, {speeds} mm/s")
for level in ("exact", "best"):
    trajectory = cncplan.plan_file(program, machine, tolerance=0.01, level=level)
    samples = trajectory.sample(0.002)
    print(f"all of the program, {level}: {trajectory.duration:.3f} s")
    arcs.plot(samples.t, np.linalg.norm(samples.velocity, axis=1), "--", linewidth=1, label=f"with the line, {level}")
arcs.set(xlabel="t, s", ylabel="speed, mm/s", title="Fig. 7: five arcs")
arcs.legend(fontsize="x-small", loc="lower center")
arguments.out.mkdir(parents=True, exist_ok=True)
figure.savefig(arguments.out / "python_kk22.png", dpi=90)
