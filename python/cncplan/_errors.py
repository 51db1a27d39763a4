"""The exception of the module, and the checks of what is handed to it."""

from __future__ import annotations

import math
import os
from collections.abc import Iterable
from typing import Any

import numpy as np


class Error(ValueError):
    """What is wrong with an input, and where.

    Attributes
    ----------
    code : str
        The kind of fault: "above_limit", "not_finite", "radius_mismatch" ...; names do not change.
    field : str
        The parameter, word or axis at fault.
    value, bound : float
        The number at fault, and the bound that it breaks; 0 where there is none.
    line, column : int or None
        The place in a program or a machine file, counted from 1.
    file : str or None
    block : int or None
        Of blocks made by hand: which one, counted from 0.
    """

    def __init__(self, text: str, code: str = "malformed", field: str = "", value: float = 0.0,
                 bound: float = 0.0, line: int | None = None, column: int | None = None,
                 file: str | None = None, block: int | None = None) -> None:
        super().__init__(text)
        self.code = code
        self.field = field
        self.value = value
        self.bound = bound
        self.line = line
        self.column = column
        self.file = file
        self.block = block

    def __reduce__(self) -> tuple[Any, ...]:
        return (type(self), (str(self), self.code, self.field, self.value, self.bound, self.line, self.column,
                             self.file, self.block))


def kind(value: object) -> str:
    return type(value).__name__


def number(value: Any, name: str) -> float:
    """The value as a float; TypeError for what is no number."""
    if isinstance(value, (bool, np.bool_, str, bytes)):
        raise TypeError(f"{name}: expected a number, got {kind(value)}")
    try:
        return float(value)
    except (TypeError, ValueError):
        raise TypeError(f"{name}: expected a number, got {kind(value)}") from None
    except OverflowError:
        raise Error(f"{name}: is not a finite number", "not_finite", name, math.inf) from None


def finite(value: Any, name: str) -> float:
    result = number(value, name)
    if not math.isfinite(result):
        raise Error(f"{name}: {result} is not a finite number", "not_finite", name, result)
    return result


def positive(value: Any, name: str) -> float:
    """A finite number above 0."""
    result = finite(value, name)
    if not result > 0.0:
        raise Error(f"{name}: {result} must be greater than zero", "not_positive", name, result)
    return result


def not_negative(value: Any, name: str) -> float:
    result = finite(value, name)
    if result < 0.0:
        raise Error(f"{name}: {result} must not be negative", "negative", name, result)
    return result


def integer(value: Any, name: str, low: int = -2**31, high: int = 2**31 - 1) -> int:
    if isinstance(value, (bool, np.bool_)) or not isinstance(value, (int, np.integer)):
        raise TypeError(f"{name}: expected a whole number, got {kind(value)}")
    for code, sentence, wrong, bound in (("below_limit", "is below the limit", value < low, low),
                                         ("above_limit", "is above the limit", value > high, high)):
        if wrong:
            found = float(value) if abs(int(value)) < 2**1000 else math.copysign(math.inf, 1 if value > 0 else -1)
            raise Error(f"{name}: {found:g} {sentence} {bound}", code, name, found, float(bound))
    return int(value)


def flag(value: Any, name: str) -> bool:
    if not isinstance(value, (bool, np.bool_)):
        raise TypeError(f"{name}: expected True or False, got {kind(value)}")
    return bool(value)


def text_of(value: Any, name: str) -> str:
    if not isinstance(value, str):
        raise TypeError(f"{name}: expected a str, got {kind(value)}")
    return value


def path_of(value: Any, name: str = "path") -> str:
    """The name of a file as UTF-8 text has it."""
    if not isinstance(value, (str, os.PathLike)):
        raise TypeError(f"{name}: expected a path (str or os.PathLike), got {kind(value)}")
    result = os.fsdecode(os.fspath(value))
    try:
        result.encode()
    except UnicodeEncodeError:
        raise Error(f"{name}: is no text in UTF-8", "unreadable", name) from None
    return result


def choice(value: Any, name: str, choices: Iterable[str]) -> str:
    choices = tuple(choices)
    if not isinstance(value, str):
        raise TypeError(f"{name}: expected one of {', '.join(map(repr, choices))}, got {kind(value)}")
    if value not in choices:
        raise Error(f"{name}: {value!r} is none of {', '.join(map(repr, choices))}", "not_supported", name)
    return value


def row(value: Any, name: str, count: int) -> list[float]:
    """So many finite numbers."""
    return rows(value, name, (count,)).tolist()


def rows(value: Any, name: str, shape: tuple[int | None, ...]) -> np.ndarray:
    """Finite numbers in a shape; None stands for any count."""
    shown = " x ".join("n" if n is None else str(n) for n in shape)
    expected = f"{name}: expected an array of {shown} numbers, got "
    if isinstance(value, (str, bytes)):
        raise TypeError(expected + kind(value))
    try:
        array = np.asarray(value)
        if array.dtype.kind not in "iuf":
            if array.dtype.kind != "O" and array.size:
                raise TypeError(expected + f"{array.dtype}")
            array = array.astype(float)
        array = np.ascontiguousarray(array, dtype=float)
    except TypeError:
        raise TypeError(expected + kind(value)) from None
    except (ValueError, OverflowError):
        raise TypeError(expected + f"{kind(value)} of other shape or content") from None
    if array.ndim != len(shape) or any(n is not None and n != m for n, m in zip(shape, array.shape)):
        raise Error(expected + f"the shape {array.shape}", "malformed", name)
    if not np.isfinite(array).all():
        raise Error(f"{name}: has a number that is not finite", "not_finite", name, math.nan)
    return array
