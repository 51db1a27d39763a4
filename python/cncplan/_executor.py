"""A controller that is stepped in a loop."""

from __future__ import annotations

import math
from collections.abc import Sequence
from typing import Any

from . import _core
from ._blocks import Block, tuple_of
from ._errors import Error, finite, flag, integer, kind, not_negative, number, positive, row
from ._machine import Machine, core_of
from ._trajectory import SetPoint, options_of


class Executor:
    """Runs a program on a machine: lines or blocks go in, and each tick gives a set point.

    A request acts at the next tick, whatever the motion is at. The tool and every axis keep their limits.
    Look-ahead reaches over 256 pieces of path.

    Parameters
    ----------
    machine : Machine
    tolerance, rotary_tolerance, junction_deviation, start
        As of `plan_file`.
    level : str
        "exact", "fast", "good" or "best", as of `plan_file`. At "good" and "best" parts of the program are planned
        within `push`, `tick` and `end_of_program`, which take some tens of milliseconds then; an override above 1
        acts at once where limits leave room, and `horizon` ahead at corners too; a lower one slows the whole motion;
        `reverse` goes back to the first rest that is kept; `restart` begins where the line begins.
    longest_wait : float
        s at rest for which blocks are held back for the ones that follow them.
    quick_stop_share : float
        1 to 1000: how many times its limits of acceleration and jerk the machine may use in a quick stop.
    reserve : float
        >= 0, < 1: the share of the limits that plans at "good" and "best" leave for holds.
    hold_factor : float
        > 1, or 0: how many times the least that a brake takes a hold may take at "good" and "best". Plans are
        slower where it would take longer; 0 asks for no such plan.
    most_override : float
        >= 1: the highest override of the feed.
    horizon : float
        > 0: s of motion that plans at "good" and "best" are ahead. The shorter, the sooner a higher feed acts at
        corners, and the longer the program takes.

    Examples
    --------
    >>> executor = cncplan.Executor(machine)
    >>> for text in program:
    ...     while not executor.push(text):
    ...         point = executor.tick(0.001)
    >>> executor.end_of_program()
    >>> while not executor.finished:
    ...     point = executor.tick(0.001)
    """

    def __init__(self, machine: Machine, tolerance: float = 0.01, level: str = "fast", *,
                 rotary_tolerance: float = 0.05, junction_deviation: float = 0.01,
                 start: Sequence[float] | None = None, longest_wait: float = 0.05, quick_stop_share: float = 1.0,
                 reserve: float = 0.02, hold_factor: float = 1.5, most_override: float = 2.0,
                 horizon: float = 5.0) -> None:
        options = options_of(machine, tolerance, rotary_tolerance, junction_deviation, start, level)
        self._core = _core.Executor(core_of(machine), options, not_negative(longest_wait, "longest_wait"),
                                    finite(quick_stop_share, "quick_stop_share"), finite(reserve, "reserve"),
                                    finite(hold_factor, "hold_factor"), finite(most_override, "most_override"),
                                    finite(horizon, "horizon"))
        self.machine = machine
        self.level = level  #: what was asked for

    def push(self, item: str | Block) -> bool:
        """Takes the next line of the program, or a block. False: there is no room, and nothing was taken; push it
        again behind the next tick. Error: the line is wrong, and is not taken."""
        if isinstance(item, Block):
            return self._core.push_block(tuple_of(item, len(self.machine)))
        if not isinstance(item, str):
            raise TypeError(f"item: expected a line (str) or a block, got {kind(item)}")
        line = item.encode(errors="surrogatepass")
        ended = line.rstrip(b"\r\n")
        if b"\n" in ended or b"\r" in ended:
            raise Error("item: has more than one line", "malformed", "item")
        return self._core.push_line(ended)

    def end_of_program(self) -> None:
        """Nothing will follow: lines that are pushed behind this are errors, until `restart`."""
        self._core.end_of_program()

    def tick(self, period: float) -> SetPoint:
        """Moves on by `period` seconds, > 0, and gives the set point there."""
        *point, words, feed = self._core.tick(positive(period, "period"))
        return SetPoint(*point, words=tuple(words), feed=feed)  # type: ignore[misc]  # all but the words

    @property
    def finished(self) -> bool:
        """Whether the program is over: all has been run and nothing will follow, or it was stopped, or came to
        rest before a block that cannot be planned (`error`)."""
        return self._core.finished()

    @property
    def error(self) -> Error | None:
        """Why the program ended before its end."""
        found = self._core.error()
        return None if found is None else Error(*found)

    @property
    def state(self) -> str:
        """What it is doing: "moving", "holding" (on the way to a rest that was asked for), "held" (at rest until it is
        resumed), "dwelling", "stopped" (at M0, M1 or M60 until it is resumed), "jogging", "away" (at rest beside the
        path), "waiting" (for blocks), "fault" (`error` says why) or "finished"."""
        return self._core.state()

    @property
    def warnings(self) -> list[str]:
        """What the last line has that has no effect."""
        return self._core.warnings()

    @property
    def pushed(self) -> int:
        """How many blocks have been taken."""
        return self._core.pushed()

    @property
    def time(self) -> float:
        """s that all ticks add up to."""
        return self._core.time()

    @property
    def until_change(self) -> float:
        """s until the jerk changes next, if nothing is asked for and no block comes; infinity at rest."""
        return self._core.until_change()

    @property
    def rested(self) -> float:
        """s since there was nothing more to run."""
        return self._core.rested()

    @property
    def worst_hold(self) -> float | None:
        """s: at "good" and "best" with a `hold_factor`, no hold that is asked for at the planned speed takes longer,
        along what has been planned. Else None."""
        return self._core.worst_hold()

    def feed_hold(self) -> None:
        """Comes to rest as soon as the limits allow; `resume` goes on."""
        self._core.feed_hold()

    def resume(self) -> None:
        """Goes on behind a hold and every other rest; after a jog, back on the path first."""
        self._core.resume()

    def feed_override(self, share: float) -> None:
        """Share of the programmed feed, 0 to `most_override`; values outside are cut, 0 is a hold."""
        self._core.feed_override(finite(share, "share"))

    def rapid_override(self, share: float) -> None:
        """Share of the rapid rate, 0 to 1; values outside are cut."""
        self._core.rapid_override(finite(share, "share"))

    def stop(self) -> None:
        """Comes to rest, and the program ends there."""
        self._core.stop()

    def quick_stop(self) -> None:
        """Comes to rest with `quick_stop_share` times the limits of acceleration and jerk."""
        self._core.quick_stop()

    def reverse(self, wanted: bool = True) -> None:
        """Runs back along the path, as far as blocks are kept, or forwards again."""
        self._core.reverse(flag(wanted, "wanted"))

    def single_step(self, wanted: bool = True) -> None:
        """Rests behind every block that moves or dwells until it is resumed."""
        self._core.single_step(flag(wanted, "wanted"))

    def optional_stop(self, wanted: bool = True) -> None:
        """Rests at M1 until it is resumed."""
        self._core.optional_stop(flag(wanted, "wanted"))

    def program_stop(self, wanted: bool = True) -> None:
        """Rests at M0 and M60 until it is resumed, which it does unless this is switched off."""
        self._core.program_stop(flag(wanted, "wanted"))

    def pause_at(self, line: int) -> None:
        """Rests before a line that moves until it is resumed. 0: none."""
        self._core.pause_at(integer(line, "line", 0))

    def jog(self, velocities: Sequence[float]) -> None:
        """While no program moves the axes, they come to velocities (mm/s, rad/s), which they keep until another
        request or the end of their travel. Error: a program moves them; velocities beyond the limits."""
        self._core.jog(row(velocities, "velocities", len(self.machine)))

    def jog_to(self, positions: Sequence[float], speeds: Sequence[float] | None = None, *,
               tool_speed: float = math.inf) -> None:
        """While no program moves the axes, they go to positions (mm, rad): each no faster than its own of `speeds`
        (mm/s, rad/s; > 0), and X Y Z together no faster than `tool_speed` (mm/s, > 0)."""
        self._core.jog_to(row(positions, "positions", len(self.machine)), self._speeds(speeds),
                          number(tool_speed, "tool_speed"))

    def jog_by(self, increments: Sequence[float], speeds: Sequence[float] | None = None, *,
               tool_speed: float = math.inf) -> None:
        """The axes go so much further (mm, rad): from where a jog to positions goes, or else from where they are
        now. Speeds as of `jog_to`."""
        self._core.jog_by(row(increments, "increments", len(self.machine)), self._speeds(speeds),
                          number(tool_speed, "tool_speed"))

    def _speeds(self, speeds: Sequence[float] | None) -> list[float]:
        return [] if speeds is None else row(speeds, "speeds", len(self.machine))

    def return_to_path(self) -> None:
        """The axes go back to where the program was left; `resume` does this too."""
        self._core.return_to_path()

    def restart(self, line: int, position: Sequence[float]) -> bool:
        """At rest: forgets all blocks, a stop and an error. The program is pushed again from its first line; what
        comes before the first block of a line (0: nothing) is passed over, and the motion begins where that
        block passes the position (mm, rad) at which the axes stand. False, and nothing done, where the machine
        moves."""
        return self._core.restart(integer(line, "line", 0), row(position, "position", len(self.machine)))
