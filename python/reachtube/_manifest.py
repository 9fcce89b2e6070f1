"""Manifests: lists of a fleet's recordings."""

from __future__ import annotations

import io
import math
from collections.abc import Iterable, Mapping, Sequence
from os import PathLike, fspath
from typing import Any, NamedTuple

from ._store import read
from .errors import ReachtubeError, SettingError

#: Temperatures beyond these are taken for a mistake, °C.
COLDEST, HOTTEST = -100.0, 250.0


class Recording(NamedTuple):
    """A line of a manifest.

    Attributes
    ----------
    file
        Path of a CSV or Parquet file, relative to the manifest's folder, or a whole address.
    suite
        The test suite.
    motion
        The motion that the suite is part of.
    order
        Place in the order in which the suite's runs were recorded, from 1.
    sha256
        The SHA-256 that the file must have, in hexadecimal.
    robot
        Which of several robots of the same kind it is of, for example a serial number.
    temperature
        Temperature of the joints, °C, if the recording has no temperatures of its own.
    """

    file: str
    suite: str
    motion: str | None = None
    order: int | None = None
    sha256: str | None = None
    robot: str | None = None
    temperature: float | None = None


def write_manifest(
    path: str | PathLike[str],
    recordings: Iterable[Recording],
    *,
    storage_options: Mapping[str, Any] | None = None,
) -> None:
    """Write a manifest as a Parquet file, to any store that fsspec opens.

    Parameters
    ----------
    path
        The path or address of the file; a file that exists is replaced.
    recordings
        The lines of the manifest.
    storage_options
        Options of the store, for fsspec.
    """
    import fsspec
    import pyarrow
    from pyarrow import parquet

    rows = list(recordings)
    text = pyarrow.string()
    kinds = [text, text, text, pyarrow.int64(), text, text, pyarrow.float64()]
    schema = pyarrow.schema(list(zip(Recording._fields, kinds, strict=True)))
    columns = {name: [row[i] for row in rows] for i, name in enumerate(Recording._fields)}
    with fsspec.open(fspath(path), "wb", **dict(storage_options or {})) as file:
        parquet.write_table(pyarrow.table(columns, schema=schema), file)


def read_manifest(
    path: str | PathLike[str], *, storage_options: Mapping[str, Any] | None = None
) -> list[Recording]:
    """Read a manifest.

    Parameters
    ----------
    path
        The path or address of a Parquet file with the columns ``file`` and ``suite``, and if it has
        them ``motion``, ``order``, ``sha256``, ``robot`` and ``temperature``. Other columns are for
        its owner.
    storage_options
        Options of the store, for fsspec.

    Returns
    -------
    list of Recording

    Raises
    ------
    ReachtubeError
        If the file is missing, or lacks a column or a value.
    """
    from pyarrow import ArrowInvalid, parquet

    address = fspath(path)
    content = read(address, dict(storage_options or {}))
    if content is None:
        raise ReachtubeError(f"{address}: there is no such file")
    try:
        table = parquet.read_table(io.BytesIO(content))
    except ArrowInvalid as error:
        raise ReachtubeError(f"{address}: it is no Parquet file: {error}") from None
    missing = [name for name in ("file", "suite") if name not in table.column_names]
    if missing:
        there = ", ".join(table.column_names)
        raise ReachtubeError(f"{address}: these columns are missing: {', '.join(missing)}; there "
                             f"are {there}")
    known = [name for name in Recording._fields if name in table.column_names]
    rows = [_recording(row) for row in table.select(known).to_pylist()]
    for line, row in enumerate(rows):
        if not row.file or not row.suite:
            raise ReachtubeError(f"{address}: row {line} (from 0) has no file or no suite")
        if row.order is not None and (not isinstance(row.order, int) or row.order < 1):
            raise ReachtubeError(
                f"{address}: row {line} (from 0) has the order {row.order}; orders are whole "
                "numbers from 1"
            )
        warm = row.temperature
        if warm is not None and not COLDEST <= warm <= HOTTEST:
            raise ReachtubeError(
                f"{address}: row {line} (from 0) has the temperature {warm} °C; it is between "
                f"{COLDEST:g} and {HOTTEST:g} °C, or empty if it is not known"
            )
    return rows


def _recording(row: dict[str, Any]) -> Recording:
    """Return a line as other libraries write it: with NaN for no number, and whole numbers as
    others."""
    for name, value in row.items():
        if isinstance(value, float) and math.isnan(value):
            row[name] = None
        elif name == "robot" and value is not None:
            row[name] = str(value)
        elif name == "order" and isinstance(value, float):
            row[name] = int(value) if value.is_integer() else value
    return Recording(**row)


def of_robots(
    rows: Sequence[tuple[int, Recording]], robots: str | None | Sequence[str | None], address: str
) -> list[tuple[int, Recording]]:
    """Return the recordings of the chosen robots, or of the only one.

    Raises
    ------
    SettingError
        Where several robots are there and none is chosen, and where one is chosen that has no
        recording.
    """
    counts: dict[str | None, int] = {}
    for _, row in rows:
        counts[row.robot] = counts.get(row.robot, 0) + 1
    listed = ", ".join(f"{name or 'no name'} ({count})" for name, count in counts.items())
    if robots is None:
        if len(counts) > 1:
            raise SettingError(
                f"{address}: the recordings are of several robots: {listed}. Sets are of one "
                "robot; choose it with robots=NAME, or give a list of the robots that share them"
            )
        return list(rows)
    chosen = [robots] if isinstance(robots, str) else list(robots)
    for name in chosen:
        if name not in counts:
            raise SettingError(f"{address}: no recording is of robot {name!r}; there are {listed}")
    return [(place, row) for place, row in rows if row.robot in chosen]


def in_order(rows: Sequence[tuple[int, Recording]]) -> list[tuple[int, Recording]]:
    """Return places and recordings, each with its order in its suite."""
    counts: dict[str, int] = {}
    ordered = []
    for place, row in rows:
        counts[row.suite] = counts.get(row.suite, 0) + 1
        ordered.append((place, row._replace(order=row.order or counts[row.suite])))
    return ordered
