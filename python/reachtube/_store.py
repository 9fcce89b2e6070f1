"""Files in any store that fsspec opens."""

from __future__ import annotations

import time
from typing import Any

from .errors import ReachtubeError

#: How often a store is asked for a file that it does not give, and the first wait between, s.
TRIES, WAIT = 6, 0.2


def read(address: str, storage: dict[str, Any]) -> bytes | None:
    """Return a file's content, or `None` if there is no such file.

    A store that answers slowly or with errors is asked again.
    """
    import fsspec

    for attempt in range(TRIES):
        try:
            with fsspec.open(address, "rb", **storage) as file:
                content: bytes = file.read()
            return content
        except (FileNotFoundError, IsADirectoryError, NotADirectoryError):
            return None
        except OSError as error:
            if attempt + 1 == TRIES:
                raise ReachtubeError(
                    f"{address}: the store did not give it in {TRIES} tries: {error}"
                ) from error
            time.sleep(WAIT * 2**attempt)
    raise AssertionError("the last try returns or raises")


def write(address: str, content: bytes, storage: dict[str, Any]) -> None:
    """Write a file whole: under another name first where a store shows unfinished files."""
    import fsspec

    files, path = fsspec.core.url_to_fs(address, **storage)
    for attempt in range(TRIES):
        try:
            files.makedirs(path.rsplit("/", 1)[0], exist_ok=True)
            if "file" in files.protocol:
                files.pipe_file(f"{path}.part", content)
                files.mv(f"{path}.part", path)
            else:
                files.pipe_file(path, content)
            return
        except OSError as error:
            if attempt + 1 == TRIES:
                raise ReachtubeError(f"{address}: it could not be written: {error}") from error
            time.sleep(WAIT * 2**attempt)
