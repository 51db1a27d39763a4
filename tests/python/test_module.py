"""The module as a guest of Python: errors, types, threads, signals."""

import ast
import copy
import inspect
import json
import math
import os
import pickle
import re
import signal
import subprocess
import sys
import threading
import time

import numpy as np
import pytest
from conftest import LEVELS, LIMITS, ROOT

import cncplan

# Enough for some seconds of planning.
LONG = "G1 F1800\n" + "".join(f"X{0.2 * i:.4f} Y{3 * math.sin(i / 3):.4f} Z{math.cos(i / 7):.4f}\n" for i in range(20000))


def test_plan_py_runs_as_it_stands(shared):
    done = subprocess.run([sys.executable, shared / "programs/plan.py", ROOT / "examples/programs/short_lines.ngc"],
                          check=True, capture_output=True, text=True)
    duration, rows, jerk = done.stdout.split()
    trajectory = cncplan.plan_file(ROOT / "examples/programs/short_lines.ngc", cncplan.Machine(**LIMITS), tolerance=0.01)
    assert float(duration) == trajectory.duration and int(rows) == len(trajectory.sample(0.001))
    assert float(jerk) <= 10000 * (1 + 1e-6)


def test_error_is_a_value_error_with_its_place(mill):
    with pytest.raises(ValueError) as caught:
        cncplan.plan_text("G1 F600\n  G1 X1 Y1e99\n", mill)
    error = caught.value
    assert isinstance(error, cncplan.Error) and (error.line, error.file) == (2, None)
    assert str(error).startswith(f"2:{error.column}: error: ")
    again = pickle.loads(pickle.dumps(error))
    assert (str(again), again.__dict__) == (str(error), error.__dict__)
    assert copy.copy(error).code == error.code


def test_error_names_its_file(tmp_path, mill):
    file = tmp_path / "part.ngc"
    file.write_text("G1 X1 F0\n")
    with pytest.raises(cncplan.Error) as caught:
        cncplan.plan_file(file, mill)
    assert caught.value.file == str(file) and str(caught.value).startswith(f"{file}:1:")
    for missing in (tmp_path / "none.ngc", tmp_path, "", "/dev/null/x"):
        with pytest.raises(cncplan.Error) as caught:
            cncplan.plan_file(missing, mill)
        assert caught.value.code == "unreadable"


def test_code_names_are_those_of_the_library():
    text = (ROOT / "include/cncplan/core/error.hpp").read_text()
    enumerators = re.findall(r"^  ([a-z_]+),$", text.partition("enum class ErrorCode")[2].partition("count_")[0], re.M)
    assert list(cncplan._core.code_names) == enumerators


@pytest.mark.parametrize("period", [0, -0.001, math.nan, math.inf, -math.inf])
def test_a_period_is_above_0(mill, period, tmp_path):
    trajectory = cncplan.plan_text("G1 X1", mill)
    for call in (trajectory.sample, lambda p: trajectory.to_csv(tmp_path / "x.csv", p)):
        with pytest.raises(cncplan.Error) as caught:
            call(period)
        assert caught.value.field == "period"
    assert not (tmp_path / "x.csv").exists()


def test_more_samples_than_memory(mill):
    trajectory = cncplan.plan_text("G1 X1\nG4 P1000000000000", mill)
    with pytest.raises(MemoryError):
        trajectory.sample(1e-6)


@pytest.mark.parametrize("call, text", [
    (lambda m: cncplan.plan_text(3, m), "text: expected a str, got int"),
    (lambda m: cncplan.plan_text(b"G1 X1", m), "text: expected a str, got bytes"),
    (lambda m: cncplan.plan_file(3, m), r"path: expected a path \(str or os.PathLike\), got int"),
    (lambda m: cncplan.plan_text("", "mill"), "machine: expected a cncplan.Machine, got str"),
    (lambda m: cncplan.plan_text("", m, tolerance="0.01"), "tolerance: expected a number, got str"),
    (lambda m: cncplan.plan_text("", m, level=3), "level: expected one of 'exact', 'fast', 'good', 'best', got int"),
    (lambda m: cncplan.plan_text("", m).at("now"), "t: expected a number, got str"),
    (lambda m: cncplan.plan_text("", m).at([[1]]), "t: expected a number or an array of n numbers"),
    (lambda m: cncplan.plan_text("", m, start="home"), "start: expected an array of 3 numbers, got str"),
    (lambda m: cncplan.read_program(), "expected either a path or text"),
])
def test_wrong_types_say_what_was_expected(mill, call, text):
    with pytest.raises(TypeError, match=text):
        call(mill)


@pytest.mark.parametrize("call", [
    lambda m: cncplan.plan_text("", m, tolerance=-1),
    lambda m: cncplan.plan_text("", m, tolerance=math.nan),
    lambda m: cncplan.plan_text("", m, level="better"),
    lambda m: cncplan.plan_text("", m, start=[1, 2]),
    lambda m: cncplan.plan_text("", m).at(math.nan),
    lambda m: cncplan.plan_text("", m, junction_deviation=-1),
    lambda m: cncplan.plan_text("G1 X\udc80", m),
    lambda m: cncplan.plan_text("G1 X1", cncplan.Machine()),
])
def test_wrong_values_are_errors(mill, call):
    with pytest.raises(cncplan.Error):
        call(mill)


def test_start(mill):
    trajectory = cncplan.plan_text("G1 X5 Y5", mill, start=[5, 0, 0])
    assert trajectory.length == 5 and trajectory.at(0).position.tolist() == [5, 0, 0]


@pytest.mark.parametrize("level", LEVELS)
def test_empty_program(mill, level):
    trajectory = cncplan.plan_text("", mill, level=level)
    assert trajectory.duration == 0 and len(trajectory.sample(0.001)) == 1
    assert len(trajectory.words) == len(trajectory.blocks) == len(trajectory.step_edges()) == 0


def test_other_threads_run_while_it_plans(mill):
    counted, done = 0, threading.Event()

    def count():
        nonlocal counted
        while not done.is_set():
            counted += 1
            time.sleep(0.001)

    thread = threading.Thread(target=count)
    thread.start()
    start = time.perf_counter()
    cncplan.plan_text(LONG[:200000], mill, level="fast").sample(0.002)
    seconds = time.perf_counter() - start
    done.set()
    thread.join()
    assert counted > 20 * seconds


@pytest.mark.parametrize("level", LEVELS)
def test_ctrl_c_ends_a_long_call(mill, level):
    before = signal.signal(signal.SIGALRM, lambda *_: (_ for _ in ()).throw(KeyboardInterrupt))
    try:
        signal.setitimer(signal.ITIMER_REAL, 0.15, 0.3)  # again where the first one came between two calls
        start = time.perf_counter()
        with pytest.raises(KeyboardInterrupt):
            while time.perf_counter() < start + 60:
                cncplan.plan_text(LONG, mill, level=level)
        assert time.perf_counter() < start + 10
    finally:
        signal.setitimer(signal.ITIMER_REAL, 0)
        signal.signal(signal.SIGALRM, before)
    assert cncplan.plan_text("G1 X1", mill, level=level).length == 1  # nothing is left behind


def test_ctrl_c_ends_reading(mill):
    # Longer than any test: a loop that moves is run as often as it says.
    loop = "F600\nG1 X1\n#1=0\no1 while [#1 LT 1000000000]\nX1\nX0\n#1=[#1+1]\no1 endwhile\n"
    before = signal.signal(signal.SIGALRM, lambda *_: (_ for _ in ()).throw(KeyboardInterrupt))
    try:
        for call in (lambda: cncplan.read_program(text=loop, machine=mill), lambda: cncplan.plan_text(loop, mill)):
            signal.setitimer(signal.ITIMER_REAL, 0.3)
            start = time.perf_counter()
            with pytest.raises(KeyboardInterrupt):
                call()
            assert time.perf_counter() < start + 5
    finally:
        signal.setitimer(signal.ITIMER_REAL, 0)
        signal.signal(signal.SIGALRM, before)


@pytest.mark.parametrize("level", LEVELS)
def test_progress(mill, level):
    text = LONG[:LONG.find("X400" if level == "best" else "X1600")] if level in ("good", "best") else LONG  # some seconds
    shares = []
    trajectory = cncplan.plan_text(text, mill, level=level, progress=shares.append)
    assert shares == sorted(shares) and 0 <= shares[0] and shares[-1] == 1
    if level in ("good", "best"):
        assert len(shares) > 3 and 0 < shares[1] < 1
    assert trajectory.duration == cncplan.plan_text(text, mill, level=level).duration


def test_progress_ends_planning(mill):
    with pytest.raises(cncplan.Error) as caught:
        cncplan.plan_text(LONG, mill, progress=lambda share: False)
    assert caught.value.code == "interrupted" and 0 <= caught.value.value < 1
    assert "interrupted" in str(caught.value)
    for value in (None, True, 0, "no"):  # only False says so
        assert cncplan.plan_text("G1 X1", mill, progress=lambda share: value).length == 1

    def fail(share):
        raise RuntimeError("of my own")

    for call in (lambda: cncplan.plan_text(LONG, mill, level="good", progress=fail),
                 lambda: cncplan.plan_blocks([cncplan.line([0, 0, 0], [1, 0, 0])], mill, progress=fail)):
        with pytest.raises(RuntimeError, match="of my own"):
            call()
    with pytest.raises(TypeError, match="progress: expected a function of one number, got int"):
        cncplan.plan_text("G1 X1", mill, progress=3)


def test_report(mill, tmp_path):
    program = "G21 G90 F1800 (a comment: <b>&)\nG1 X20\nM3 S1000\nG3 X10 Y10 R10\n"
    (tmp_path / "part.ngc").write_text(program)
    for trajectory in (cncplan.plan_file(tmp_path / "part.ngc", mill), cncplan.plan_text(program, mill, level="fast"),
                       cncplan.plan_blocks([cncplan.line([0, 0, 0], [5, 0, 0])], mill)):
        trajectory.report(tmp_path / "page.html")
        page = (tmp_path / "page.html").read_text()
        assert page.startswith("<!doctype html>") and page.rstrip().endswith("</html>")
        data = json.loads(re.search(r'<script[^>]*type="application/json"[^>]*>(.*?)</script>', page, re.S)[1])
        assert ["Time", f"{trajectory.duration:.3f} s"] in data["summary"]
        if len(trajectory.words):
            assert data["text"] == program
            assert [mark["text"] for mark in data["marks"]] == ["S1000", "M3"]
            assert [mark["time"] for mark in data["marks"]] == trajectory.words["time"].tolist()
    trajectory = cncplan.plan_file(tmp_path / "part.ngc", mill)
    (tmp_path / "part.ngc").unlink()
    with pytest.raises(cncplan.Error) as caught:
        trajectory.report(tmp_path / "other.html")
    assert caught.value.code == "unreadable" and not (tmp_path / "other.html").exists()
    with pytest.raises(TypeError, match="path: expected a path"):
        trajectory.report(3)


def test_everything_public_is_explained():
    for name in cncplan.__all__:
        thing = getattr(cncplan, name)
        assert inspect.getdoc(thing), name
        if inspect.isclass(thing):
            for key, member in vars(thing).items():
                if not key.startswith("_") and (inspect.isfunction(member) or isinstance(member, property)):
                    assert inspect.getdoc(member), f"{name}.{key}"
        signature = inspect.signature(thing)
        if inspect.isfunction(thing):
            assert all(p.annotation is not p.empty for p in signature.parameters.values()), name
            assert signature.return_annotation is not signature.empty, name


def test_stubs_have_what_the_module_has():
    module = cncplan._core
    stubs = ast.parse((ROOT / "python/cncplan/_core.pyi").read_text())

    def told(body):
        names = {node.name for node in body if isinstance(node, (ast.FunctionDef, ast.ClassDef))}
        return names | {node.target.id for node in body if isinstance(node, ast.AnnAssign)}

    def public(thing):
        return {name for name in vars(thing) if not name.startswith("_")}

    assert told(stubs.body) == public(module)
    for node in stubs.body:
        if isinstance(node, ast.ClassDef):
            made = getattr(module, node.name)
            assert told(node.body) - {"__init__"} == public(made), node.name
            for function in node.body:
                if isinstance(function, ast.FunctionDef) and not function.decorator_list:
                    # pybind11 writes them as "name(self: ..., arg0: ...) -> ..."
                    written = getattr(made, function.name).__doc__.partition(" -> ")[0]
                    assert len(re.findall(r"[(,] ?(?:self|arg\d+): ", written)) == len(function.args.args), function.name
        elif isinstance(node, ast.FunctionDef):
            written = getattr(module, node.name).__doc__.partition(" -> ")[0]
            assert len(re.findall(r"[(,] ?arg\d+: ", written)) == len(node.args.args), node.name


def test_memory_gives_out(mill):
    """Linux would end the interpreter where more is used than there is."""
    trajectory = cncplan.plan_text("G1 X10 F600", mill)
    loop = "F600\nG1 X1\n#1=0\no1 while [#1 LT 1000000000]\nX1\nX0\n#1=[#1+1]\no1 endwhile\n"
    far = [cncplan.line([0, 0, 0], [1e5, 0, 0]), cncplan.line([1e5, 0, 0], [1e5, 1e5, 0])]
    calls = [lambda: trajectory.sample(1e-6), trajectory.step_edges, lambda: cncplan.read_program(text=loop),
             lambda: cncplan.plan_text(loop, mill), lambda: cncplan.plan_text(loop, mill, level="exact")]
    cncplan._core.leave_memory(2**62)
    try:
        for call in calls:
            with pytest.raises(MemoryError, match="memory"):
                call()
        start = time.perf_counter()
        slower = cncplan.plan_blocks(far, mill, level="good")
        reasons = {part["reason"] for part in slower.fallbacks}
        assert reasons <= {"the memory gave out", "the level fast takes less time"} and slower.duration > 6000
        assert time.perf_counter() < start + 20
    finally:
        cncplan._core.leave_memory(0)
    assert len(trajectory.step_edges()) == 4000 and len(trajectory.sample(0.001)) > 300


def test_nothing_is_lost_over_many_trajectories(mill):
    import gc

    import resource

    def once():
        cncplan.plan_text("G1 X10 F600\nY10\n" * 50, mill, level="fast").sample(0.01)

    for _ in range(5):
        once()
    gc.collect()
    before = resource.getrusage(resource.RUSAGE_SELF).ru_maxrss
    for _ in range(60):
        once()
    assert resource.getrusage(resource.RUSAGE_SELF).ru_maxrss - before < 20000  # kB


def test_samples_outlive_their_trajectory(mill):
    samples = cncplan.plan_text("G1 X10", mill).sample(0.001)
    edges = cncplan.plan_text("G1 X10", mill).step_edges()
    assert samples.position[-1, 0] == 10 and edges["direction"].sum() == 4000
    samples.position[0] = 3  # they are the caller's own
    assert isinstance(samples.t, np.ndarray) and os.getpid()
