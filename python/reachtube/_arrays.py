"""Arrays as users have them, as arrays of the product: float64, with checked shapes."""

from __future__ import annotations

import json
import operator
from collections.abc import Iterable, Mapping, Sequence
from os import PathLike, fspath
from typing import Any

import numpy as np
import numpy.typing as npt

from .errors import SettingError

Array = npt.NDArray[np.float64]


def numbers(name: str, values: npt.ArrayLike) -> Array:
    """Return an array of float64 in C order, whatever order, type and library it has."""
    try:
        given = np.asarray(values)
    except ValueError as error:
        raise SettingError(f"{name} is no array of numbers: {error}") from None
    if given.dtype.kind not in "fiub":
        raise SettingError(f"{name} has the type {given.dtype}; give real numbers")
    return np.ascontiguousarray(given, dtype=np.float64)


def samples(name: str, values: npt.ArrayLike, shape: tuple[int, int]) -> Array:
    """Return an array with one row for each sample and one column for each joint."""
    array = numbers(name, values)
    if array.shape != shape:
        raise SettingError(
            f"{name} has the shape {array.shape}, but {shape} is needed: one row for each sample, "
            "one column for each joint"
        )
    return array


def batch(n: int, **arguments: npt.ArrayLike) -> tuple[tuple[int, ...], list[Array]]:
    """Broadcast arguments of shape (..., n) against each other.

    Returns the leading shape, and each argument with one row for each state.
    """
    arrays = []
    for name, values in arguments.items():
        array = numbers(name, values)
        if array.ndim == 0 or array.shape[-1] != n:
            raise SettingError(
                f"{name} has the shape {array.shape}; its last axis needs {n} entries, one for "
                "each joint"
            )
        arrays.append(array)
    try:
        leading = np.broadcast_shapes(*(array.shape[:-1] for array in arrays))
    except ValueError:
        shapes = ", ".join(f"{name} {np.shape(values)}" for name, values in arguments.items())
        raise SettingError(f"these shapes do not fit together: {shapes}") from None
    return leading, [
        np.ascontiguousarray(np.broadcast_to(array, (*leading, n))).reshape(-1, n)
        for array in arrays
    ]


def whole(name: str, value: int, least: int = 0, most: int = 2**63 - 1) -> int:
    """Return a whole number between two bounds."""
    try:
        number = operator.index(value)
    except TypeError:
        kind = type(value).__name__
        raise SettingError(f"{name} is {value!r} of type {kind}; give a whole number") from None
    if not least <= number <= most:
        raise SettingError(f"{name} is {number}; give {least} to {most}")
    return number


def real(name: str, value: float) -> float:
    """Return one real number."""
    array = numbers(name, value)
    if np.ndim(value) > 0:
        raise SettingError(f"{name} has the shape {array.shape}; give one number")
    return float(array[0])


def above_zero(name: str, value: float, unit: str = "s") -> float:
    """Return one finite number above 0."""
    number = real(name, value)
    if not 0 < number < float("inf"):
        raise SettingError(f"{name} is {number} {unit}; give a finite number above 0")
    return number


def check_choice(name: str, value: object, options: Sequence[str]) -> None:
    """Check that an argument is one of some words."""
    if value not in options:
        words = " or ".join(repr(option) for option in options)
        raise SettingError(f"{name} is {value!r}; give {words}")


def finite(name: str, values: npt.ArrayLike) -> list[float]:
    """Return finite numbers as a list."""
    array = numbers(name, values).ravel()
    if not np.isfinite(array).all():
        raise SettingError(f"{name} is {array.tolist()}; give finite numbers")
    return [float(value) for value in array]


def json_of(name: str, values: object) -> str:
    """Return the JSON of what a user gives, in which arrays are lists and paths are text."""
    try:
        return json.dumps(values, default=_plain, allow_nan=False)
    except (TypeError, ValueError) as error:
        raise SettingError(f"{name}: {error}") from None


def _plain(value: object) -> object:
    if isinstance(value, PathLike):
        return fspath(value)
    tolist = getattr(value, "tolist", None)
    if tolist is None:
        raise TypeError(f"{value!r} is of type {type(value).__name__}")
    return tolist()


def mapping(name: str, values: Mapping[str, Any]) -> dict[str, Any]:
    """Return a new dictionary of what a user gives by name."""
    if not isinstance(values, Mapping):
        raise SettingError(f"{name} is of type {type(values).__name__}; give a dictionary")
    return dict(values)


def label(name: str, value: str | None) -> str | None:
    """Return a name, or nothing."""
    if value is not None and not isinstance(value, str):
        raise SettingError(f"{name} is {value!r} of type {type(value).__name__}; give a text")
    return value


def frozen(array: Array) -> Array:
    """Return the array, which can no longer be written to."""
    array.flags.writeable = False
    return array


def names(values: str | Sequence[str] | None) -> list[str]:
    """Return a list of names; one name may stand alone."""
    if values is None:
        return []
    if isinstance(values, str):
        return [values]
    if not isinstance(values, Iterable) or not all(isinstance(value, str) for value in values):
        raise SettingError(f"{values!r} is no name and no list of names")
    return list(values)


def array_of(values: Any) -> Array:
    """Return numbers of a file as an array that cannot be written to."""
    return frozen(np.array(values, dtype=np.float64))
