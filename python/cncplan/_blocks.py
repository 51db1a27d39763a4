"""Blocks made by hand: lines, arcs, and curves through points."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace
from typing import Any

import numpy as np

from . import _core
from ._errors import Error, choice, finite, flag, integer, kind, not_negative, positive, rows

_PLANES = {"xy": 0, "zx": 1, "yz": 2}
_KINDS = {"line": 0, "arc_center": 1, "arc_radius": 2, "spline": 3}


@dataclass(frozen=True)
class Block:
    """One motion: made by `line`, `arc` and `curve`. Positions are mm, and rad of rotary axes."""

    kind: str
    start: tuple[float, ...]
    end: tuple[float, ...]
    center: tuple[float, float, float] = (0.0, 0.0, 0.0)
    radius: float = 0.0
    clockwise: bool = False
    plane: str = "xy"
    extra_turns: int = 0
    controls: tuple[tuple[float, float, float], tuple[float, float, float]] = ((0.0, 0.0, 0.0), (0.0, 0.0, 0.0))
    feed: float | None = None
    pause: float = 0.0
    exact_stop: bool = False
    rapid: bool = False
    tolerance: float | None = None
    number: int = 0

    def _tuple(self) -> tuple[Any, ...]:
        return (_KINDS[self.kind], list(self.start), list(self.end), list(self.center), self.radius, self.clockwise,
                _PLANES[self.plane], self.extra_turns, list(self.controls[0]), list(self.controls[1]), self.feed,
                self.pause, self.exact_stop, self.rapid, self.tolerance, self.number)


def _place(value: Any, name: str) -> tuple[float, ...]:
    array = rows(value, name, (None,))
    if not 1 <= len(array) <= 9:
        raise Error(f"{name}: has {len(array)} numbers, and not 1 to 9", "above_limit", name, len(array), 9)
    return tuple(array.tolist())


def _made(kind_of: str, start: Any, end: Any, *, feed: Any, pause: Any, exact_stop: Any, tolerance: Any,
          number: Any, rapid: Any = False, **more: Any) -> Block:
    first, last = _place(start, "start"), _place(end, "end")
    if len(first) != len(last):
        raise Error(f"end: has {len(last)} numbers where start has {len(first)}", "malformed", "end", len(last),
                    len(first))
    block = Block(kind_of, first, last, feed=None if feed is None else positive(feed, "feed"),
                  pause=not_negative(pause, "pause"), exact_stop=flag(exact_stop, "exact_stop"),
                  rapid=flag(rapid, "rapid"),
                  tolerance=None if tolerance is None else not_negative(tolerance, "tolerance"),
                  number=integer(number, "number", 0), **more)
    _core.check_block(block._tuple())
    return block


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
    return _made("line", start, end, feed=feed, rapid=rapid, pause=pause, exact_stop=exact_stop,
                 tolerance=tolerance, number=number)


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
    if len(_place(start, "start")) < 3:
        raise Error("start: an arc has X, Y and Z at least", "malformed", "start")
    more: dict[str, Any] = {"clockwise": flag(clockwise, "clockwise"), "plane": choice(plane, "plane", _PLANES),
                            "extra_turns": integer(extra_turns, "extra_turns", 0)}
    if center is not None:
        more["center"] = tuple(rows(center, "center", (3,)).tolist())
    else:
        more["radius"] = finite(radius, "radius")
    return _made("arc_radius" if center is None else "arc_center", start, end, feed=feed, pause=pause,
                 exact_stop=exact_stop, tolerance=tolerance, number=number, **more)


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
    for i, piece in enumerate(pieces):
        second, third = (tuple(control) for control in piece[1:3].tolist())
        blocks.append(_made("spline", piece[0], piece[3], feed=feed, pause=0.0, exact_stop=False,
                            tolerance=tolerance, number=number, controls=(second, third)))
    blocks[-1] = replace(blocks[-1], pause=not_negative(pause, "pause"), exact_stop=flag(exact_stop, "exact_stop"))
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
