"""Planning, and what a trajectory answers."""

from __future__ import annotations

import os
from collections.abc import Callable, Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np

from . import _core
from ._blocks import Block, tuples_of
from ._errors import Error, choice, kind, not_negative, number, path_of, positive, row, text_of
from ._machine import Machine, core_of

LEVELS = _core.level_names
_REASONS = np.array([*_core.reasons, ""], dtype=object)  # the last one for no reason

BLOCK_DTYPE = np.dtype([("block", "i8"), ("line", "i8"), ("length", "f8"), ("start", "f8"), ("duration", "f8"),
                        ("entry", "f8"), ("peak", "f8"), ("exit", "f8"), ("level", "U5"), ("reason", "O")])
FALLBACK_DTYPE = np.dtype([("first", "i8"), ("last", "i8"), ("level", "U5"), ("reason", "O")])
WORD_DTYPE = np.dtype([("letter", "U1"), ("number", "f8"), ("time", "f8"), ("line", "i8"), ("arguments", "O")])
EDGE_DTYPE = np.dtype([("time", "f8"), ("motor", "i8"), ("axis", "i8"), ("direction", "i8")])


@dataclass(frozen=True)
class Samples:
    """The motion on a grid of n instants, of a machine with so many axes. mm, rad and s."""

    t: np.ndarray  #: (n,) s
    line: np.ndarray  #: (n,) line of the program
    position: np.ndarray  #: (n, axes) mm; rad of rotary axes
    velocity: np.ndarray  #: (n, axes) mm/s
    acceleration: np.ndarray  #: (n, axes) mm/s^2
    jerk: np.ndarray  #: (n, axes) mm/s^3
    s: np.ndarray  #: (n,) programmed length since the start, mm
    v: np.ndarray  #: (n,) its time derivative, mm/s
    a: np.ndarray  #: (n,) mm/s^2
    j: np.ndarray  #: (n,) mm/s^3

    def __len__(self) -> int:
        return len(self.t)


@dataclass(frozen=True)
class SetPoint:
    """The axes and the tool at one instant, or at an array of instants. mm, rad and s."""

    t: Any  #: s
    block: Any  #: counted from 0, of the blocks that were planned
    line: Any  #: line of the program; 0 where there is none
    position: np.ndarray  #: (axes,) mm; rad of rotary axes
    velocity: np.ndarray
    acceleration: np.ndarray
    jerk: np.ndarray
    tool: np.ndarray  #: (3,) X Y Z of the tool, mm
    s: Any  #: programmed length since the start, mm
    v: Any
    a: Any
    j: Any
    #: of an executor, words that were reached: letter, number, s from the start of the tick to the instant at which
    #: it was reached, line, and the words that belong to it as pairs
    words: tuple[tuple[str, float, float, int, tuple[tuple[str, float], ...]], ...] = ()
    feed: float | None = None  #: of an executor, mm/s that the program asks for; infinite for as fast as may be


@dataclass(frozen=True)
class Peaks:
    """Largest magnitudes of a trajectory inside blocks. mm, rad and s."""

    velocity: np.ndarray  #: (axes,)
    acceleration: np.ndarray  #: (axes,)
    jerk: np.ndarray  #: (axes,)
    tool: tuple[float, float, float]  #: velocity, acceleration and jerk of the tool's vectors
    along: tuple[float, float, float]  #: of the motion along the path


def _named(rows: np.ndarray, dtype: np.dtype) -> np.ndarray:
    """Rows of the extension module, which has numbers for the level and the reason."""
    numbers = np.dtype([(name, "i8" if name in ("level", "reason") else dtype[name]) for name in dtype.names or ()])
    rows = np.asarray(rows).view(numbers)
    made = np.empty(len(rows), dtype)
    for name in dtype.names or ():
        made[name] = rows[name]
    made["level"] = np.array(LEVELS)[rows["level"]]
    made["reason"] = _REASONS[rows["reason"]]
    return made


class Trajectory:
    """A planned program: where everything is at any instant. `plan_file` and its kin make it."""

    def __init__(self, core: Any, machine: Machine, level: str, tolerance: float, name: str = "",
                 text: bytes | None = b"") -> None:
        self._core = core
        self._name = name
        self._text = text  # None: that of the file of this name
        self.machine = machine
        self.level = level  #: what was asked for
        self.tolerance = tolerance  #: mm

    @property
    def duration(self) -> float:
        """s, from rest to rest."""
        return self._core.duration()

    @property
    def length(self) -> float:
        """mm of the programmed path; what only rotary axes do does not count."""
        return self._core.length()

    @property
    def warnings(self) -> list[str]:
        """What the program has that has no effect, as sentences."""
        return self._core.warnings()

    @property
    def blocks(self) -> np.ndarray:
        """When each block that moves runs, as a structured array: block (from 0), line, length (mm; rad where
        only rotary axes move), start and duration (s), entry, peak and exit (speed at its start, at most, and
        at its end; mm/s), level (at which it was planned), reason (why not at the level that was asked for, a
        clause; empty where it was)."""
        return _named(self._core.blocks(), BLOCK_DTYPE)

    @property
    def fallbacks(self) -> np.ndarray:
        """Blocks that have another level than was asked for, in order, as a structured array: first and last
        (number of a block, from 0), level, reason (a clause). Blocks that need no smoothing are not among them."""
        return _named(self._core.fallbacks(), FALLBACK_DTYPE)

    @property
    def words(self) -> np.ndarray:
        """Words that others act on (M3, S, T ...), in order, as a structured array: letter, number, time (s at
        which the motion reaches it), line, arguments (the words that belong to a code: pairs of letter and number)."""
        return np.array(self._core.words(), dtype=WORD_DTYPE)

    def at(self, t: float | Sequence[float] | np.ndarray) -> SetPoint:
        """The set point at t seconds, or at an array of n instants: arrays with n rows then. Before the start,
        the start; after the end, the end."""
        if np.ndim(t) == 0:
            times = np.array([number(t, "t")])
        else:
            times = np.asarray(t)
            if times.ndim != 1 or times.dtype.kind not in "iuf":
                raise TypeError(f"t: expected a number or an array of n numbers, got {kind(t)} of shape {times.shape}")
            times = np.ascontiguousarray(times, dtype=float)
        if np.isnan(times).any():
            raise Error("t: is not a finite number", "not_finite", "t", np.nan)
        found = self._core.at(times, len(self.machine))
        found["t"] = times
        if np.ndim(t) == 0:
            found = {key: value[0] if value.ndim > 1 else value[0].item() for key, value in found.items()}
        return SetPoint(**found)

    def sample(self, period: float) -> Samples:
        """The motion at k period while that is before the end, and at the end itself.

        Parameters
        ----------
        period : float
            s, > 0.
        """
        period = positive(period, "period")
        count = self._core.sample_count(period)
        axes = len(self.machine)
        if count * 8 * (6 + 4 * axes) > _core.available_memory():
            raise MemoryError(f"period: {period} makes {count} samples, more than there is memory for")
        return Samples(**self._core.sample(period, axes))

    def step_edges(self) -> np.ndarray:
        """Every step of the machine's motors, in order of time, as a structured array: time (s), motor (from 0,
        in the order of the axes), axis (from 0), direction (+1 or -1)."""
        most = _core.available_memory() // (3 * EDGE_DTYPE.itemsize)
        return np.asarray(self._core.step_edges(most)).view(EDGE_DTYPE)

    def peaks(self) -> Peaks:
        """The largest velocities, accelerations and jerks, found on the whole motion and not on samples."""
        velocity, acceleration, jerk, tool, along = self._core.peaks()
        n = len(self.machine)
        return Peaks(velocity[:n], acceleration[:n], jerk[:n], tool, along)

    def to_csv(self, path: str | os.PathLike[str], period: float = 0.001) -> None:
        """Writes samples: t, the axes, s, v, a, j; mm, rad and s, with 17 significant digits.

        Parameters
        ----------
        path
            The file that is made, or made anew.
        period : float
            s, > 0.
        """
        samples = self.sample(period)
        with open(path_of(path), "w", encoding="ascii", newline="\n") as file:
            file.write(",".join(["t", *self.machine.letters.lower(), "s", "v", "a", "j"]) + "\n")
            for first in range(0, len(samples), 65536):  # a table of all would need as much memory again
                part = slice(first, first + 65536)
                table = np.column_stack([samples.t[part], samples.position[part], samples.s[part], samples.v[part],
                                         samples.a[part], samples.j[part]])
                np.savetxt(file, table + 0.0, fmt="%.17g", delimiter=",")  # no number is -0

    def report(self, path: str | os.PathLike[str]) -> None:
        """Writes one page of HTML that shows the motion beside its program: the path in space, speeds and axes over
        time, a player. It is that of `cncplan_simulate --report`, without the deviation from the programmed path,
        and needs nothing beside it.

        Parameters
        ----------
        path
            The file that is made, or made anew.

        Raises
        ------
        Error
            not_supported: three.js or dygraphs were not there when the module was built; unreadable: the program's
            file is not there any more.
        """
        file_name = path_of(path)
        if self._text is not None:
            text = self._text
        else:
            try:
                with open(self._name, "rb") as file:
                    text = file.read()
            except OSError:
                raise Error(f"{self._name}: cannot be read", "unreadable", "file", file=self._name) from None
        summary = [("Time", f"{self.duration:.3f} s"), ("Length", f"{self.length:.3f} mm"), ("Level", self.level),
                   ("Tolerance", f"{self.tolerance:g} mm"), ("Blocks", str(len(self.blocks)))]
        summary += [("Other levels", f"blocks {part['first']} to {part['last']}: {part['level']}, {part['reason']}")
                    for part in self.fallbacks[:20]]
        page = self._core.report(self._name or "program", text, summary)
        with open(file_name, "wb") as file:
            file.write(page)

    def __repr__(self) -> str:
        return f"<cncplan.Trajectory {self.duration:.6g} s, {self.length:.6g} mm>"


def options_of(machine: Machine, tolerance: Any, rotary_tolerance: Any, junction_deviation: Any, start: Any,
               level: Any = "best") -> Any:
    core_of(machine)
    turn = not_negative(rotary_tolerance, "rotary_tolerance")
    return _core.PlanOptions(not_negative(tolerance, "tolerance"), LEVELS.index(choice(level, "level", LEVELS)),
                             turn * (np.pi / 180), not_negative(junction_deviation, "junction_deviation"),
                             core_of(machine).start if start is None else
                             row(start, "start", len(machine.coordinates)))


def _listener(progress: Any) -> Any:
    if progress is not None and not callable(progress):
        raise TypeError(f"progress: expected a function of one number, got {kind(progress)}")
    return progress


def _finished(progress: Any, trajectory: Trajectory) -> Trajectory:
    if progress is not None:
        progress(1.0)
    return trajectory


def plan_file(path: str | os.PathLike[str], machine: Machine, tolerance: float = 0.01, level: str = "best", *,
              rotary_tolerance: float = 0.05, junction_deviation: float = 0.01,
              start: Sequence[float] | None = None, progress: Callable[[float], Any] | None = None) -> Trajectory:
    """Plans a G-code file.

    Parameters
    ----------
    path
        The file; files of its folder are found as subprograms.
    machine : Machine
    tolerance : float
        mm, >= 0: how far the tool may leave the programmed path, so that it moves without jumps; a program's
        own G64 P comes before it. 0: the exact path.
    level : str
        "exact": the programmed path, where the tolerance does not act. "fast", "good" and "best": the fastest
        motion within the tolerance, with more and more work.
    rotary_tolerance : float
        degrees: the same for rotary axes.
    junction_deviation : float
        mm, >= 0: corners that are left exact are passed as fast as ones rounded within it would be.
    start : n numbers, optional
        Where the motion starts; mm, and rad of rotary axes. Default: 0.
    progress : callable, optional
        Called with the share of the work that is done, 0 to 1, some times a second, and with 1 at the end. Where
        it returns False planning ends with the error "interrupted".

    Raises
    ------
    Error
        With the place in the program.
    """
    options = options_of(machine, tolerance, rotary_tolerance, junction_deviation, start, level)
    name = path_of(path)
    core = _core.plan_file(core_of(machine), name, options, _listener(progress))
    return _finished(progress, Trajectory(core, machine, level, float(tolerance), name, None))


def plan_text(text: str, machine: Machine, tolerance: float = 0.01, level: str = "best", *,
              rotary_tolerance: float = 0.05, junction_deviation: float = 0.01,
              start: Sequence[float] | None = None, progress: Callable[[float], Any] | None = None) -> Trajectory:
    """Plans the text of a G-code program. Parameters and errors are those of `plan_file`."""
    options = options_of(machine, tolerance, rotary_tolerance, junction_deviation, start, level)
    program = _program(text)
    core = _core.plan_text(core_of(machine), program, options, _listener(progress))
    return _finished(progress, Trajectory(core, machine, level, float(tolerance), "", program))


def _program(text: Any) -> bytes:
    # what is no UTF-8 is for the reader to refuse, at its place
    return text_of(text, "text").encode(errors="surrogatepass")


def plan_blocks(blocks: Sequence[Block], machine: Machine, tolerance: float = 0.01, level: str = "best", *,
                rotary_tolerance: float = 0.05, junction_deviation: float = 0.01,
                progress: Callable[[float], Any] | None = None) -> Trajectory:
    """Plans blocks made by hand (`line`, `arc`, `curve`), from rest to rest. Each begins where the one before
    ends. Parameters as of `plan_file`; errors have the number of the block."""
    options = options_of(machine, tolerance, rotary_tolerance, junction_deviation, None, level)
    core = _core.plan_blocks(core_of(machine), tuples_of(blocks, len(machine)), options, _listener(progress))
    return _finished(progress, Trajectory(core, machine, level, float(tolerance)))
