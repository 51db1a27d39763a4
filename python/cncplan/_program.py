"""Programs as they are read, without a plan, and as they are written."""

from __future__ import annotations

import os
from collections.abc import Sequence
from typing import Any

import numpy as np

from . import _core
from ._blocks import Block, tuples_of
from ._errors import Error, integer, path_of
from ._machine import Machine, core_of
from ._trajectory import _program, options_of

_ROW_DTYPE = np.dtype([("line", "i8"), ("column", "i8"), ("kind", "i8"), ("plane", "i8"), ("start", "f8", (9,)),
                       ("end", "f8", (9,)), ("center", "f8", (3,)), ("radius", "f8"), ("sweep", "f8"),
                       ("length", "f8"), ("feed", "f8")])
_KINDS = np.array(["rapid", "line", "arc", "spline", "mapped"])


class Program:
    """A program that was read, with all that is wrong with it. `read_program` makes it."""

    def __init__(self, core: Any, machine: Machine, most_problems: int) -> None:
        self._core = core
        self._most_problems = most_problems
        self.machine = machine

    @property
    def problems(self) -> list[Error]:
        """All that is wrong, in order: lines that are not understood, arcs that cannot be made, motions that
        leave the travel. Empty: the program can be planned."""
        return [Error(*arguments) for arguments in self._core.problems()[:self._most_problems]]

    @property
    def warnings(self) -> list[str]:
        """What the program has that has no effect, as sentences."""
        return self._core.warnings

    @property
    def lines(self) -> int:
        """How many lines were read."""
        return self._core.lines

    @property
    def motions(self) -> np.ndarray:
        """The motions, in machine coordinates, as a structured array: line, column, kind ("rapid", "line", "arc",
        "spline"; behind kinematics "mapped"), plane (of an arc: 17, 18, 19), start and end (axes,) in mm and rad, center (3,), radius (mm) and sweep (rad;
        + counter-clockwise) of an arc, length (mm), feed (mm/s). What a motion lacks is NaN."""
        rows = np.asarray(self._core.motions()).view(_ROW_DTYPE)
        n = len(self.machine)
        made = np.empty(len(rows), np.dtype([("line", "i8"), ("column", "i8"), ("kind", "U6"), ("plane", "i8"),
                                             ("start", "f8", (n,)), ("end", "f8", (n,)), ("center", "f8", (3,)),
                                             ("radius", "f8"), ("sweep", "f8"), ("length", "f8"), ("feed", "f8")]))
        for name in ("line", "column", "plane", "center", "radius", "sweep", "length", "feed"):
            made[name] = rows[name]
        made["kind"] = _KINDS[rows["kind"]]
        made["start"] = rows["start"][:, :n]
        made["end"] = rows["end"][:, :n]
        return made

    @property
    def words(self) -> np.ndarray:
        """Words that others act on (M3, S, T ...), in order, as a structured array: letter, number, line, arguments (the words
        that belong to a code: pairs of letter and number)."""
        return np.array(self._core.words(), dtype=[("letter", "U1"), ("number", "f8"), ("line", "i8"),
                                                   ("arguments", "O")])

    def __repr__(self) -> str:
        return f"<cncplan.Program {self.lines} lines, {len(self.problems)} problems>"


def read_program(path: str | os.PathLike[str] | None = None, machine: Machine | None = None, *,
                 text: str | None = None, tolerance: float = 0.01, most_problems: int = 100) -> Program:
    """Reads a program without planning it, on behind whatever is wrong with it.

    Parameters
    ----------
    path
        The file; files of its folder are found as subprograms.
    machine : Machine, optional
        Default: X, Y and Z without travel limits.
    text : str
        In place of a file.
    tolerance : float
        mm; 0: P and Q of G64 have no effect, and a warning says so.
    most_problems : int
        So many are told.
    """
    if machine is None:
        machine = Machine(velocity=1.0, acceleration=1.0, jerk=1.0)
    if (path is None) == (text is None):
        raise TypeError("read_program: expected either a path or text")
    options = options_of(machine, tolerance, 0.05, 0.01, None)
    most = integer(most_problems, "most_problems", 1, 10**6)
    if path is not None:
        return Program(_core.read_file(core_of(machine), path_of(path), options), machine, most)
    return Program(_core.read_text(core_of(machine), _program(text), options), machine, most)


def write_gcode(source: Program | Sequence[Block], machine: Machine | None = None,
                path: str | os.PathLike[str] | None = None) -> str:
    """A program as G-code that reads back to the same motions: mm, absolute, with as many digits as that needs.

    Parameters
    ----------
    source : Program, or a list of blocks (`line`, `arc`)
        Blocks need the machine whose axes they move.
    machine : Machine, optional
    path : optional
        A file that the text is written to, too.

    Raises
    ------
    Error
        A program with problems; a curve; a block that does not begin where the one before ended.
    """
    if isinstance(source, Program):
        problems = source.problems
        if problems:
            raise problems[0]
        text = source._core.write()
    else:
        if machine is None:
            raise TypeError("machine: expected a cncplan.Machine for blocks, got None")
        core = core_of(machine)
        text = _core.write_blocks(core, tuples_of(source, len(machine)))
    if path is not None:
        with open(path_of(path), "w", encoding="utf-8", newline="\n") as file:
            file.write(text)
    return text
