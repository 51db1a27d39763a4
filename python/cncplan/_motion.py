"""Axes from one state to another, and profiles along a path."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np

from . import _core
from ._errors import Error, choice, integer, kind, not_negative, number, row, rows
from ._machine import Machine, core_of

_SYNCHRONIZATIONS = ("time", "phase", "none")
_MOST_AXES = 9
PHASE_DTYPE = np.dtype([("time", "f8"), ("duration", "f8"), ("position", "f8"), ("velocity", "f8"),
                        ("acceleration", "f8"), ("jerk", "f8")])


@dataclass(frozen=True)
class State:
    """Where the axes are and how they move; mm, rad and s. What is not given is 0."""

    position: Any
    velocity: Any = None
    acceleration: Any = None


def _times(t: Any) -> np.ndarray:
    if np.ndim(t) == 0:
        times = np.array([number(t, "t")])
    else:
        times = np.asarray(t)
        if times.ndim != 1 or times.dtype.kind not in "iuf":
            raise TypeError(f"t: expected a number or an array of n numbers, got {kind(t)}")
        times = np.ascontiguousarray(times, dtype=float)
    if np.isnan(times).any():
        raise Error("t: is not a finite number", "not_finite", "t", np.nan)
    return times


def _state_at(core: Any, t: float | Sequence[float] | np.ndarray, axes: int) -> State:
    found = core.at(_times(t), axes)
    return State(*(array[0] if np.ndim(t) == 0 else array for array in found))


class Motion:
    """The motion of all axes, from 0 to `duration`."""

    def __init__(self, core: Any, axes: int) -> None:
        self._core = core
        self._axes = axes

    @property
    def duration(self) -> float:
        """s, of the axis that moves longest."""
        return self._core.duration()

    @property
    def durations(self) -> np.ndarray:
        """(axes,) s, of each axis."""
        return self._core.durations(self._axes)

    def at(self, t: float | Sequence[float] | np.ndarray) -> State:
        """All axes at t seconds: arrays of shape (axes,), or (n, axes) for n instants. Behind the end they keep
        the velocity that they have come to."""
        return _state_at(self._core, t, self._axes)


def _rows(state: Any, name: str, machine: Machine) -> list[list[float]]:
    n = len(machine)
    if not isinstance(state, State):
        state = State(state)
    return [[0.0] * n if value is None else row(value, f"{part} of {name}", n)
            for part, value in (("position", state.position), ("velocity", state.velocity),
                                ("acceleration", state.acceleration))]


def move_to(start: State | Sequence[float], target: State | Sequence[float], machine: Machine,
            synchronization: str = "time", minimum_duration: float = 0.0) -> Motion:
    """The fastest motion of the machine's axes from one state to another, each within its own limits; those of
    the tool do not act.

    Parameters
    ----------
    start, target : State, or the positions of axes at rest
        n numbers each; mm, rad and s.
    machine : Machine
        Each axis needs a velocity, and an acceleration or a jerk.
    synchronization : str
        "time": all axes arrive together; "phase": on a straight line where that costs no time; "none": each as
        soon as it can.
    minimum_duration : float
        s, >= 0.
    """
    core = core_of(machine)
    return Motion(_core.move_to(core, _rows(start, "start", machine), _rows(target, "target", machine),
                                _SYNCHRONIZATIONS.index(choice(synchronization, "synchronization",
                                                               _SYNCHRONIZATIONS)),
                                not_negative(minimum_duration, "minimum_duration")), len(machine))


def reach_velocity(start: State | Sequence[float], velocities: Sequence[float], machine: Machine,
                   synchronization: str = "time", minimum_duration: float = 0.0) -> Motion:
    """The fastest motion of the axes to velocities (mm/s, rad/s), which they keep until the end of their travel;
    to zero, the fastest stop. Parameters as of `move_to`."""
    core = core_of(machine)
    return Motion(_core.reach_velocity(core, _rows(start, "start", machine),
                                       row(velocities, "velocities", len(machine)),
                                       _SYNCHRONIZATIONS.index(choice(synchronization, "synchronization",
                                                                      _SYNCHRONIZATIONS)),
                                       not_negative(minimum_duration, "minimum_duration")), len(machine))


@dataclass(frozen=True)
class ProfileState:
    """Motion along a path: s (mm), v (mm/s), a (mm/s^2) and j (mm/s^3); numbers, or arrays of n."""

    s: Any
    v: Any
    a: Any
    j: Any


def _along(found: tuple[np.ndarray, ...], t: float | Sequence[float] | np.ndarray) -> ProfileState:
    return ProfileState(*(array[0].item() if np.ndim(t) == 0 else array for array in found))


class Profile:
    """A change of position along a path, between two speeds."""

    def __init__(self, core: Any) -> None:
        self._core = core

    @property
    def duration(self) -> float:
        """s"""
        return self._core.duration()

    @property
    def phases(self) -> np.ndarray:
        """The seven phases of constant jerk, those left out with duration 0, as a structured array: time and
        duration (s), position (mm), velocity, acceleration and jerk at its start."""
        return np.asarray(self._core.phases()).view(PHASE_DTYPE)

    def at(self, t: float | Sequence[float] | np.ndarray) -> ProfileState:
        """The motion at t seconds, or at n instants."""
        return _along(self._core.at(_times(t)), t)


class CurveMotion:
    """The motion of axes along a smooth curve through points, from 0 to `duration`."""

    def __init__(self, core: Any, axes: int) -> None:
        self._core = core
        self._axes = axes

    @property
    def duration(self) -> float:
        """s"""
        return self._core.duration()

    @property
    def parameters(self) -> np.ndarray:
        """(n,) the curve's parameter at each of the points, from 0 on."""
        return self._core.knots()

    @property
    def phases(self) -> np.ndarray:
        """The phases of constant jerk of the curve's parameter, as a structured array: as `Profile.phases`."""
        return np.asarray(self._core.phases()).view(PHASE_DTYPE)

    def along(self, t: float | Sequence[float] | np.ndarray) -> ProfileState:
        """The curve's parameter and its time derivatives at t seconds, or at n instants."""
        return _along(self._core.along(_times(t)), t)

    def at(self, t: float | Sequence[float] | np.ndarray) -> State:
        """All axes at t seconds: arrays of shape (axes,), or (n, axes) for n instants."""
        return _state_at(self._core, t, self._axes)


def time_optimal(points: Sequence[Sequence[float]] | np.ndarray, machine: Machine | None = None, *,
                 velocity: float | Sequence[float] | None = None,
                 acceleration: float | Sequence[float] | None = None, jerk: float | Sequence[float] | None = None,
                 parameters: Sequence[float] | np.ndarray | None = None, start: float = 0.0, end: float = 0.0,
                 gap: float = 3e-4) -> CurveMotion:
    """The fastest motion along the cubic spline through points, under limits of velocity, acceleration and jerk,
    which it provably keeps everywhere: those of a machine, of its tool and of each axis, or limits of axes alone.

    The spline is natural: its second derivative is 0 at both ends.

    Parameters
    ----------
    points : (n, axes)
        Two at least, of all axes, nine at most; mm and rad.
    machine : Machine, optional
        The tool or all of X, Y, Z need limits, and each other axis that moves.
    velocity, acceleration, jerk : float or (axes,)
        Instead of a machine: limits of all axes, or of each; mm, rad and s.
    parameters : (n,), optional
        Where the points are on the curve, ascending, of any unit. Without them as far apart as the points.
    start, end : float
        Velocities of the parameter at both ends, without acceleration; 0: at rest.
    gap : float
        How far from the least time the search may end, as a share of it, > 0.
    """
    own = {"velocity": velocity, "acceleration": acceleration, "jerk": jerk}
    missing = [name for name, value in own.items() if value is None]
    if len(missing) != (0 if machine is None else 3):
        raise TypeError("limits: expected a machine, or velocity, acceleration and jerk")
    given = rows(points, "points", (None, None if machine is None else len(machine)))
    axes = given.shape[1]
    if axes > _MOST_AXES:
        raise Error(f"points: {axes} axes are more than {_MOST_AXES}", "above_limit", "points", float(axes),
                    float(_MOST_AXES))
    limits: Any = core_of(machine) if machine is not None else [
        row([value] * axes if np.ndim(value) == 0 else value, name, axes) for name, value in own.items()]
    at = [] if parameters is None else rows(parameters, "parameters", (len(given),)).tolist()
    return CurveMotion(_core.time_optimal(limits, given, at, not_negative(start, "start"),
                                          not_negative(end, "end"), number(gap, "gap")), axes)


def profile(length: float, start: float = 0.0, end: float = 0.0, *, velocity: float, acceleration: float,
            jerk: float, phases: int = 7) -> Profile:
    """The fastest profile over a length between two speeds, with no acceleration at both ends.

    Parameters
    ----------
    length : float
        mm, >= 0.
    start, end : float
        Speeds, mm/s, >= 0 and within the velocity.
    velocity, acceleration, jerk : float
        Limits; mm/s, mm/s^2, mm/s^3.
    phases : int
        7: the fastest of all. 5: without a phase of constant acceleration (KK22, section 3.1).
    """
    if integer(phases, "phases") not in (5, 7):
        raise Error(f"phases: {phases} is neither 5 nor 7", "not_supported", "phases", phases)
    return Profile(_core.profile(number(length, "length"), number(start, "start"), number(end, "end"),
                                 number(velocity, "velocity"), number(acceleration, "acceleration"),
                                 number(jerk, "jerk"), phases == 5))
