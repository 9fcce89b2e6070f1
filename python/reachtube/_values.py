"""Results made of arrays: frozen values that are compared, hashed and pickled to the last bit."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import fields
from typing import Any, TypeVar

import numpy as np

from ._arrays import frozen
from ._bytes import reading, with_head, without_head

Own = TypeVar("Own", bound="Values")


class Values:
    """Base of frozen dataclasses whose fields are arrays of float64 and what JSON has.

    The arrays cannot be written to. Two results are equal if their numbers are, to the last bit;
    -0 differs from 0, and NaN equals itself.
    """

    def __post_init__(self) -> None:
        for name, value in self._items():
            if isinstance(value, np.ndarray):
                # A user's own array stays as it is.
                own = np.array(value, np.float64) if value.flags.writeable else value
                object.__setattr__(self, name, frozen(own))

    def _items(self) -> Iterator[tuple[str, Any]]:
        names = (field.name for field in fields(self))  # type: ignore[arg-type, unused-ignore]
        return ((name, getattr(self, name)) for name in names)

    def __eq__(self, other: object) -> bool:
        if type(other) is not type(self):
            return NotImplemented
        return self.to_bytes() == other.to_bytes()

    def __hash__(self) -> int:
        return hash(self.to_bytes())

    def to_dict(self) -> dict[str, Any]:
        """Return everything as a new dictionary."""
        return dict(self._items())

    def to_bytes(self) -> bytes:
        """Return versioned bytes, from which `from_bytes` makes an equal result."""
        shapes, values, numbers = {}, {}, []
        for name, value in self._items():
            if isinstance(value, np.ndarray):
                shapes[name] = value.shape
                numbers.append(value.astype("<f8").tobytes())
            else:
                values[name] = value
        return with_head(type(self), b"".join(numbers), shapes=shapes, values=values)

    @classmethod
    def from_bytes(cls: type[Own], data: bytes) -> Own:
        """Return the result that `to_bytes` wrote.

        Parameters
        ----------
        data
            The bytes, as `to_bytes` returns them.

        Returns
        -------
        object of this class

        Raises
        ------
        ModelFileError
            For other bytes, damaged bytes, or bytes of another version.
        """
        head, rest = without_head(cls, data)
        with reading(cls):
            flat, place = np.frombuffer(rest, "<f8").astype(np.float64), 0
            content = {
                name: tuple(value) if isinstance(value, list) else value
                for name, value in head["values"].items()
            }
            for name, shape in head["shapes"].items():
                size = int(np.prod(shape, dtype=np.int64))
                content[name] = frozen(flat[place : place + size].reshape(shape).copy())
                place += size
            if place != len(flat):
                raise ValueError(f"{len(flat) - place} numbers too many")
            return cls(**content)

    def __reduce__(self) -> tuple[Any, ...]:
        return type(self).from_bytes, (self.to_bytes(),)
