"""Blocks made by hand: lines, arcs, and curves through points."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace
from typing import Any

import numpy as np

from . import _core
from ._errors import Error, choice, finite, flag, integer, kind, not_negative, positive, row, rows

_PLANES = {"xy": 0, "zx": 1, "yz": 2}
_KINDS = {"line": 0, "arc_center": 1, "arc_radius": 2, "spline": 3}


_ORIGIN = (0.0, 0.0, 0.0)
_NO_CONTROLS = (_ORIGIN, _ORIGIN)


@dataclass(frozen=True)
class Block:
    """One motion: made by `line`, `arc` and `curve`; `dataclasses.replace` changes one. Positions are mm, and rad of
    rotary axes."""

    kind: str
    start: Sequence[float]  #: a tuple, as all that are several numbers
    end: Sequence[float]
    center: Sequence[float] = _ORIGIN
    radius: float = 0.0
    clockwise: bool = False
    plane: str = "xy"
    extra_turns: int = 0
    controls: Sequence[Sequence[float]] = _NO_CONTROLS
    feed: float | None = None
    pause: float = 0.0
    exact_stop: bool = False
    rapid: bool = False
    tolerance: float | None = None
    number: int = 0

    def __post_init__(self) -> None:
        checked: dict[str, Any] = {
            "kind": choice(self.kind, "kind", _KINDS), "start": _place(self.start, "start"), "end": _place(self.end, "end"),
            "radius": finite(self.radius, "radius"), "clockwise": flag(self.clockwise, "clockwise"),
            "plane": choice(self.plane, "plane", _PLANES), "extra_turns": integer(self.extra_turns, "extra_turns", 0),
            "feed": None if self.feed is None else positive(self.feed, "feed"),
            "pause": not_negative(self.pause, "pause"), "exact_stop": flag(self.exact_stop, "exact_stop"),
            "rapid": flag(self.rapid, "rapid"),
            "tolerance": None if self.tolerance is None else not_negative(self.tolerance, "tolerance"),
            "number": integer(self.number, "number", 0)}
        if self.center is not _ORIGIN:
            checked["center"] = tuple(row(self.center, "center", 3))
        if self.controls is not _NO_CONTROLS:
            checked["controls"] = tuple(tuple(point) for point in rows(self.controls, "controls", (2, 3)).tolist())
        for name, value in checked.items():
            object.__setattr__(self, name, value)
        if len(self.start) != len(self.end):
            raise Error(f"end: has {len(self.end)} numbers where start has {len(self.start)}", "malformed", "end",
                        len(self.end), len(self.start))
        if self.kind != "line" and len(self.start) < 3:
            raise Error(f"start: {'a curve' if self.kind == 'spline' else 'an arc'} has X, Y and Z at least", "malformed",
                        "start", len(self.start), 3)
        _core.check_block(self._tuple())

    def _tuple(self) -> tuple[Any, ...]:
        return (_KINDS[self.kind], list(self.start), list(self.end), list(self.center), self.radius, self.clockwise,
                _PLANES[self.plane], self.extra_turns, list(self.controls[0]), list(self.controls[1]), self.feed,
                self.pause, self.exact_stop, self.rapid, self.tolerance, self.number)


def _place(value: Any, name: str) -> tuple[float, ...]:
    array = rows(value, name, (None,))
    if not 1 <= len(array) <= 9:
        raise Error(f"{name}: has {len(array)} numbers, and not 1 to 9", "above_limit", name, len(array), 9)
    return tuple(array.tolist())


def line(start: Sequence[float], end: Sequence[float], *, feed: float | None = None, rapid: bool = False,
         pause: float = 0.0, exact_stop: bool = False, tolerance: float | None = None, number: int = 0) -> Block:
    """Straight from start to end.

    Parameters
    ----------
    start, end : n numbers
        Of each axis; mm, and rad of rotary axes.
    feed : float, optional
        mm/s of the tool (rad/s where only rotary axes move); default: as fast as the limits allow.
    rapid : bool
        At the machine's rapid rate, whatever the feed.
    pause : float
        s at rest behind it.
    exact_stop : bool
        At rest at its end.
    tolerance : float, optional
        mm; how far the tool may leave this block; default: that of the plan.
    number : int
        What samples have as `line`.
    """
    return Block("line", start, end, feed=feed, rapid=rapid, pause=pause, exact_stop=exact_stop, tolerance=tolerance,
                 number=number)


def arc(start: Sequence[float], end: Sequence[float], *, center: Sequence[float] | None = None,
        radius: float | None = None, clockwise: bool = False, plane: str = "xy", extra_turns: int = 0,
        feed: float | None = None, pause: float = 0.0, exact_stop: bool = False, tolerance: float | None = None,
        number: int = 0) -> Block:
    """An arc, or a helix, of X, Y and Z; other axes go along.

    Parameters
    ----------
    start, end : n numbers, n >= 3
        Of each axis; mm, and rad of rotary axes.
    center : 3 numbers, optional
        X Y Z of the centre, mm. A full circle where start and end are one point of the plane.
    radius : float, optional
        In place of the centre: mm; negative asks for the arc of more than half a turn.
    clockwise : bool
        Seen from the positive end of the axis that stands on the plane.
    plane : str
        "xy", "zx" or "yz".
    extra_turns : int
        Whole turns more.
    feed, pause, exact_stop, tolerance, number
        As of `line`.
    """
    if (center is None) == (radius is None):
        raise Error("an arc has either a center or a radius", "conflicting_words", "center")
    more: dict[str, Any] = {"clockwise": clockwise, "plane": plane, "extra_turns": extra_turns, "feed": feed,
                            "pause": pause, "exact_stop": exact_stop, "tolerance": tolerance, "number": number}
    if center is None:
        more["radius"] = radius
        return Block("arc_radius", start, end, **more)
    return Block("arc_center", start, end, **more, center=center)


def curve(points: Sequence[Sequence[float]], *, feed: float | None = None, pause: float = 0.0,
          exact_stop: bool = False, tolerance: float | None = None, number: int = 0) -> list[Block]:
    """The smooth curve through points: one block from each point to the next.

    It is the uniform cubic spline with natural ends, so tangent and curvature go on through every point;
    points at about the same distance from each other make the best curve. Planned exactly it is driven
    through them without a stop, and within a tolerance it may leave them by that.

    Parameters
    ----------
    points : array of n x 3 numbers, n >= 2
        mm.
    feed, tolerance, number
        Of all blocks, as of `line`.
    pause, exact_stop
        Of the last block.
    """
    array = rows(points, "points", (None, 3))
    pieces = _core.spline_through(array)
    blocks = []
    for piece in pieces:
        blocks.append(Block("spline", piece[0], piece[3], controls=piece[1:3], feed=feed, tolerance=tolerance,
                            number=number))
    blocks[-1] = replace(blocks[-1], pause=pause, exact_stop=exact_stop)
    return blocks


def tuples_of(blocks: Any, axes: int) -> list[tuple[Any, ...]]:
    """Of blocks for a machine of so many axes."""
    if isinstance(blocks, (str, bytes, Block)) or not isinstance(blocks, (Sequence, np.ndarray)):
        raise TypeError(f"blocks: expected a list of blocks, got {kind(blocks)}")
    if not len(blocks):
        raise Error("blocks: there is none", "missing_word", "blocks")
    return [tuple_of(block, axes) for block in blocks]


def tuple_of(block: Any, axes: int) -> tuple[Any, ...]:
    if not isinstance(block, Block):
        raise TypeError(f"blocks: expected what line, arc and curve make, got {kind(block)}")
    # A machine of X and Y takes arcs: Z stays where it is.
    if len(block.start) != axes and not (block.kind != "line" and len(block.start) == 3 and axes == 2):
        raise Error(f"block: has {len(block.start)} axes where the machine has {axes}", "malformed", "block",
                    len(block.start), axes)
    return block._tuple()
