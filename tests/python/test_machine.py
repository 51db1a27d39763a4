"""Machines from keywords, dicts and files."""

import copy
import math
import pickle

import numpy as np
import pytest
from conftest import LIMITS, ROOT

import cncplan
from cncplan import Axis, Machine

TURN = "G1 A180 F3600\n"


def test_forms_are_equal(tmp_path):
    axes = [{"letter": "X", "velocity": 20, "travel": [0, 100]}, {"letter": "Y"}, {"letter": "Z"}]
    file = tmp_path / "mill.toml"
    file.write_text('[[axis]]\nletter = "X"\nvelocity = 20\ntravel = [0, 100]\n[[axis]]\nletter = "Y"\n[[axis]]\nletter = "Z"\n')
    machines = [Machine(file, **LIMITS), Machine({"axis": axes, **LIMITS}), Machine({"axis": axes}, **LIMITS),
                Machine(**LIMITS, axes=[Axis("X", velocity=20, travel=(0, 100)), Axis("Y"), {"letter": "Z"}])]
    durations = {cncplan.plan_text("G1 X50 Y3", machine).duration for machine in machines}
    assert len(durations) == 1
    for machine in machines:
        assert machine.letters == "XYZ" and machine.rotary == (False,) * 3 and len(machine) == 3
        with pytest.raises(cncplan.Error) as caught:
            cncplan.plan_text("G1\nX150", machine)
        assert (caught.value.code, caught.value.field, caught.value.value, caught.value.bound) == ("above_limit", "axis X", 150, 100)


def test_machines_go_to_other_processes(tmp_path):
    file = tmp_path / "mill.toml"
    file.write_text('[[axis]]\nletter = "X"\nvelocity = 20\n[[axis]]\nletter = "Y"\n')
    machine = Machine(file, **LIMITS)
    file.unlink()
    for again in (pickle.loads(pickle.dumps(machine)), copy.deepcopy(machine), copy.copy(machine)):
        assert repr(again) == repr(machine) and again.letters == "XY"
        assert cncplan.plan_text("G1 X50 Y3", again).duration == cncplan.plan_text("G1 X50 Y3", machine).duration


def test_rotary_axes_are_degrees():
    machine = Machine(**LIMITS, axes=[Axis("X"), Axis("Y"), Axis("Z"), Axis("A", velocity=36, acceleration=3600, jerk=72000)])
    assert machine.rotary == (False, False, False, True)
    trajectory = cncplan.plan_text(TURN, machine)
    # 36 deg/s over 180 degrees by jerk alone: L/v + 2 sqrt(v/j).
    assert trajectory.duration == pytest.approx(180 / 36 + 2 * math.sqrt(36 / 72000), rel=1e-9)
    samples = trajectory.sample(0.01)
    assert samples.position.shape[1] == 4 and samples.position[-1, 3] == pytest.approx(math.pi)
    assert np.abs(samples.velocity[:, 3]).max() == pytest.approx(math.radians(36))


@pytest.mark.parametrize("letters", ["X", "XY", "XYZ", "XYZA", "XYZAB", "XYZABC", "XYZABCU", "XYZABCUV", "XYZABCUVW"])
def test_any_number_of_axes(letters):
    machine = Machine(**LIMITS, axes=[Axis(letter, velocity=25, acceleration=500, jerk=5000) for letter in letters]) \
        if len(letters) > 1 else None
    if machine is None:
        with pytest.raises(cncplan.Error):  # as in a machine file
            Machine(**LIMITS, axes=[Axis("X")])
        return
    trajectory = cncplan.plan_text("G1 F6000 " + " ".join(f"{letter}10" for letter in letters), machine)
    samples = trajectory.sample(0.01)
    assert samples.jerk.shape == (len(samples), len(letters))
    end = [math.radians(10) if letter in "ABC" else 10 for letter in letters]
    assert samples.position[-1] == pytest.approx(end)
    assert trajectory.at(0.1).velocity.shape == (len(letters),)
    assert len(trajectory.step_edges())


def test_two_axes_have_arcs():
    machine = Machine(**LIMITS, axes=[Axis("X"), Axis("Y")])
    trajectory = cncplan.plan_text("G2 X10 Y10 R10 F600", machine)
    assert trajectory.length == pytest.approx(5 * math.pi)
    with pytest.raises(cncplan.Error, match="axis Z"):
        cncplan.plan_text("G1 Z1 F600", machine)


def test_files_of_examples():
    assert Machine(ROOT / "examples/machines/mill3.toml", **LIMITS).letters == "XYZ"
    assert Machine(str(ROOT / "examples/machines/card2.toml"), **LIMITS).letters == "XY"
    with pytest.raises(cncplan.Error, match="rows of their four axes"):
        Machine(ROOT / "examples/machines/tire_mold.toml", **LIMITS)


def test_other_entries():
    machine = Machine(**LIMITS, dialect="grbl", unit="inch", tools={1: 2.0, "2": {"length": 1, "diameter": 0.5}},
                      offsets={"G55": [1, 0, 0]}, home={"G28": [0, 0, 1]}, pass_through=["M62"], rapid_rate=1, feed_limit=1)
    assert cncplan.plan_text("G55 G1 X0 F6000", machine).length == pytest.approx(25.4)


@pytest.mark.parametrize("make, code, text", [
    (lambda: Machine(velocity=-1), "not_positive", "velocity limit"),
    (lambda: Machine(velocity=math.nan), "not_finite", "velocity limit"),
    (lambda: Machine(**LIMITS, axes=[Axis("X", velocity=0)]), "malformed", "greater than zero"),
    (lambda: Machine(**LIMITS, axes=[Axis("X", velocity=math.inf)]), "not_finite", "finite"),
    (lambda: Machine(**LIMITS, axes=[Axis("X", speed=3)]), "malformed", "unknown key 'speed'"),
    (lambda: Machine(**LIMITS, axes=[Axis("X", travel=[3, 1])]), "malformed", "travel"),
    (lambda: Machine(**LIMITS, axes=[Axis("Q"), Axis("Y")]), "malformed", "axes must be"),
    (lambda: Machine(**LIMITS, axes=[]), "malformed", "axis"),
    (lambda: Machine(**LIMITS, colour="red"), "malformed", "unknown key 'colour'"),
    (lambda: Machine(**LIMITS, dialect="heidenhain"), "malformed", "dialect"),
    (lambda: Machine({"velocity": 3}, velocity=4), "duplicate", "twice"),
    (lambda: Machine("/nowhere/mill.toml"), "unreadable", "cannot be read"),
    (lambda: Machine("/"), "unreadable", "cannot be read"),
    (lambda: Machine("mill.toml", rapid_rate=3), "conflicting_words", "machine file"),
])
def test_errors(make, code, text):
    with pytest.raises(cncplan.Error) as caught:
        make()
    assert caught.value.code == code and text in str(caught.value)
    assert caught.value.line is None  # of a machine file alone


def test_place_of_an_error_in_a_file(tmp_path):
    file = tmp_path / "mill.toml"
    file.write_text("unit = \"mm\"\nrapid_rate = -3\n")
    with pytest.raises(cncplan.Error) as caught:
        Machine(file, **LIMITS)
    assert (caught.value.line, caught.value.column, caught.value.file) == (2, 14, str(file))
    file.write_text("unit = \n")
    with pytest.raises(cncplan.Error) as caught:
        Machine(file, **LIMITS)
    assert caught.value.line == 1


@pytest.mark.parametrize("make, text", [
    (lambda: Machine(velocity="fast"), "velocity: expected a number, got str"),
    (lambda: Machine(velocity=True), "velocity: expected a number, got bool"),
    (lambda: Machine(3), "source: expected a path, a dict or nothing, got int"),
    (lambda: Machine(axes="XYZ"), "axes: expected a list of Axis or dict, got str"),
    (lambda: Machine(axes=["X"]), "axes: expected an Axis or a dict, got str"),
    (lambda: Axis(3), "letter: expected a str, got int"),
])
def test_wrong_types(make, text):
    with pytest.raises(TypeError, match=text):
        make()
