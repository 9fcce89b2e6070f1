"""Results: frozen values that hold what the product wrote, as text."""

from __future__ import annotations

import json
from typing import Any, TypeVar

from ._bytes import reading, with_head, without_head

Own = TypeVar("Own", bound="Record")


class Record:
    """A frozen result. Two results are equal if the product wrote the same of both."""

    __slots__ = ("_content", "_text")
    _text: str
    _content: dict[str, Any]

    def __init__(self, text: str) -> None:
        object.__setattr__(self, "_text", text)
        object.__setattr__(self, "_content", json.loads(text))

    def __setattr__(self, name: str, value: object) -> None:
        raise AttributeError(f"{type(self).__name__} is a result and cannot be changed")

    def __eq__(self, other: object) -> bool:
        return type(other) is type(self) and other._text == self._text

    def __hash__(self) -> int:
        return hash(self._text)

    def to_dict(self) -> dict[str, Any]:
        """Return everything as a new dictionary, with the keys of the command's JSON."""
        content: dict[str, Any] = json.loads(self._text)
        return content

    def to_bytes(self) -> bytes:
        """Return versioned bytes, from which `from_bytes` makes an equal result."""
        return with_head(type(self), self._text.encode())

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
        _, text = without_head(cls, data)
        with reading(cls):
            return cls(text.decode())

    def __reduce__(self) -> tuple[Any, ...]:
        return type(self).from_bytes, (self.to_bytes(),)
