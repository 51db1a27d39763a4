"""Machines whose axes are not the program's coordinates, by name."""

import json
import math
import subprocess

import numpy as np
import pytest
from conftest import LEVELS, LIMITS, ROOT

import cncplan
from cncplan import Axis, Machine


@pytest.fixture(autouse=True)
def maps():
    try:
        Machine(**LIMITS, kinematics="core-xy", axes=[Axis("A", "linear"), Axis("B", "linear"), Axis("Z")])
    except cncplan.Error as error:
        if "CNCPLAN_PYTHON_MAPS" in str(error):
            pytest.skip("the module is built without kinematics")
        raise


def scara(**more):
    turn = {"velocity": 100, "acceleration": 600, "jerk": 6000}
    return Machine(**LIMITS, kinematics="scara", lengths={"upper": 200, "fore": 150}, start=[0, 90, 0],
                   axes=[Axis("A", **turn), Axis("B", **turn), Axis("Z", velocity=100, acceleration=500, jerk=5000)], **more)


@pytest.mark.parametrize("level", LEVELS)
def test_an_arm_follows_a_line(level):
    machine = scara()
    assert machine.letters == "ABZ" and machine.coordinates == "XYZ" and machine.rotary == (True, True, False)
    trajectory = cncplan.plan_text("G1 X250 Y100 Z5 F1800", machine, level=level)
    points = trajectory.at(np.linspace(0, trajectory.duration, 200))
    q = points.position
    # Where the arm's joints bring the tool, and how far that is from the line.
    x = 200 * np.cos(q[:, 0]) + 150 * np.cos(q[:, 0] + q[:, 1])
    y = 200 * np.sin(q[:, 0]) + 150 * np.sin(q[:, 0] + q[:, 1])
    assert np.abs(points.tool - np.column_stack([x, y, q[:, 2]])).max() < 1e-9
    start, way = np.array([200.0, 150, 0]), np.array([50.0, -50, 5])
    off = points.tool - start
    assert np.linalg.norm(off - np.outer(off @ way / (way @ way), way), axis=1).max() < 0.01
    assert points.tool[-1] == pytest.approx([250, 100, 5], abs=1e-9)
    assert np.abs(points.velocity[:, :2]).max() <= math.radians(100) * (1 + 1e-9)
    assert trajectory.length == pytest.approx(math.sqrt(50**2 + 50**2 + 5**2))
    assert len(trajectory.step_edges()) > 100


def test_core_xy_is_a_sum():
    machine = Machine(**LIMITS, kinematics="core-xy", axes=[Axis("A", "linear"), Axis("B", "linear"), Axis("Z")])
    end = cncplan.plan_text("G1 X10 Y4 F600", machine).at(1e9)
    assert sorted(np.abs(end.position)) == pytest.approx([0, 6, 14]) and end.tool == pytest.approx([10, 4, 0])


def test_what_there_is_not():
    machine = scara()
    for call in (lambda: cncplan.Executor(machine), lambda: cncplan.plan_text("G1 X250 Y100 F600", machine).report("x.html"),
                 lambda: cncplan.plan_blocks([cncplan.line([0, 0, 0], [1, 0, 0])], machine),
                 lambda: cncplan.write_gcode(cncplan.read_program(text="G1 X250 Y100 F600", machine=machine))):
        with pytest.raises(cncplan.Error) as caught:
            call()
        assert caught.value.code == "not_supported"
    problems = cncplan.read_program(text="G1 X400 F600\nX250", machine=machine).problems
    assert [(problem.code, problem.line) for problem in problems][:1] == [("unreachable", 1)]
    with pytest.raises(cncplan.Error, match="lengths"):
        Machine(**LIMITS, kinematics="scara", axes=[Axis("A"), Axis("B"), Axis("Z")])


@pytest.mark.parametrize("level", ["fast", "best"])
def test_five_axes_equal_simulate(simulate, tmp_path, level):
    """The tip stays on the work while the table tilts; the program cncplan_simulate plans by the same library."""
    program = tmp_path / "part.ngc"
    program.write_text("G21 G90 F1200\nG43.4\nG1 X10 A20\nY8 C30\nX0 Y0 A0 C0\nG49\n")
    machine_file = ROOT / "examples/machines/table_table_ac.toml"
    done = subprocess.run([simulate, program, "--machine", machine_file, "--json", "--quiet", "--smooth", level], check=True,
                          capture_output=True, text=True)
    trajectory = cncplan.plan_file(program, Machine(machine_file, **LIMITS), level=level)
    assert trajectory.duration == json.loads(done.stdout)["time_s"]
    assert trajectory.at(trajectory.duration).tool == pytest.approx([0, 0, 0], abs=1e-9)
    assert trajectory.sample(0.01).position.shape[1] == 5


def test_a_rotary_table_equals_simulate(simulate, tmp_path):
    """Two slides and a table by their machine file; a path nearer to the table's axis than the file says is refused."""
    program = tmp_path / "square.ngc"
    program.write_text("G21 G90 F1200\nG1 X20\nY30\nX-20\nY0\n")
    machine_file = ROOT / "examples/machines/kk22.toml"
    done = subprocess.run([simulate, program, "--machine", machine_file, "--json", "--quiet", "--tolerance", "0"], check=True,
                          capture_output=True, text=True)
    machine = Machine(machine_file, **LIMITS)
    trajectory = cncplan.plan_file(program, machine, tolerance=0)
    assert trajectory.duration == json.loads(done.stdout)["time_s"]
    q = trajectory.at(trajectory.duration / 2)
    assert (q.position[0] * math.cos(q.position[2]) - 150, q.position[0] * math.sin(q.position[2])) == pytest.approx(q.tool[:2])
    problems = cncplan.read_program(text="G1 X-150 Y4 F600", machine=machine).problems
    assert [(problem.code, problem.field, problem.bound) for problem in problems] == [("below_limit", "axis Y", 5)]


def test_machine_files():
    assert Machine(ROOT / "examples/machines/table_table_ac.toml", **LIMITS).coordinates == "XYZAC"
