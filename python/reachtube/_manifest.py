"""Manifests: lists of a fleet's recordings."""

from __future__ import annotations

import io
from collections.abc import Iterable, Mapping, Sequence
from os import PathLike, fspath
from typing import Any, NamedTuple

from ._store import read
from .errors import ReachtubeError


class Recording(NamedTuple):
    """A line of a manifest.

    Attributes
    ----------
    file
        Path of a CSV or Parquet file, relative to the manifest's folder, or a whole address.
    suite, motion
        The test suite, and the motion that it is part of.
    order
        Place in the order in which the suite's runs were recorded, from 1.
    sha256
        The SHA-256 that the file must have, in hexadecimal.
    """

    file: str
    suite: str
    motion: str | None = None
    order: int | None = None
    sha256: str | None = None


def write_manifest(
    path: str | PathLike[str],
    recordings: Iterable[Recording],
    *,
    storage_options: Mapping[str, Any] | None = None,
) -> None:
    """Write a manifest as a Parquet file, to any store that fsspec opens."""
    import fsspec
    import pyarrow
    from pyarrow import parquet

    rows = list(recordings)
    kinds = [pyarrow.string()] * 3 + [pyarrow.int64(), pyarrow.string()]
    schema = pyarrow.schema(list(zip(Recording._fields, kinds, strict=True)))
    columns = {name: [row[i] for row in rows] for i, name in enumerate(Recording._fields)}
    with fsspec.open(fspath(path), "wb", **dict(storage_options or {})) as file:
        parquet.write_table(pyarrow.table(columns, schema=schema), file)


def read_manifest(
    path: str | PathLike[str], *, storage_options: Mapping[str, Any] | None = None
) -> list[Recording]:
    """Read a manifest: a Parquet file with the columns ``file`` and ``suite``, and if it has them
    ``motion``, ``order`` and ``sha256``. Other columns are for its owner.

    Raises
    ------
    ReachtubeError
        Where the file is missing, or lacks a column or a value.
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
    rows = [Recording(**row) for row in table.select(known).to_pylist()]
    for line, row in enumerate(rows):
        if not row.file or not row.suite:
            raise ReachtubeError(f"{address}: row {line} (from 0) has no file or no suite")
    return rows


def in_order(rows: Sequence[Recording]) -> list[tuple[int, Recording]]:
    """Return places and recordings, each with its order in its suite."""
    counts: dict[str, int] = {}
    ordered = []
    for place, row in enumerate(rows):
        counts[row.suite] = counts.get(row.suite, 0) + 1
        ordered.append((place, row._replace(order=row.order or counts[row.suite])))
    return ordered
