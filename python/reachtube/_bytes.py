"""The versioned bytes of results: a line of JSON that says what they are, and the content."""

from __future__ import annotations

import json
from collections.abc import Iterator
from contextlib import contextmanager
from typing import Any

from .errors import ModelFileError, SettingError

#: Version of these bytes.
VERSION = 1


def checked(data: bytes) -> bytes:
    """Return bytes, and refuse anything else."""
    if not isinstance(data, (bytes, bytearray, memoryview)):
        raise SettingError(f"data is of type {type(data).__name__}; give bytes")
    return bytes(data)


def with_head(kind: type, content: bytes, **more: Any) -> bytes:
    """Return the bytes of a result of a kind; ``more`` stands in the first line too."""
    head = {"format": f"reachtube-python-{kind.__name__}", "version": VERSION, **more}
    return b"\n".join([json.dumps(head).encode(), content])


def without_head(kind: type, data: bytes) -> tuple[dict[str, Any], bytes]:
    """Return the first line and the content of the bytes of a result.

    Raises
    ------
    ModelFileError
        For bytes of another kind or version.
    """
    line, _, content = checked(data).partition(b"\n")
    try:
        head = json.loads(line)
        found = (head["format"], head["version"])
    except (ValueError, KeyError, TypeError):
        head, found = {}, None
    if found != (f"reachtube-python-{kind.__name__}", VERSION):
        raise ModelFileError(
            f"these bytes hold {found}, not {kind.__name__}, version {VERSION}"
        )
    return head, content


@contextmanager
def reading(kind: type) -> Iterator[None]:
    """Name the result in the error if its bytes cannot be read."""
    try:
        yield
    except (AttributeError, KeyError, TypeError, ValueError) as error:
        words = f"these bytes ({kind.__name__}) are damaged: {error}"
        raise ModelFileError(words) from None
