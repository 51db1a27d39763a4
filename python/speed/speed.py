"""How long plan_file and a million samples take, in C++ and in Python, by turns:   speed.py PROGRAM [PAIRS]

Run it by tools/python; the C++ program is built by this.
"""

import statistics
import subprocess
import sys
import time
from pathlib import Path

import cncplan

build = Path(cncplan.__file__).parents[2]  # that of tools/python
subprocess.run(["cmake", "--build", build, "--target", "cncplan_python_speed"], check=True, stdout=sys.stderr)
program, pairs = sys.argv[1], int(sys.argv[2]) if len(sys.argv) > 2 else 7
machine = cncplan.Machine(velocity=30, acceleration=1000, jerk=10000)
times = {"C++": [], "Python": []}
for _ in range(pairs):
    done = subprocess.run([build / "cncplan_python_speed", program], check=True, capture_output=True, text=True)
    planned, sampled, duration, points = done.stdout.split()
    times["C++"].append((float(planned), float(sampled)))
    start = time.perf_counter()
    trajectory = cncplan.plan_file(program, machine)
    middle = time.perf_counter()
    samples = trajectory.sample(trajectory.duration / 1e6)
    times["Python"].append((middle - start, time.perf_counter() - middle))
    assert trajectory.duration == float(duration) and len(samples) == int(points)
    del trajectory, samples
for column, what in enumerate(("plan_file", "1e6 samples")):
    cpp, python = ([row[column] for row in times[language]] for language in ("C++", "Python"))
    ratio = statistics.median(b / a for a, b in zip(cpp, python))
    print(f"{what:12} C++ {statistics.median(cpp):8.4f} s   Python {statistics.median(python):8.4f} s   "
          f"median of the ratios {ratio:.3f}")
