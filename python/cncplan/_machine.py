"""Machines: their axes, the limits of the tool, and what their programs need to know."""

from __future__ import annotations

import json
import math
import os
from collections.abc import Mapping, Sequence
from typing import Any

from . import _core
from ._errors import Error, kind, number, path_of, text_of


def _toml(value: Any, name: str) -> str:
    """A value as TOML writes it."""
    if isinstance(value, bool):
        return "true" if value else "false"
    if isinstance(value, str):
        try:
            value.encode()
        except UnicodeEncodeError:
            raise Error(f"{name}: is no text in UTF-8", "malformed", name) from None
        # TOML has the escapes of JSON, and one more character that needs one
        return json.dumps(value, ensure_ascii=False).replace("\x7f", "\\u007f")
    if isinstance(value, Mapping):
        return "{" + ", ".join(f"{_key(key, name)} = {_toml(item, f'{name}.{key}')}" for key, item in value.items()) + "}"
    if isinstance(value, Axis):
        return _toml(value.entries, name)
    if isinstance(value, (list, tuple)):
        return "[" + ", ".join(_toml(v, name) for v in value) + "]"
    result = number(value, name)
    if not math.isfinite(result):
        raise Error(f"{name}: {result} is not a finite number", "not_finite", name, result)
    return repr(result)


def _key(key: Any, name: str) -> str:
    """Of tools, numbers are keys too."""
    if isinstance(key, int) and not isinstance(key, bool):
        key = str(key)
    return _toml(text_of(key, f"a key of {name}"), name)


class Axis:
    """An axis of a machine.

    Parameters
    ----------
    letter : str
        The word of the program that moves it: "X".
    kind : str
        "linear" or "rotary"; A, B and C are rotary unless said.
    velocity, acceleration, jerk : float
        Its own limits; mm, or degrees for a rotary axis, and s. Not given: no limit.
    travel : (float, float)
        The lowest and the highest position; mm or degrees.
    steps_per_unit : float
        Steps of its motor per mm or degree; negative where the motor is inverted. Default: 400.
    **entries
        The other entries of [[axis]] in a machine file: max_step_rate, pulse_width, pulse_gap,
        direction_setup, direction_hold, backlash, second_motor.
    """

    def __init__(self, letter: str, kind: str | None = None, *, velocity: float | None = None,
                 acceleration: float | None = None, jerk: float | None = None,
                 travel: Sequence[float] | None = None, steps_per_unit: float | None = None,
                 **entries: Any) -> None:
        text_of(letter, "letter")
        if kind is None:
            kind = "rotary" if letter in ("A", "B", "C") else "linear"
        named = {"letter": letter, "kind": kind, "velocity": velocity, "acceleration": acceleration,
                 "jerk": jerk, "travel": travel, "steps_per_unit": steps_per_unit, **entries}
        self.entries: dict[str, Any] = {key: value for key, value in named.items() if value is not None}

    def __repr__(self) -> str:
        return "Axis(" + ", ".join(f"{key}={value!r}" for key, value in self.entries.items()) + ")"


class Machine:
    """A machine: its axes, and the limits of its tool.

    Made from keywords, from a dict of the same names, or from a machine file in TOML
    (docs/machine-file.md has its entries): `Machine(velocity=30, acceleration=1000, jerk=10000)`,
    `Machine({"axis": [{"letter": "X"}, ...]}, velocity=30, ...)`, `Machine("mill.toml", velocity=30, ...)`.
    Entries of rotary axes are degrees and s, as in the file; arrays of positions have rad.

    Parameters
    ----------
    source : str, os.PathLike or dict, optional
        A machine file, or what it would say. A dict may have velocity, acceleration, jerk, and axes in place of
        axis.
    velocity, acceleration, jerk : float
        Limits of the tool; mm/s, mm/s^2, mm/s^3. Not given: no limit.
    axes : list of Axis or dict, optional
        Default: X, Y and Z without limits of their own, with 400 steps per mm.
    rapid_rate, feed_limit : float, optional
        mm/s; default: the velocity.
    dialect : str, optional
        "linuxcnc", "grbl", "fanuc", "marlin" or "mach3".
    **entries
        The other entries of a machine file: unit, tools, offsets, home, pass_through, g18, name; and
        kinematics ("table-table-ac" ...), lengths and start, for a machine whose axes are not the program's
        coordinates: `position` of samples has its axes then, and `tool` of set points X Y Z.
    """

    def __init__(self, source: str | os.PathLike[str] | Mapping[str, Any] | None = None, *,
                 velocity: float | None = None, acceleration: float | None = None, jerk: float | None = None,
                 axes: Sequence[Axis | Mapping[str, Any]] | None = None, rapid_rate: float | None = None,
                 feed_limit: float | None = None, dialect: str | None = None, **entries: Any) -> None:
        given = {"velocity": velocity, "acceleration": acceleration, "jerk": jerk, "axes": axes,
                 "rapid_rate": rapid_rate, "feed_limit": feed_limit, "dialect": dialect, **entries}
        given = {key: value for key, value in given.items() if value is not None}
        limits_only = {key: given.pop(key) for key in ("velocity", "acceleration", "jerk") if key in given}
        name = "machine"
        if source is None or isinstance(source, Mapping):
            named = dict(source or {})
            for key, value in (*given.items(), *limits_only.items()):
                if key in named:
                    raise Error(f"{key}: is there twice", "duplicate", key)
                named[key] = value
            limits_only = {key: named.pop(key) for key in ("velocity", "acceleration", "jerk") if key in named}
            if "axes" in named:
                if "axis" in named:
                    raise Error("axis: is there twice, as axes too", "duplicate", "axis")
                named["axis"] = named.pop("axes")
            if "axis" in named:
                listed = named["axis"]
                if isinstance(listed, (str, bytes, Mapping)) or not isinstance(listed, Sequence):
                    raise TypeError(f"axes: expected a list of Axis or dict, got {kind(listed)}")
                for axis in listed:
                    if not isinstance(axis, (Axis, Mapping)):
                        raise TypeError(f"axes: expected an Axis or a dict, got {kind(axis)}")
                named["axis"] = list(listed)
            text = "".join(f"{_key(key, 'machine')} = {_toml(value, str(key))}\n" for key, value in named.items())
        else:
            if not isinstance(source, (str, os.PathLike)):
                raise TypeError(f"source: expected a path, a dict or nothing, got {kind(source)}")
            if given:
                raise Error(f"{next(iter(given))}: belongs into the machine file", "conflicting_words",
                            next(iter(given)))
            name = path_of(source, "source")
            try:
                with open(name, "rb") as file:
                    text = file.read().decode()
            except (OSError, ValueError):
                raise Error(f"{name}: cannot be read", "unreadable", "file", file=name) from None
        limits = [number(limits_only[key], key) if key in limits_only else math.inf
                  for key in ("velocity", "acceleration", "jerk")]
        try:
            self.__setstate__((text, name, *limits))
        except Error as error:
            if name != "machine" or error.line is None:
                raise
            # places in the text that was made of the keywords mean nothing to the caller
            raise Error("machine: " + str(error).partition(": error: ")[2], error.code, error.field, error.value,
                        error.bound) from None

    def __getstate__(self) -> tuple[Any, ...]:
        """Copies, and other processes, make it anew of its text."""
        return self._made

    def __setstate__(self, made: tuple[Any, ...]) -> None:
        self._made = made
        self._core = _core.Machine(*made)

    @property
    def letters(self) -> str:
        """The letters of the axes, in the order of all arrays: "XYZ"."""
        return self._core.letters

    @property
    def coordinates(self) -> str:
        """The letters of a program: those of the axes, but for a machine with kinematics."""
        return self._core.coordinates

    @property
    def rotary(self) -> tuple[bool, ...]:
        """Of each axis, whether it turns; its positions are rad then."""
        return tuple(self._core.rotary)

    def __len__(self) -> int:
        return len(self.letters)

    def __repr__(self) -> str:
        velocity, acceleration, jerk = self._made[2:]
        return f"<cncplan.Machine {self.letters}, {velocity:g} mm/s, {acceleration:g} mm/s^2, {jerk:g} mm/s^3>"


def core_of(machine: Any) -> Any:
    if not isinstance(machine, Machine):
        raise TypeError(f"machine: expected a cncplan.Machine, got {kind(machine)}")
    return machine._core
