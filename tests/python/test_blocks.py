"""Blocks made by hand, motions of axes, profiles, programs."""

import dataclasses
import math
import os
import time

import numpy as np
import pytest
from conftest import LEVELS, LIMITS, ROOT

import cncplan
from cncplan import Axis, Machine, State

SEED = int(os.environ.get("CNCPLAN_SEED", time.time_ns() % 10**9))


@pytest.mark.parametrize("level", LEVELS)
def test_blocks_are_as_their_program(mill, level):
    blocks = [cncplan.line([0, 0, 0], [20, 0, 0], feed=30, number=1),
              cncplan.arc([20, 0, 0], [25, 5, 0], center=[20, 5, 0], feed=20, number=2),
              cncplan.line([25, 5, 0], [25, 30, 0], feed=30, pause=0.5, number=3)]
    trajectory = cncplan.plan_blocks(blocks, mill, level=level)
    text = "F1800\nG1 X20\nG3 X25 Y5 I0 J5 F1200\nG1 Y30 F1800\n"
    planned = cncplan.plan_text(text, mill, level=level)
    assert trajectory.duration == pytest.approx(planned.duration + 0.5, abs=1e-9)
    assert trajectory.length == pytest.approx(45 + 2.5 * math.pi)
    assert trajectory.blocks["line"].tolist() == [1, 2, 3]
    for t in np.linspace(0, planned.duration, 50):
        assert trajectory.at(t).position == pytest.approx(planned.at(t).position, abs=1e-9)
    by_radius = cncplan.arc([20, 0, 0], [25, 5, 0], radius=5, feed=20, number=2)
    assert cncplan.plan_blocks([blocks[0], by_radius, blocks[2]], mill, level=level).duration == \
        pytest.approx(trajectory.duration, abs=1e-9)


def test_curve_goes_through_its_points(mill):
    angles = np.linspace(0, math.pi, 13)
    points = np.column_stack([20 * np.cos(angles), 20 * np.sin(angles), angles])
    curve = cncplan.curve(points, feed=10)
    assert len(curve) == 12
    trajectory = cncplan.plan_blocks(curve, mill, level="exact")
    position = trajectory.sample(0.001).position
    for point in points:
        assert np.linalg.norm(position - point, axis=1).min() < 0.02  # half a period at 10 mm/s, and rounding
    radius = np.hypot(position[:, 0], position[:, 1])
    assert np.abs(radius - 20).max() < 0.1  # at the natural ends
    inside = (position[:, 2] > 1) & (position[:, 2] < 2)
    assert np.abs(radius - 20)[inside].max() < 0.005
    speed = trajectory.sample(0.001).v
    assert speed[(position[:, 2] > 0.3) & (position[:, 2] < 2.8)].min() > 9.9  # no stop at a point
    assert len(cncplan.curve([[0, 0, 0], [1, 0, 0]])) == 1


def test_other_axes_go_along_arcs():
    machine = Machine(**LIMITS, axes=[Axis(letter) for letter in "XYZA"])
    block = cncplan.arc([0, 0, 0, 0], [10, 10, 0, 1], radius=10, clockwise=True, feed=10)
    trajectory = cncplan.plan_blocks([block], machine)
    middle = trajectory.at(trajectory.duration / 2)
    assert middle.position[3] == pytest.approx(0.5) and trajectory.length == pytest.approx(5 * math.pi)


@pytest.mark.parametrize("make, code", [
    (lambda: cncplan.arc([0, 0, 0], [10, 0, 0], radius=3), "chord_exceeds_diameter"),
    (lambda: cncplan.arc([0, 0, 0], [10, 0, 0], center=[0, 3, 0]), "radius_mismatch"),
    (lambda: cncplan.arc([0, 0, 0], [0, 0, 0], radius=3), "coincident_points"),
    (lambda: cncplan.arc([0, 0, 0], [1, 0, 0]), "conflicting_words"),
    (lambda: cncplan.arc([0, 0], [1, 0], radius=3), "malformed"),
    (lambda: cncplan.arc([0, 0, 0], [1, 0, 0], radius=3, plane="xz"), "not_supported"),
    (lambda: cncplan.arc([0, 0, 0], [1, 0, 0], radius=3, extra_turns=-1), "below_limit"),
    (lambda: cncplan.line([0, 0], [1, 0, 0]), "malformed"),
    (lambda: cncplan.line([0, 0], [math.nan, 0]), "not_finite"),
    (lambda: cncplan.line([0, 0], [1, 0], feed=0), "not_positive"),
    (lambda: cncplan.line([0, 0], [1, 0], pause=-1), "negative"),
    (lambda: cncplan.line([], []), "above_limit"),
    (lambda: cncplan.line([0] * 10, [1] * 10), "above_limit"),
    (lambda: cncplan.curve([[0, 0, 0]]), "below_limit"),
    (lambda: cncplan.curve([[0, 0], [1, 1]]), "malformed"),
    (lambda: cncplan.curve([[0, 0, 0], [0, 0, 0]]), "not_positive"),
])
def test_errors_of_blocks(make, code):
    with pytest.raises(cncplan.Error) as caught:
        make()
    assert caught.value.code == code


@pytest.mark.parametrize("block", [cncplan.line([0, 0, 0], [5, 0, 0]), cncplan.arc([0, 0, 0], [10, 0, 0], radius=6),
                                   cncplan.curve([[0, 0, 0], [1, 1, 1], [3, 2, 0]])[0]], ids=lambda block: block.kind)
def test_a_block_is_checked_however_it_is_made(mill, block):
    quick = dataclasses.replace(block, feed=20, end=np.array([6.0, 0, 0]))
    assert (quick.feed, quick.end) == (20, (6, 0, 0)) and cncplan.plan_blocks([quick], mill, level="fast").duration > 0
    junk = [None, True, 0, -1, math.nan, math.inf, 1e308, "x", b"y", (), (1,), (1, 2), (math.nan, 0, 0), [0] * 10, 2**40,
            -2**70, object(), {}, "spline", "arc_center", "yz", np.zeros((2, 2))]
    for field in dataclasses.fields(block):
        for value in junk:
            try:
                changed = dataclasses.replace(block, **{field.name: value})
            except (cncplan.Error, TypeError) as error:
                assert str(error)
            else:  # whatever is taken can be planned, or says why not
                try:
                    assert math.isfinite(cncplan.plan_blocks([changed], mill, level="fast").duration)
                except cncplan.Error:
                    pass
    for wrong in ({"feed": -1}, {"kind": "circle"}, {"plane": "xz"}, {"number": -1}, {"end": (1, 2)}, {"tolerance": math.nan}):
        with pytest.raises(cncplan.Error):
            dataclasses.replace(block, **wrong)
    with pytest.raises(TypeError, match="feed: expected a number, got str"):
        dataclasses.replace(block, feed="fast")


def test_errors_of_plans_of_blocks(mill):
    line = cncplan.line([0, 0, 0], [1, 0, 0])
    with pytest.raises(cncplan.Error) as caught:
        cncplan.plan_blocks([line, cncplan.line([2, 0, 0], [3, 0, 0])], mill)
    assert caught.value.code == "discontinuous" and caught.value.block == 1
    with pytest.raises(cncplan.Error, match="has 2 axes where the machine has 3"):
        cncplan.plan_blocks([cncplan.line([0, 0], [1, 0])], mill)
    with pytest.raises(cncplan.Error, match="none"):
        cncplan.plan_blocks([], mill)
    with pytest.raises(TypeError, match="blocks: expected a list of blocks, got Block"):
        cncplan.plan_blocks(line, mill)
    with pytest.raises(TypeError, match="blocks: expected what line, arc and curve make, got str"):
        cncplan.plan_blocks(["G1 X1"], mill)


@pytest.fixture
def slides():
    return Machine(axes=[Axis("X", velocity=80, acceleration=600, jerk=9000, travel=(0, 500)),
                         Axis("Y", velocity=50, acceleration=500, jerk=6000)], **LIMITS)


def test_move_to(slides):
    move = cncplan.move_to([10, 0], [310, -20], slides)
    # X from rest to rest: L/v + v/a + a/j.
    assert move.duration == pytest.approx(300 / 80 + 80 / 600 + 600 / 9000, rel=1e-12)
    assert move.durations == pytest.approx([move.duration] * 2)
    end = move.at(move.duration)
    assert end.position == pytest.approx([310, -20]) and end.velocity == pytest.approx([0, 0], abs=1e-9)
    h = 1e-6
    times = np.linspace(0.01, move.duration - 0.01, 500)
    a, b, c = move.at(times - h), move.at(times), move.at(times + h)
    assert np.abs((c.position - a.position) / (2 * h) - b.velocity).max() < 1e-5
    assert np.abs((c.velocity - a.velocity) / (2 * h) - b.acceleration).max() < 0.05
    assert np.abs(b.velocity).max() <= 80 * (1 + 1e-9) and np.abs(b.acceleration).max() <= 600 * (1 + 1e-9)
    alone = cncplan.move_to([10, 0], [310, -20], slides, synchronization="none")
    assert alone.durations[1] < alone.durations[0] == pytest.approx(move.duration)
    assert cncplan.move_to([10, 0], [310, -20], slides, minimum_duration=9).duration == pytest.approx(9)


def test_move_from_motion_and_velocity(slides):
    start = State([10, 0], [40, 5], [100, 0])
    move = cncplan.move_to(start, State([200, 3], [20, 0]), slides)
    assert move.at(0).velocity == pytest.approx([40, 5]) and move.at(0).acceleration == pytest.approx([100, 0])
    assert move.at(move.duration).velocity == pytest.approx([20, 0])
    stop = cncplan.reach_velocity(start, [0, 0], slides)
    assert stop.at(stop.duration).velocity == pytest.approx([0, 0], abs=1e-9)
    with pytest.raises(cncplan.Error):
        cncplan.move_to([10, 0], [501, 0], slides)  # beyond the travel
    with pytest.raises(cncplan.Error):
        cncplan.reach_velocity(State([499, 0], [80, 0]), [0, 0], slides)
    with pytest.raises(cncplan.Error) as caught:
        cncplan.move_to([0, 0, 0], [1, 1, 1], Machine(**LIMITS))  # axes without limits
    assert caught.value.code == "not_finite"
    with pytest.raises(TypeError, match="position of start: expected an array of 2 numbers, got str"):
        cncplan.move_to("here", [0, 0], slides)


def test_states_of_other_programs(shared):
    """Times of Ruckig for one axis."""
    with open(shared / "data/states_1axis.csv") as file:
        names = file.readline().strip().split(",")
        rows = [dict(zip(names, map(float, line.split(",")))) for line in (file.readline() for _ in range(200))]
    assert len(rows) == 200
    compared = 0
    for row in rows:
        machine = Machine(axes=[Axis("X", velocity=row["V0"], acceleration=row["A0"], jerk=row["J0"]),
                                Axis("Y", velocity=1, acceleration=1, jerk=1)])
        move = cncplan.move_to(State([row["p0"], 0], [row["v0"], 0], [row["a0"], 0]),
                               State([row["pt0"], 0], [row["vt0"], 0], [row["at0"], 0]), machine)
        # A start beyond the limits comes back to them in another way.
        if abs(row["a0"]) <= row["A0"] and abs(row["v0"] + row["a0"] * abs(row["a0"]) / (2 * row["J0"])) <= row["V0"] \
                and abs(row["v0"]) <= row["V0"]:
            compared += 1
            assert move.duration == pytest.approx(row["duration"], rel=1e-9)
    assert compared > 50


def test_profile():
    made = cncplan.profile(100, velocity=30, acceleration=200, jerk=10000)
    # v/a > a/j: the ramps hold the acceleration.
    assert made.duration == pytest.approx(100 / 30 + 30 / 200 + 200 / 10000, rel=1e-12)
    phases = made.phases
    assert len(phases) == 7 and phases["duration"].sum() == pytest.approx(made.duration)
    assert phases["jerk"].tolist() == [10000, 0, -10000, 0, -10000, 0, 10000]
    state = made.at(np.linspace(0, made.duration, 1001))
    assert state.v.max() == 30 and np.abs(state.a).max() == pytest.approx(200) and state.s[-1] == 100
    assert made.at(0.01).j == 10000 and isinstance(made.at(0.01).s, float)
    five = cncplan.profile(100, velocity=30, acceleration=200, jerk=10000, phases=5)
    # The jerk is lowered such that the ramp peaks at the limit: 2 v/a each, and half of that is lost.
    assert five.duration == pytest.approx(100 / 30 + 2 * 30 / 200, rel=1e-12)
    with pytest.raises(cncplan.Error) as caught:
        cncplan.profile(1, 0, 30, velocity=30, acceleration=200, jerk=10000)
    assert caught.value.code == "end_speed_unreachable"
    with pytest.raises(cncplan.Error):
        cncplan.profile(-1, velocity=30, acceleration=200, jerk=10000)
    with pytest.raises(cncplan.Error):
        cncplan.profile(1, velocity=30, acceleration=200, jerk=10000, phases=3)


WRONG = "F600\nG1 X10\nG2 X20 Y0 R2\nG99 Q\nG1 Y5 K1\nX30\nG1 Z-5000\nG2 X0 I1 J1\nM30\n"


def test_all_problems():
    machine = Machine(**LIMITS, axes=[Axis("X"), Axis("Y"), Axis("Z", travel=(-100, 100))])
    program = cncplan.read_program(text=WRONG, machine=machine)
    found = {problem.line: problem for problem in program.problems}
    assert set(found) - {9} == {3, 4, 5, 7, 8}  # line 9 stops where line 7 went
    assert found[3].code == "chord_exceeds_diameter" and found[3].column == 11
    assert found[7].code == "below_limit" and found[7].bound == -100
    assert found[8].code == "radius_mismatch"
    assert all(isinstance(problem, cncplan.Error) for problem in program.problems)
    assert len(cncplan.read_program(text=WRONG, machine=machine, most_problems=2).problems) == 2
    with pytest.raises(cncplan.Error) as caught:
        cncplan.plan_text(WRONG, machine)
    assert str(caught.value) == str(program.problems[0])
    with pytest.raises(cncplan.Error):
        cncplan.write_gcode(program)


def test_motions_of_a_program():
    program = cncplan.read_program(text="G21 F600\nG0 X1 Y2\nG1 X11\nG3 X21 Y12 I0 J10 F1200\nM3 S500\nM30\n")
    assert not program.problems and program.lines == 6
    motions = program.motions
    assert motions["kind"].tolist() == ["rapid", "line", "arc"] and motions["line"].tolist() == [2, 3, 4]
    assert motions["start"].tolist() == [[0, 0, 0], [1, 2, 0], [11, 2, 0]]
    assert motions["end"][-1] == pytest.approx([21, 12, 0]) and motions["center"][-1] == pytest.approx([11, 12, 0])
    assert motions["radius"][-1] == pytest.approx(10) and motions["sweep"][-1] == pytest.approx(math.pi / 2)
    assert motions["feed"][1:].tolist() == [10, 20] and math.isnan(motions["feed"][0])
    assert [f"{w['letter']}{w['number']:g}" for w in program.words] == ["S500", "M3", "M30"]


@pytest.mark.parametrize("name", ["short_lines.ngc", "pocket.ngc", "kk22_figure7.ngc"])
def test_written_program_is_the_program(tmp_path, mill, name):
    source = cncplan.read_program(ROOT / "examples/programs" / name, mill)
    text = cncplan.write_gcode(source, path=tmp_path / "again.ngc")
    assert (tmp_path / "again.ngc").read_text() == text
    again = cncplan.read_program(text=text, machine=mill)
    assert not again.problems
    for field in ("kind", "start", "end", "length"):
        if field == "kind":
            assert again.motions[field].tolist() == source.motions[field].tolist()
        else:
            assert again.motions[field] == pytest.approx(source.motions[field], abs=1e-9)


def test_written_blocks(mill):
    blocks = [cncplan.line([0, 0, 0], [10, 0, 0], rapid=True), cncplan.line([10, 0, 0], [10, 5, 0], feed=10, pause=0.25),
              cncplan.arc([10, 5, 0], [0, 15, 0], center=[0, 5, 0], feed=20),
              cncplan.arc([0, 15, 0], [10, 25, 0], radius=10, clockwise=True, feed=20)]
    text = cncplan.write_gcode(blocks, mill)
    assert cncplan.plan_text(text, mill).duration == pytest.approx(cncplan.plan_blocks(blocks, mill).duration, abs=1e-9)
    with pytest.raises(cncplan.Error):
        cncplan.write_gcode(cncplan.curve([[0, 0, 0], [1, 1, 0], [2, 0, 0]]), mill)
    with pytest.raises(TypeError):
        cncplan.write_gcode(blocks)


def largest(motion, machine_limits):
    """Shares of the limits of each axis, by differences of positions."""
    t = np.linspace(0, motion.duration, 20001)
    p = motion.at(t).position
    step = t[1]
    return [(np.abs(np.diff(p, order, axis=0)).max(axis=0) / step**order / limit).max()
            for order, limit in enumerate(machine_limits, 1)]


def test_time_optimal_on_a_line_is_the_profile(mill):
    motion = cncplan.time_optimal([[0, 0, 0], [30, 40, 0]], mill)
    alone = cncplan.profile(50, velocity=LIMITS["velocity"], acceleration=LIMITS["acceleration"], jerk=LIMITS["jerk"])
    assert motion.duration == pytest.approx(alone.duration, rel=2e-3) and motion.duration >= alone.duration * (1 - 1e-9)
    assert motion.parameters.tolist() == [0, 50]
    end = motion.at(motion.duration)
    assert np.allclose(end.position, [30, 40, 0], atol=1e-9) and np.allclose(end.velocity, 0, atol=1e-6)
    assert motion.phases["duration"].sum() == pytest.approx(motion.duration)


def test_time_optimal_of_joints():
    joints = [Axis(letter, velocity=180, acceleration=720, jerk=7200) for letter in "ABC"]
    slides = [Axis(letter, velocity=200, acceleration=2000, jerk=20000) for letter in "XYZ"]
    arm = Machine(axes=slides + joints)
    print(f"CNCPLAN_SEED={SEED}")  # pytest shows it where the test fails
    rng = np.random.default_rng(SEED)
    points = np.cumsum(rng.uniform(-1, 1, (9, 6)) * [40, 40, 40, 1, 1, 1], axis=0)
    at = np.cumsum(rng.uniform(0.5, 2, 9))
    motion = cncplan.time_optimal(points, arm, parameters=at)
    limits = [np.array([200] * 3 + [math.radians(180)] * 3), np.array([2000] * 3 + [math.radians(720)] * 3),
              np.array([20000] * 3 + [math.radians(7200)] * 3)]
    shares = largest(motion, limits)
    assert max(shares) < 1 + 1e-3 and max(shares) > 0.98
    assert motion.parameters == pytest.approx(at - at[0])
    alone = cncplan.time_optimal(points, velocity=limits[0], acceleration=limits[1], jerk=limits[2], parameters=at)
    assert alone.duration == pytest.approx(motion.duration, rel=1e-9)
    # It goes through each of its points.
    t = np.linspace(0, motion.duration, 200001)
    u, p = motion.along(t).s, motion.at(t).position
    for knot, point in zip(motion.parameters, points, strict=True):
        assert np.abs(p[np.searchsorted(u, knot).clip(max=len(u) - 1)] - point).max() < 1e-2
    # A looser limit costs no time, and half of the velocity does.
    faster = Machine(axes=slides + [Axis(letter, velocity=180, acceleration=720, jerk=14400) for letter in "ABC"])
    assert cncplan.time_optimal(points, faster, parameters=at).duration < motion.duration * 1.001
    slower = Machine(axes=slides + [Axis(letter, velocity=20, acceleration=720, jerk=7200) for letter in "ABC"])
    assert cncplan.time_optimal(points, slower, parameters=at).duration > motion.duration * 1.1


def test_time_optimal_begins_and_ends_at_speeds(mill):
    points = [[0, 0, 0], [10, 4, 0], [20, 0, 1], [30, 5, 0]]
    rests = cncplan.time_optimal(points, mill)
    moves = cncplan.time_optimal(points, mill, start=5, end=8)
    assert moves.duration < rests.duration
    assert moves.along(0).v == pytest.approx(5) and moves.along(moves.duration).v == pytest.approx(8)


def test_time_optimal_of_any_number_of_axes():
    for axes in (1, 2, 7, 9):
        points = np.linspace(0, 1, 4)[:, None] * np.ones(axes)  # a straight line, all axes alike
        motion = cncplan.time_optimal(points, velocity=2, acceleration=[10] * axes, jerk=100)
        alone = cncplan.profile(1, velocity=2, acceleration=10, jerk=100)
        assert alone.duration * (1 - 1e-9) <= motion.duration < alone.duration * 1.003
        assert motion.at(motion.duration).position == pytest.approx(np.ones(axes))
        assert motion.at([0, 0.1]).velocity.shape == (2, axes)


def test_time_optimal_refuses(mill):
    line = [[0, 0, 0], [1, 0, 0]]
    for limits in ({}, {"velocity": 1}, {"machine": mill, "velocity": 1, "acceleration": 1, "jerk": 1}):
        with pytest.raises(TypeError):
            cncplan.time_optimal(line, **limits)
    for wrong in (0, -1, math.nan, [1, 1]):
        with pytest.raises(cncplan.Error):
            cncplan.time_optimal(line, velocity=wrong, acceleration=1, jerk=1)
    with pytest.raises(cncplan.Error):
        cncplan.time_optimal(np.zeros((3, 10)), velocity=1, acceleration=1, jerk=1)
    for points, code in (([[0, 0, 0]], "below_limit"), ([[0, 0, 0], [0, 0, 0]], "not_positive")):
        with pytest.raises(cncplan.Error) as caught:
            cncplan.time_optimal(points, mill)
        assert caught.value.code == code
    for parameters in ([0, 0], [1, 0]):
        with pytest.raises(cncplan.Error):
            cncplan.time_optimal([[0, 0, 0], [1, 0, 0]], mill, parameters=parameters)
    with pytest.raises(cncplan.Error):
        cncplan.time_optimal([[0, 0, 0], [1, 0, 0]], mill, start=1e6)
    with pytest.raises(cncplan.Error):
        cncplan.time_optimal([[0, 0, 0], [1, 0, 0]], mill, gap=0)
    with pytest.raises(cncplan.Error):
        cncplan.time_optimal([[0, 0, 0, 0], [0, 0, 0, 1]],
                             Machine(**LIMITS, axes=[Axis("X"), Axis("Y"), Axis("Z"), Axis("A")]))  # A has no limits
    with pytest.raises(TypeError):
        cncplan.time_optimal("points", mill)
    with pytest.raises(cncplan.Error):
        cncplan.time_optimal([[0, 0], [1, 0]], mill)
