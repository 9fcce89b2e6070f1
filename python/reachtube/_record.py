"""Results: frozen values that hold what the product wrote, as text."""

from __future__ import annotations

import json
from typing import Any, TypeVar

from .errors import ModelFileError

Own = TypeVar("Own", bound="Record")

#: Version of the bytes by which results without a file format of their own are pickled.
VERSION = 1


class Record:
    """A frozen result. Two results are equal where the product wrote the same of both."""

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
        head = {"format": f"reachtube-python-{type(self).__name__}", "version": VERSION}
        return json.dumps(head).encode() + b"\n" + self._text.encode()

    @classmethod
    def from_bytes(cls: type[Own], data: bytes) -> Own:
        """Return the result that `to_bytes` wrote.

        Raises
        ------
        ModelFileError
            For other bytes, or those of another version.
        """
        head, _, text = data.partition(b"\n")
        expected = {"format": f"reachtube-python-{cls.__name__}", "version": VERSION}
        try:
            found = json.loads(head)
        except ValueError:
            found = None
        if found != expected:
            raise ModelFileError(f"these bytes are not those of {expected}, but of {found}")
        return cls(text.decode())

    def __reduce__(self) -> tuple[Any, ...]:
        return type(self).from_bytes, (self.to_bytes(),)
