"""Plans: equal to cncplan_simulate's bit for bit, and right by closed forms and differences."""

import json
import math
import subprocess

import numpy as np
import pytest
from conftest import LEVELS, LIMITS, ROOT

import cncplan

SQUARE = "G21 G90 F1800\nG1 X20\nY20\nG3 X10 Y30 R10\nG1 X0 Y0\n"
# Each level, as an option of cncplan_simulate.
OPTIONS = {"exact": ["--tolerance", "0"], **{level: ["--smooth", level] for level in ("fast", "good", "best")}}


def simulated(program, path, tmp_path, *options, period="0.01"):
    samples = tmp_path / "samples.csv"
    done = subprocess.run([program, path, "--json", "--quiet", "--samples", samples, "--period", period, *options],
                          check=True, capture_output=True, text=True)
    return json.loads(done.stdout), np.loadtxt(samples, delimiter=",", skiprows=1, ndmin=2)


@pytest.mark.parametrize("level", LEVELS)
@pytest.mark.parametrize("name", ["short_lines.ngc", "pocket.ngc"])
def test_equals_simulate(simulate, tmp_path, mill, name, level):
    path = ROOT / "examples/programs" / name
    summary, table = simulated(simulate, path, tmp_path, *OPTIONS[level])
    trajectory = cncplan.plan_file(path, mill, tolerance=0.01, level=level)
    samples = trajectory.sample(0.01)
    assert trajectory.duration == summary["time_s"]
    assert np.array_equal(samples.t, table[:, 0])
    for column, values in enumerate((samples.s, samples.v, samples.a, samples.j), 4):
        assert np.array_equal(values + 0.0, table[:, column])
    if name == "short_lines.ngc":  # without work offsets: the table has work coordinates
        assert np.array_equal(samples.position + 0.0, table[:, 1:4])


@pytest.mark.parametrize("level", LEVELS)
@pytest.mark.parametrize("name", ["ball.nc", *(f"ngc/{name}.ngc" for name in (
    "3dtest", "51MeanderAve", "Cereal", "arcspiral", "cds", "lathe_pawn", "test_12mmflat", "tort"))])
def test_equals_simulate_on_programs_of_others(simulate, shared, tmp_path, mill, name, level):
    path = shared / "data" / name
    period = 0.05 if name == "ball.nc" else 0.01
    summary, table = simulated(simulate, path, tmp_path, *OPTIONS[level], period=str(period))
    trajectory = cncplan.plan_file(path, mill, tolerance=0.01, level=level)
    samples = trajectory.sample(period)
    assert trajectory.duration == summary["time_s"] and trajectory.length == summary["length_mm"]
    assert np.array_equal(samples.t, table[:, 0])
    for column, values in enumerate((samples.s, samples.v, samples.a, samples.j), 4):
        assert np.array_equal(values + 0.0, table[:, column])
    assert np.array_equal(samples.position + 0.0, table[:, 1:4])


def test_equals_simulate_on_a_machine_file(simulate, tmp_path):
    machine_file = ROOT / "examples/machines/mill3.toml"
    program = tmp_path / "part.ngc"
    program.write_text("G21 G90 F1800\nG0 X10 Y10 Z20\nG1 X30\nY40 F2400\nG4 P0.5\nG2 X20 Y30 R10\nM30\n")
    summary, table = simulated(simulate, program, tmp_path, "--machine", machine_file)
    trajectory = cncplan.plan_file(program, cncplan.Machine(machine_file, **LIMITS))
    assert trajectory.duration == summary["time_s"]
    assert len(trajectory.step_edges()) == sum(summary["steps"].values()) + summary["steps"]["Y"]  # Y has two motors
    assert np.array_equal(trajectory.sample(0.01).s, table[:, 4])


def test_csv_equals_simulate(simulate, tmp_path, mill):
    path = ROOT / "examples/programs/short_lines.ngc"
    table = tmp_path / "table.csv"
    subprocess.run([simulate, path, "--quiet", "--samples", table, "--period", "0.01", "--smooth", "good"], check=True)
    own = tmp_path / "own.csv"
    cncplan.plan_file(path, mill, level="good").to_csv(own, 0.01)
    assert own.read_text() == table.read_text()


@pytest.mark.parametrize("level", LEVELS)
def test_a_line_takes_its_time(mill, level):
    # Up to 30 mm/s by jerk alone: L/v + 2 sqrt(v/j).
    trajectory = cncplan.plan_text("G1 X100", mill, level=level)
    assert trajectory.duration == pytest.approx(100 / 30 + 2 * math.sqrt(30 / 10000), rel=1e-12)
    assert trajectory.length == 100
    end = trajectory.at(trajectory.duration)
    assert end.position.tolist() == [100, 0, 0] and end.velocity.tolist() == [0, 0, 0]


@pytest.mark.parametrize("level", LEVELS)
def test_derivatives_are_those_of_the_position(mill, level):
    trajectory = cncplan.plan_text(SQUARE, mill, level=level)
    h = 1e-5
    times = np.linspace(0.01, trajectory.duration - 0.01, 2001)
    middle, before, after = (trajectory.at(times + shift) for shift in (0, -h, h))
    smooth = np.ones(len(times), bool)
    if level == "exact":  # the velocity jumps at corners, from one instant to the next
        smooth = (before.block == after.block)
    for function, derivative, scale in (("position", "velocity", 30), ("velocity", "acceleration", 1000)):
        difference = (getattr(after, function) - getattr(before, function)) / (2 * h)
        error = np.abs(difference - getattr(middle, derivative))[smooth]
        assert error.max() <= 2e-2 * scale, function
    rows = smooth & (np.abs(before.j - after.j) < 1)
    difference = (after.acceleration - before.acceleration) / (2 * h)
    assert np.median(np.abs(difference - middle.jerk)[rows]) < 10


@pytest.mark.parametrize("level", ("fast", "good", "best"))
def test_limits_hold_and_the_path_is_kept(mill, level):
    samples = cncplan.plan_text(SQUARE, mill, level=level).sample(0.0005)
    assert np.linalg.norm(samples.velocity, axis=1).max() <= 30 * (1 + 1e-9)
    assert np.linalg.norm(samples.acceleration, axis=1).max() <= 1000 * (1 + 1e-9)
    assert np.linalg.norm(samples.jerk, axis=1).max() <= 10000 * (1 + 1e-6)
    x, y = samples.position[:, 0], samples.position[:, 1]
    far = np.minimum.reduce([
        np.where((x >= -0.01) & (x <= 20.01), np.abs(y), np.inf), np.where((y >= 0) & (y <= 20), np.abs(x - 20), np.inf),
        np.where(y >= 19.9, np.abs(np.hypot(x - 10, y - 20) - 10), np.inf), np.abs(3 * x - y) / math.sqrt(10)])
    assert far.max() <= 0.01 * (1 + 1e-6)


def test_higher_levels_take_no_longer(mill):
    text = SQUARE
    fast, good, best = (cncplan.plan_text(text, mill, level=level).duration for level in ("fast", "good", "best"))
    assert best <= good * (1 + 1e-9) and good <= fast * (1 + 1e-9)


@pytest.mark.parametrize("level", LEVELS)
def test_words_and_dwells(mill, level):
    text = "G21 G90 F1800\nM3 S1000\nG1 X10\nM7\nG1 X20 Y1\nG4 P1.5\nM9\nG1 X40\nM5\nM30\n"
    trajectory = cncplan.plan_text(text, mill, level=level)
    without = cncplan.plan_text(text.replace("G4 P1.5\n", "G4 P0\n"), mill, level=level)
    assert trajectory.duration == pytest.approx(without.duration + 1.5, abs=1e-9)
    words = trajectory.words
    assert [f"{w['letter']}{w['number']:g}" for w in words] == ["S1000", "M3", "M7", "M9", "M5", "M30"]
    assert words["line"].tolist() == [2, 2, 4, 7, 9, 10]
    assert words["time"][0] == 0 and words["time"][-1] == pytest.approx(trajectory.duration, abs=1e-12)
    at_m7 = trajectory.at(words["time"][2])
    assert np.hypot(*(at_m7.position[:2] - [10, 0])) < 0.011
    assert np.linalg.norm(at_m7.velocity) > 1  # M7 does not stop
    at_m9 = trajectory.at(words["time"][3])
    assert at_m9.position[:2] == pytest.approx([20, 1], abs=1e-9) and np.linalg.norm(at_m9.velocity) == 0
    # behind the dwell
    rest = trajectory.at(words["time"][3] - 1.4)
    assert rest.position == pytest.approx(at_m9.position, abs=1e-9) and not rest.velocity.any()


@pytest.mark.parametrize("level", LEVELS)
def test_blocks(mill, level):
    trajectory = cncplan.plan_text(SQUARE, mill, level=level)
    blocks = trajectory.blocks
    assert blocks["line"].tolist() == [2, 3, 4, 5]
    assert blocks["length"] == pytest.approx([20, 20, 10 * math.pi / 2, math.hypot(10, 30)], rel=1e-9)
    assert blocks["start"][1:] == pytest.approx((blocks["start"] + blocks["duration"])[:-1], abs=1e-9)
    assert (blocks["start"] + blocks["duration"])[-1] == pytest.approx(trajectory.duration, abs=1e-9)
    assert blocks["entry"][0] == 0 and blocks["exit"][-1] == pytest.approx(0, abs=1e-6)
    assert trajectory.length == pytest.approx(blocks["length"].sum())


@pytest.mark.parametrize("level", LEVELS)
def test_levels_of_blocks(mill, level):
    trajectory = cncplan.plan_text(SQUARE, mill, level=level)
    assert trajectory.blocks["level"].tolist() == [level] * 4 and not any(trajectory.blocks["reason"])
    assert len(trajectory.fallbacks) == 0


@pytest.mark.parametrize("level", LEVELS)
def test_fallbacks_say_where_and_why(level):
    axes = [cncplan.Axis("X", backlash=0.02), cncplan.Axis("Y"), cncplan.Axis("Z")]
    trajectory = cncplan.plan_text(SQUARE, cncplan.Machine(**LIMITS, axes=axes), level=level)
    if level in ("exact", "fast"):
        assert len(trajectory.fallbacks) == 0 and trajectory.blocks["level"].tolist() == [level] * 4
        return
    assert trajectory.fallbacks.tolist() == [(0, 3, "fast", "backlash takes time")]
    assert trajectory.blocks["level"].tolist() == ["fast"] * 4
    assert trajectory.blocks["reason"].tolist() == ["backlash takes time"] * 4
    assert trajectory.duration == cncplan.plan_text(SQUARE, cncplan.Machine(**LIMITS, axes=axes), level="fast").duration


def test_fallbacks_of_simulate(simulate, tmp_path):
    """The same parts, by lines, of a program whose axes turn alone in between."""
    machine_file = tmp_path / "mill.toml"
    machine_file.write_text("".join(
        f'[[axis]]\nletter = "{letter}"\nkind = "{kind}"\nvelocity = 40\nacceleration = 900\njerk = 9000\n'
        for letter, kind in (("X", "linear"), ("Y", "linear"), ("Z", "linear"), ("A", "rotary"))))
    program = tmp_path / "part.ngc"
    program.write_text("G21 G90 F1800\nG1 X10\nY10\nA90\nX0\nY0\n")
    summary, _ = simulated(simulate, program, tmp_path, "--machine", machine_file, *OPTIONS["best"])
    trajectory = cncplan.plan_file(program, cncplan.Machine(machine_file, **LIMITS))
    lines = trajectory.blocks["line"]
    assert [{"lines": [lines[part["first"]], lines[part["last"]]], "level": part["level"], "reason": part["reason"]}
            for part in trajectory.fallbacks] == summary["fallbacks"]
    # The program plans it with six axes, the module with nine: they agree to rounding.
    assert trajectory.duration == pytest.approx(summary["time_s"], rel=1e-10)


def test_samples_are_on_the_grid(mill):
    trajectory = cncplan.plan_text(SQUARE, mill)
    samples = trajectory.sample(0.01)
    n = math.ceil(trajectory.duration / 0.01)
    assert len(samples) == n + 1
    assert np.array_equal(samples.t[:-1], np.arange(n) * 0.01) and samples.t[-1] == trajectory.duration
    assert samples.position.shape == (n + 1, 3) and samples.line.shape == (n + 1,)
    one = trajectory.at(samples.t[100])
    assert np.array_equal(one.position, samples.position[100]) and one.line == samples.line[100]
    assert one.t == samples.t[100] and isinstance(one.s, float) and isinstance(one.line, int)
    assert trajectory.at(-5).position == pytest.approx([0, 0, 0], abs=1e-15)
    assert np.array_equal(trajectory.at(1e9).position, samples.position[-1])


def test_step_edges(mill):
    edges = cncplan.plan_text("G1 X1 F600\nX0.5", mill).step_edges()
    assert len(edges) == 600 and (np.diff(edges["time"]) >= 0).all()
    assert edges["direction"].sum() == 200 and set(edges["axis"]) == {0}
    # The first step is where x is half a step, 1/800 mm: j t^3 / 6 = x.
    assert edges["time"][0] == pytest.approx((6 / 800 / 10000) ** (1 / 3), rel=1e-9)


def test_peaks(mill):
    found = cncplan.plan_text("G1 X100", mill).peaks()
    # The ramp by jerk alone peaks at sqrt(v j).
    assert found.tool == pytest.approx((30, math.sqrt(30 * 10000), 10000), rel=1e-6)
    assert found.velocity == pytest.approx([30, 0, 0])


def test_program_words_of_tolerance(mill):
    wide = cncplan.plan_text("G64 P0.5\n" + SQUARE, mill)
    assert wide.duration < cncplan.plan_text(SQUARE, mill).duration
    assert not wide.warnings


def test_exact_is_tolerance_0(mill):
    exact = cncplan.plan_text(SQUARE, mill, tolerance=0.01, level="exact")
    for level in LEVELS:
        assert cncplan.plan_text(SQUARE, mill, tolerance=0, level=level).duration == exact.duration


def test_subprograms_of_the_folder(tmp_path, mill):
    (tmp_path / "part.ngc").write_text("F600\no<side> call [20]\nM2\n")
    (tmp_path / "side.ngc").write_text("o<side> sub\nG1 X#1\no<side> endsub\n")
    assert cncplan.plan_file(tmp_path / "part.ngc", mill).length == 20


def test_shared_ball(shared):
    """The figure of issue 46, made by other means."""
    mill = cncplan.Machine(**LIMITS)
    assert cncplan.plan_file(shared / "data/ball.nc", mill, level="fast").duration == pytest.approx(1052.74, abs=0.1)
