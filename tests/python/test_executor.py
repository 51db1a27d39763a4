"""A controller in a loop: it ends where the plan ends, keeps the limits, and takes every request."""

import math

import numpy as np
import pytest
from conftest import LEVELS, LIMITS

import cncplan
from cncplan import Axis, Machine

PROGRAM = ["G21 G90 F1200", "M3 S1000", "G1 X20", "G3 X25 Y5 R5", "G1 Y15", "G4 P0.2", "G1 X0 Y0", "M30"]


@pytest.fixture
def mill():
    limits = {"velocity": 50, "acceleration": 800, "jerk": 8000}
    return Machine(**LIMITS, axes=[Axis("X", **limits), Axis("Y", **limits), Axis("Z", **limits)])


def run(executor, program=PROGRAM, at_tick=None, period=0.001):
    points = []

    def tick():
        if at_tick is not None:
            at_tick(len(points), executor)
        points.append(executor.tick(period))

    for item in program:
        while not executor.push(item):
            tick()
    executor.end_of_program()
    while not executor.finished:
        tick()
        assert len(points) < 100000
    return points


def test_undisturbed_it_is_the_plan(mill):
    points = run(cncplan.Executor(mill))
    planned = cncplan.plan_text("\n".join(PROGRAM), mill, level="fast")
    assert points[-1].t == pytest.approx(planned.duration, abs=0.002)
    for point in points[::50]:
        assert point.position == pytest.approx(planned.at(point.t).position, abs=1e-3)
    words = [(letter, number) for point in points for letter, number, *_ in point.words]
    assert words == [("S", 1000), ("M", 3), ("M", 30)]
    assert points[0].position.shape == (3,) and points[-1].position == pytest.approx([0, 0, 0], abs=1e-9)


@pytest.mark.parametrize("level", LEVELS)
def test_every_level(mill, level):
    points = run(cncplan.Executor(mill, level=level))
    planned = cncplan.plan_text("\n".join(PROGRAM), mill, level=level)
    # What good and best keep for holds takes some time.
    assert planned.duration - 0.002 <= points[-1].t <= planned.duration * (1.15 if level in ("good", "best") else 1) + 0.002
    words = [(letter, number) for point in points for letter, number, *_ in point.words]
    assert words == [("S", 1000), ("M", 3), ("M", 30)]
    assert points[-1].position == pytest.approx([0, 0, 0], abs=1e-9)
    if level == "exact":
        return  # corners are passed with jumps of the velocity
    for vector, limit in (("velocity", 30), ("acceleration", 1000), ("jerk", 10000)):
        assert np.linalg.norm([getattr(point, vector) for point in points], axis=1).max() <= limit * (1 + 1e-6)
    velocity = np.array([point.velocity for point in points])
    position = np.array([point.position for point in points])
    assert np.abs((position[2:] - position[:-2]) / 0.002 - velocity[1:-1]).max() < 10000 * 0.001**2


def test_the_longest_hold_is_told_where_it_is_planned(mill):
    for level, factor, told in (("fast", 1.5, False), ("good", 0, False), ("good", 1.5, True), ("best", 1.5, True)):
        executor = cncplan.Executor(mill, level=level, hold_factor=factor)
        assert executor.worst_hold is None
        for text in PROGRAM:
            assert executor.push(text)
        executor.end_of_program()
        for _ in range(300):
            executor.tick(0.001)
        assert (executor.worst_hold is not None) == told
        if not told:
            continue
        executor.feed_hold()
        ticks = 0
        while executor.state != "held":
            executor.tick(0.001)
            ticks += 1
        assert ticks * 0.001 <= executor.worst_hold + 0.002 < 0.5


@pytest.mark.parametrize("level", LEVELS)
def test_requests_at_every_level(mill, level):
    executor = cncplan.Executor(mill, level=level, reserve=0.1)
    for text in PROGRAM:
        assert executor.push(text)
    executor.end_of_program()
    for _ in range(300):
        executor.tick(0.001)
    executor.feed_hold()
    for _ in range(400):
        point = executor.tick(0.001)
    assert executor.state == "held" and not point.velocity.any()
    executor.resume()
    executor.feed_override(0.5)
    for _ in range(300):
        point = executor.tick(0.001)
    assert executor.state == "moving" and 0 < np.linalg.norm(point.velocity) <= 15 * (1 + 1e-6)
    executor.reverse()
    for _ in range(4000):
        point = executor.tick(0.001)
    assert point.position == pytest.approx([0, 0, 0], abs=1e-9)
    executor.reverse(False)
    for _ in range(300):
        executor.tick(0.001)
    executor.stop()
    while not executor.finished:
        point = executor.tick(0.001)
    assert executor.restart(3, point.position)
    points = run(executor)
    assert points[-1].position == pytest.approx([0, 0, 0], abs=1e-9) and executor.error is None


def test_hold_override_and_limits(mill):
    def ask(tick, executor):
        if tick == 300:
            executor.feed_hold()
        if tick == 700:
            executor.resume()
            executor.feed_override(0.5)
        if tick == 1200:
            executor.feed_override(2)

    points = run(cncplan.Executor(mill), at_tick=ask)
    velocity = np.array([point.velocity for point in points])
    assert np.linalg.norm(velocity[600:700], axis=1).max() == 0
    speed = np.linalg.norm(velocity, axis=1)
    assert speed.max() <= 30 * (1 + 1e-9)
    assert np.linalg.norm([p.acceleration for p in points], axis=1).max() <= 1000 * (1 + 1e-6)
    assert np.linalg.norm([p.jerk for p in points], axis=1).max() <= 10000 * (1 + 1e-6)
    position = np.array([point.position for point in points])
    assert np.abs((position[2:] - position[:-2]) / 0.002 - velocity[1:-1]).max() < 10000 * 0.001**2


def test_stop_jog_and_restart(mill):
    executor = cncplan.Executor(mill)
    for text in PROGRAM[:5]:
        assert executor.push(text)
    executor.end_of_program()
    with pytest.raises(cncplan.Error):
        for _ in range(100):
            executor.tick(0.001)
        executor.jog([1, 0, 0])  # a program moves the axes
    for _ in range(300):
        executor.tick(0.001)
    executor.stop()
    while not executor.finished:
        point = executor.tick(0.001)
    place = point.position
    assert 0 < place[0] < 20
    executor.jog_to([5, 5, 5])
    for _ in range(5000):
        point = executor.tick(0.001)
    assert point.position == pytest.approx([5, 5, 5])
    executor.jog_to(place)
    for _ in range(5000):
        point = executor.tick(0.001)
    assert executor.restart(3, place)
    points = run(executor)
    assert points[-1].position == pytest.approx([0, 0, 0], abs=1e-9)
    assert np.linalg.norm(points[0].position - place) < 0.05


def test_every_request_can_be_made(mill):
    executor = cncplan.Executor(mill, longest_wait=0.01, quick_stop_share=4)
    for text in PROGRAM[:5]:
        executor.push(text)
    executor.push(cncplan.line([25, 15, 0], [25, 20, 0], feed=10))
    executor.end_of_program()
    executor.optional_stop(True)
    executor.program_stop(True)
    executor.single_step(True)
    executor.single_step(False)
    executor.pause_at(5)
    executor.rapid_override(0.5)
    assert executor.pushed > 3 and executor.until_change > 0 and executor.rested >= 0
    for _ in range(3000):
        point = executor.tick(0.001)
    assert point.position == pytest.approx([25, 5, 0], abs=0.02)  # before line 5
    executor.resume()
    for _ in range(100):
        executor.tick(0.001)
    executor.reverse()
    for _ in range(3000):
        point = executor.tick(0.001)
    assert point.position == pytest.approx([0, 0, 0], abs=1e-9)
    executor.reverse(False)
    for _ in range(500):
        executor.tick(0.001)
    executor.quick_stop()
    for _ in range(1000):
        executor.tick(0.001)
    executor.resume()
    for _ in range(4000):
        point = executor.tick(0.001)
    assert executor.finished and executor.error is None
    assert point.position == pytest.approx([25, 20, 0]) and executor.time == point.t
    executor.jog([10, 0, 0])
    for _ in range(500):
        point = executor.tick(0.001)
    assert point.velocity == pytest.approx([10, 0, 0])
    executor.jog([0, 0, 0])
    executor.return_to_path()


def test_state(mill):
    executor = cncplan.Executor(mill)
    seen = [executor.state]

    def tick(count=1):
        for _ in range(count):
            executor.tick(0.001)
            if executor.state != seen[-1]:
                seen.append(executor.state)

    for text in ["G1 F1200 X10", "G4 P0.3", "X0", "M0", "X5"]:
        executor.push(text)
    executor.end_of_program()
    tick(200)
    executor.feed_hold()
    tick(500)
    executor.resume()
    tick(1500)
    executor.resume()
    tick(2000)
    executor.jog([10, 0, 0])
    tick(300)
    executor.jog([0, 0, 0])
    tick(300)
    assert seen == ["waiting", "moving", "holding", "held", "moving", "dwelling", "moving", "stopped", "moving",
                    "finished", "jogging", "away"]


def test_many_lines_come_in_by_and_by(mill):
    lines = ["G1 F1800"] + [f"X{i / 10} Y{math.sin(i / 5):.4f}" for i in range(1000)]
    executor = cncplan.Executor(mill)
    points = run(executor, lines, period=0.01)
    assert points[-1].position == pytest.approx([99.9, round(math.sin(999 / 5), 4), 0])


def test_cycles_of_many_blocks(mill):
    points = run(cncplan.Executor(mill), ["G81 X5 Y5 Z-2 R1 F600 L3 G91", "G80", "M2"], period=0.01)
    depth = np.array([point.position[2] for point in points])
    assert depth.min() == pytest.approx(-1, abs=1e-3)
    assert ((depth[1:] < -0.9) & (depth[:-1] >= -0.9)).sum() == 3


def test_compensated_motions_come_to_their_end(mill):
    machine = Machine(**LIMITS, tools={1: {"length": 0, "diameter": 4}})
    lines = ["F1200", "T1 M6", "G42 G1 X10 Y2 D1", "X40", "Y20"]  # the last motion is held back until the end is known
    points = run(cncplan.Executor(machine), lines)
    planned = cncplan.plan_text("\n".join(lines), machine)
    assert points[-1].position == pytest.approx(planned.at(planned.duration).position, abs=1e-9)
    assert points[-1].position[1] == pytest.approx(20, abs=1e-9)


def test_a_line_behind_the_end_is_refused(mill):
    executor = cncplan.Executor(mill)
    executor.push("G1 X1 F600")
    executor.end_of_program()
    with pytest.raises(cncplan.Error, match="behind the end"):
        executor.push("X2")


def test_errors(mill):
    executor = cncplan.Executor(mill)
    with pytest.raises(cncplan.Error) as caught:
        executor.push("G1 X??")
    assert caught.value.line == 1 and caught.value.column == 4
    with pytest.raises(TypeError, match=r"item: expected a line \(str\) or a block, got int"):
        executor.push(3)
    with pytest.raises(cncplan.Error, match="more than one line"):
        executor.push("G1 X1\nG1 X2")
    for period in (0, -1, math.nan, math.inf):
        with pytest.raises(cncplan.Error) as caught:
            executor.tick(period)
        assert caught.value.field == "period"
    with pytest.raises(TypeError, match="period: expected a number, got str"):
        executor.tick("1 ms")
    with pytest.raises(TypeError, match="wanted: expected True or False, got int"):
        executor.reverse(1)
    with pytest.raises(cncplan.Error):
        executor.jog([1, 2])
    for wrong in ({"tolerance": -1}, {"level": "better"}, {"reserve": 1}, {"reserve": -0.1}, {"hold_factor": 1},
                  {"longest_wait": -1}, {"most_override": 0.5}, {"horizon": 0}):
        with pytest.raises(cncplan.Error):
            cncplan.Executor(mill, **wrong)


@pytest.mark.parametrize("level", ["exact", "fast", "good", "best"])
@pytest.mark.parametrize("most", [1.0, 2.0, 2.5])
def test_an_override_is_cut_at_the_highest(mill, level, most):
    executor = cncplan.Executor(mill, level=level, most_override=most, horizon=1.0)
    executor.push("F600 G1 X40")
    executor.end_of_program()
    executor.feed_override(7)
    top = 0.0
    while not executor.finished:
        top = max(top, np.linalg.norm(executor.tick(0.001).velocity))
    assert top == pytest.approx(10 * most, rel=1e-3)


def test_a_block_that_cannot_be_planned_is_told(mill):
    executor = cncplan.Executor(mill)
    executor.push(cncplan.line([0, 0, 0], [5, 0, 0], feed=10))
    executor.push(cncplan.line([7, 0, 0], [9, 0, 0], feed=10))
    executor.end_of_program()
    for _ in range(5000):
        executor.tick(0.001)
    assert executor.finished and executor.error.code == "discontinuous"


def test_jog_at_a_speed_and_by_increments(mill):
    executor = cncplan.Executor(mill)
    executor.jog_to([3, 4, 0], tool_speed=5)
    points = [executor.tick(0.001) for _ in range(2000)]
    assert max(np.linalg.norm(point.velocity) for point in points) == pytest.approx(5)
    assert points[-1].position.tolist() == [3, 4, 0]
    executor.jog_to([0, 0, 0], [2, 1, 1])
    points = [executor.tick(0.001) for _ in range(6000)]
    assert np.abs([point.velocity for point in points]).max(axis=0)[1] == pytest.approx(1)
    for _ in range(3):  # faster than it moves
        executor.jog_by([1, 0, 0])
        executor.tick(0.001)
    assert [executor.tick(0.001) for _ in range(2000)][-1].position == pytest.approx([3, 0, 0])
    with pytest.raises(cncplan.Error, match="speed of a jog"):
        executor.jog_by([1, 0, 0], tool_speed=0)


def test_jog_of_a_machine_without_axes():
    executor = cncplan.Executor(cncplan.Machine(velocity=30, acceleration=1000, jerk=10000))
    executor.jog_to([5, 0, 0])
    for _ in range(2000):
        point = executor.tick(0.001)
    assert list(point.position) == [5, 0, 0]


def test_a_word_has_its_instant_and_a_set_point_the_feed(mill):
    told = {}
    for period in (0.05, 0.0001):
        executor = cncplan.Executor(mill)
        for line in ("F600", "G1 X5", "M8", "X10"):
            assert executor.push(line)
        executor.end_of_program()
        told[period] = []
        while not executor.finished:
            point = executor.tick(period)
            told[period] += [point.t - period + in_tick for _, _, in_tick, *_ in point.words]
            if point.v > 0:
                assert point.feed == pytest.approx(10)
    assert told[0.05] == pytest.approx(told[0.0001], abs=2e-4)
