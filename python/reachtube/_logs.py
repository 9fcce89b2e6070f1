"""Logs: recordings as they are, from paths or from memory."""

from __future__ import annotations

from collections.abc import Iterable
from os import PathLike, fspath
from pathlib import Path
from typing import TypeAlias

from . import _reachtube
from ._recordings import Recordings, Run
from .errors import SettingError

#: Logs: CSV files, MCAP, rosbag2 and folders of them by their paths, runs, or a data set.
Logs: TypeAlias = (
    "Recordings | Run | str | PathLike[str] | Iterable[Run | str | PathLike[str]]"
)


def parts_of(data: Logs) -> tuple[list[str], list[Run]]:
    """Return the absolute paths among logs, and the runs."""
    if isinstance(data, Recordings):
        folder = data._folder
        return ([], list(data)) if folder is None else ([str(Path.cwd() / folder)], [])
    items = [data] if isinstance(data, (Run, str, PathLike)) else data
    if not isinstance(items, Iterable):
        kind = type(data).__name__
        raise SettingError(f"recordings are of type {kind}; give paths, runs or Recordings")
    items = list(items)
    for item in items:
        if not isinstance(item, (Run, str, PathLike)):
            kind = type(item).__name__
            raise SettingError(f"a recording is of type {kind}; give runs or paths")
    paths = [str(Path.cwd() / fspath(item)) for item in items if not isinstance(item, Run)]
    return paths, [item for item in items if isinstance(item, Run)]


def native_of_logs(data: Logs) -> tuple[list[str], _reachtube.Source | None]:
    """Return logs as the native part takes them: paths, and the runs in memory."""
    paths, runs = parts_of(data)
    if isinstance(data, Recordings) and not paths:
        return [], data._native
    return paths, Recordings(runs)._native if runs else None
