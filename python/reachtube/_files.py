"""Files that are written whole or not at all, and that replace nothing unasked."""

from __future__ import annotations

import os
import tempfile
from pathlib import Path

from .errors import ReachtubeError


def read_text(path: str | os.PathLike[str], command: str) -> str:
    """Return the text of a file that a command wrote."""
    try:
        return Path(path).read_text(encoding="utf-8")
    except (OSError, UnicodeDecodeError) as error:
        raise ReachtubeError(f"{path}: {error}; give a file that `{command}` wrote") from None


def check_new(path: Path, *, force: bool) -> None:
    """Check that nothing of the user's is replaced."""
    if path.exists() and not force:
        raise ReachtubeError(f"{path} exists; give another path, or force=True to replace it")


def write_new(path: Path, text: str, *, force: bool) -> None:
    """Write a text file whole or not at all."""
    check_new(path, force=force)
    try:
        path.parent.mkdir(parents=True, exist_ok=True)
        handle, temporary = tempfile.mkstemp(dir=path.parent, prefix=f".{path.name}.")
        try:
            with open(handle, "w", encoding="utf-8") as file:
                file.write(text)
                file.flush()
                os.fsync(file.fileno())
            # The permissions of mkstemp are for its owner alone.
            mask = os.umask(0)
            os.umask(mask)
            os.chmod(temporary, 0o666 & ~mask)
            os.replace(temporary, path)
        except BaseException:
            os.unlink(temporary)
            raise
    except OSError as error:
        raise ReachtubeError(f"{path} could not be written: {error}") from error
