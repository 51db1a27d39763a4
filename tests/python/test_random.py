"""Random calls: whatever is handed in, an answer or an exception comes out, and the answers hold together.

More calls: CNCPLAN_CALLS=100000 tools/python -m pytest tests/python/test_random.py
"""

import dataclasses
import math
import os

import numpy as np
from conftest import LEVELS, LIMITS
from hypothesis import HealthCheck, given, settings
from hypothesis import strategies as st

import cncplan

CALLS = int(os.environ.get("CNCPLAN_CALLS", "160"))
MILL = cncplan.Machine(**LIMITS)
quick = settings(max_examples=CALLS // 4, deadline=None, database=None, derandomize="CNCPLAN_CALLS" not in os.environ,
                 suppress_health_check=list(HealthCheck))

coordinate = st.floats(-50, 50).map(lambda x: round(x, 3))
ARC = cncplan.arc([0, 0, 0], [10, 0, 0], radius=6)
FIELDS = [field.name for field in dataclasses.fields(ARC)]
junk = st.one_of(st.none(), st.booleans(), st.integers(), st.floats(), st.text(max_size=8), st.binary(max_size=8),
                 st.lists(st.floats(), max_size=4), st.complex_numbers(), st.just(object()), st.just({}),
                 st.just(np.zeros((2, 2))), st.just(np.array("x")))
word = st.builds(lambda letter, number: f"{letter}{number}", st.sampled_from("XYZIJKRFGMPQSTLH#[]o;()/%"),
                 st.one_of(st.integers(-5, 99), coordinate, st.sampled_from(["", "1e9", "[1/0]", "#1=2", "<a>"])))
text = st.one_of(st.lists(st.lists(word, max_size=5).map(" ".join), max_size=8).map("\n".join), st.text(max_size=60))


def tried(call, *arguments, **named):
    """The answer; None where it was refused as promised."""
    try:
        return call(*arguments, **named)
    except (cncplan.Error, TypeError, MemoryError) as error:
        assert str(error)
        return None


@quick
@given(text, st.sampled_from(LEVELS), st.sampled_from([0, 0.01, 1.0]))
def test_any_text(program, level, tolerance):
    trajectory = tried(cncplan.plan_text, program, MILL, tolerance, level)
    problems = cncplan.read_program(text=program, machine=MILL).problems
    if trajectory is None:
        return
    assert not problems
    if trajectory.duration < 1000:
        samples = trajectory.sample(0.01)
        assert np.isfinite(samples.position).all() and np.isfinite(samples.jerk).all()
        assert (np.diff(samples.t) >= 0).all()
        trajectory.words, trajectory.blocks, trajectory.warnings, trajectory.peaks()


@quick
@given(st.lists(st.tuples(coordinate, coordinate), min_size=1, max_size=12), st.sampled_from(LEVELS))
def test_random_lines(points, level):
    program = "G1 F1800\n" + "\n".join(f"X{x} Y{y}" for x, y in points)
    trajectory = cncplan.plan_text(program, MILL, level=level)
    ways = np.diff(np.array([(0.0, 0.0), *points]), axis=0)
    assert math.isclose(trajectory.length, np.hypot(*ways.T).sum(), rel_tol=1e-9, abs_tol=1e-9)
    # No motion is faster than at 30 mm/s throughout, but for corners that are cut by 0.01 mm.
    assert trajectory.duration >= (trajectory.length - 0.05 * len(points)) / 30 * (1 - 1e-9)
    end = trajectory.at(trajectory.duration)
    assert np.allclose(end.position[:2], points[-1], atol=1e-9) and not end.velocity.any()
    exact = cncplan.plan_text(program, MILL, level="exact")
    assert math.isclose(trajectory.blocks["length"].sum(), exact.blocks["length"].sum(), rel_tol=1e-9, abs_tol=1e-6)


@quick
@given(st.data())
def test_any_arguments(data):
    d = data.draw
    trajectory = cncplan.plan_text("G1 X1 F600", MILL, level="exact")
    calls = [
        lambda: cncplan.Machine(d(junk), velocity=d(junk), acceleration=d(junk), jerk=d(junk)),
        lambda: cncplan.Machine(**LIMITS, axes=d(st.one_of(junk, st.lists(st.dictionaries(st.text(max_size=8), junk))))),
        lambda: cncplan.Axis(d(junk), d(junk), velocity=d(junk)),
        lambda: cncplan.Machine(**LIMITS, axes=[cncplan.Axis(d(st.text(max_size=2)), travel=d(junk), jerk=d(junk))]),
        lambda: cncplan.plan_text(d(junk), MILL, d(junk), d(junk)),
        lambda: cncplan.plan_text("G1 X1", MILL, start=d(junk), rotary_tolerance=d(junk)),
        lambda: cncplan.plan_file(d(junk), MILL),
        lambda: trajectory.sample(d(junk)),
        lambda: trajectory.at(d(junk)),
        lambda: trajectory.at(d(st.lists(st.floats(), max_size=5))),
        lambda: cncplan.line(d(junk), d(junk), feed=d(junk)),
        lambda: cncplan.arc(d(st.lists(st.floats(), min_size=3, max_size=3)), d(st.lists(coordinate, min_size=3, max_size=3)),
                            radius=d(junk)),
        lambda: cncplan.arc([0, 0, 0], d(st.lists(coordinate, min_size=3, max_size=4)),
                            center=d(st.lists(st.floats(), min_size=3, max_size=3)), extra_turns=d(junk)),
        lambda: cncplan.plan_blocks(d(junk), MILL),
        lambda: cncplan.plan_blocks([dataclasses.replace(ARC, **{d(st.sampled_from(FIELDS)): d(junk)})], MILL),
        lambda: cncplan.plan_blocks(cncplan.curve(d(st.lists(st.tuples(st.floats(), coordinate, coordinate), max_size=5))), MILL),
        lambda: cncplan.profile(d(st.floats()), d(st.floats()), d(st.floats()), velocity=d(st.floats()),
                                acceleration=d(st.floats()), jerk=d(st.floats())).at(d(st.floats())),
        lambda: cncplan.read_program(d(junk), d(junk), text=d(junk)),
        lambda: cncplan.write_gcode(d(junk), d(junk)),
    ]
    tried(d(st.sampled_from(calls)))


BENCH = cncplan.Machine(**LIMITS, axes=[cncplan.Axis(letter, velocity=40, acceleration=700, jerk=9000, travel=(-60, 60))
                                        for letter in "XYZ"])
REQUESTS = ["feed_hold", "resume", "stop", "quick_stop", "return_to_path", "reverse", "single_step", "optional_stop",
            "program_stop", "pause_at", "feed_override", "rapid_override", "jog", "jog_to", "restart", "push", "tick"]


@quick
@given(st.lists(st.tuples(st.sampled_from(REQUESTS), junk), max_size=30), st.lists(coordinate, min_size=3, max_size=3),
       st.sampled_from(LEVELS))
def test_any_requests(requests, place, level):
    executor = cncplan.Executor(BENCH, level=level)
    for line in ("F1200", "G1 X20", "Y20", "G2 X0 Y0 R30", "M1", "G1 X5"):
        executor.push(line)
    executor.end_of_program()
    for name, argument in requests:
        method = getattr(executor, name)
        if name in ("jog", "jog_to"):
            tried(method, place)
            tried(method, argument)
        elif name == "restart":
            tried(method, argument, place)
        elif name in ("feed_hold", "resume", "stop", "quick_stop", "return_to_path"):
            tried(method)
        else:
            tried(method, argument)
        for _ in range(20):
            point = executor.tick(0.005)
        assert np.isfinite(point.position).all() and np.isfinite(point.velocity).all()
        assert (np.abs(point.velocity) <= 40 * (1 + 1e-6)).all()
        executor.error, executor.finished, executor.time


@quick
@given(st.lists(coordinate, min_size=9, max_size=9), st.floats(0, 5, allow_subnormal=False))
def test_random_moves(numbers, least):
    start = cncplan.State(numbers[:3], [x / 2 for x in numbers[3:6]])
    move = tried(cncplan.move_to, start, numbers[6:], BENCH, minimum_duration=least)
    if move is None:
        return
    assert move.duration >= least * (1 - 1e-12)
    state = move.at(np.linspace(0, move.duration, 50))
    assert np.abs(state.position[-1] - numbers[6:]).max() < 1e-6 and np.abs(state.velocity[-1]).max() < 1e-6
    assert (np.abs(state.velocity) <= 40 * (1 + 1e-9)).all() and (np.abs(state.acceleration) <= 700 * (1 + 1e-9)).all()
