"""Recordings of a fleet: more than one machine holds, folded in parts.

A manifest lists the recordings, in any store that fsspec opens. Each task folds some of them into
what sets and verdicts need of them, which does not grow with their number, and folds merge in any
order. So the model is the same to the last bit on one machine and on any number of Dask workers.
"""

from __future__ import annotations

import functools
import hashlib
import io
import json
from collections.abc import Mapping
from dataclasses import dataclass
from os import PathLike, fspath
from typing import TYPE_CHECKING, Any, Literal, NamedTuple, TypeAlias

from . import _reachtube
from ._abstraction import Abstraction
from ._conform import told
from ._manifest import Recording, in_order, read_manifest, write_manifest
from ._model import Check, Model
from ._progress import Progress, shown
from ._robot import Robot
from ._settings import Torque, differing, of_conformance
from ._store import read, write
from .errors import ReachtubeError, SettingError
from .io import _run_of_columns

if TYPE_CHECKING:
    from distributed import Client

__all__ = ["Recording", "check", "conform", "read_manifest", "write_manifest"]

OnDefect: TypeAlias = Literal["raise", "report"]

#: How many folds merge at once.
GROUP = 8


@dataclass(frozen=True)
class _Job:
    """What every task of a job needs: the text of a robot, abstraction or model, and settings."""

    kind: Literal["robot", "abstraction", "model"]
    text: str
    settings: str

    def digest(self) -> str:
        parts = json.dumps([self.kind, self.text, self.settings])
        return hashlib.sha256(parts.encode()).hexdigest()


class _Part(NamedTuple):
    """The recordings of a task: their places in the manifest, and where they are."""

    rows: list[tuple[int, Recording]]
    base: str
    storage: dict[str, Any]
    resume: str | None
    summaries: str | None


@functools.lru_cache(maxsize=4)
def _fleet(job: _Job) -> _reachtube.Fleet:
    """Return the native part of a job, which a worker makes once."""
    if job.kind == "model":
        return _reachtube.Fleet.to_check(job.text, job.settings)
    if job.kind == "robot":
        robot = _reachtube.Robot.from_description(job.text)
        return _reachtube.Fleet.to_conform(robot, None, job.settings)
    model = _reachtube.Abstraction.parse(job.text, "abstraction")
    return _reachtube.Fleet.to_conform(None, model, job.settings)


def _take(
    fold: _reachtube.Fold, place: int, row: Recording, part: _Part
) -> tuple[tuple[str, int, float] | None, list[str]]:
    """Fold one recording; whatever is wrong with it is kept as its defect."""
    entry = (place, row.file, row.suite, row.motion, row.order or 0, row.sha256)
    address = row.file if "://" in row.file or row.file.startswith("/") else part.base + row.file
    content = read(address, part.storage)
    if content is None:
        return fold.take_defect(entry, "there is no such file", "restore it, or leave it out")
    if not row.file.endswith(".parquet"):
        return fold.take_csv(entry, content)
    found = hashlib.sha256(content).hexdigest()
    if row.sha256 is not None and row.sha256.lower() != found:
        problem = f"its SHA-256 is {found}, but the manifest says {row.sha256}"
        return fold.take_defect(entry, problem, "restore the file, or write the manifest again")
    from pyarrow import ArrowInvalid, parquet

    try:
        table = parquet.read_table(io.BytesIO(content))
        columns = {name: table.column(name).to_numpy() for name in table.column_names}
        run = _run_of_columns(row.file, columns, None, row.suite, row.motion)
    except (ReachtubeError, ArrowInvalid) as error:
        return fold.take_defect(entry, str(error), "record it again, or leave it out")
    return fold.take_run(entry, run._native)


def _fold(job: _Job, part: _Part) -> bytes:
    """Fold the recordings of a task, or take what an earlier job finished."""
    store = None
    if part.resume is not None:
        rows = json.dumps([job.digest(), part.rows]).encode()
        store = f"{part.resume}{hashlib.sha256(rows).hexdigest()}.fold"
        known = read(store, part.storage)
        if known is not None:
            try:
                _fleet(job).merge([known])
                return known
            except ReachtubeError:
                pass
    fold = _fleet(job).fold()
    summaries: list[dict[str, Any]] = []
    for place, row in part.rows:
        summary, defects = _take(fold, place, row, part)
        if part.summaries is not None:
            sha256, samples, duration = summary or (None, None, None)
            numbers = {"sha256": sha256, "samples": samples, "duration": duration}
            labels = {"place": place, "file": row.file, "suite": row.suite, "motion": row.motion}
            summaries.append({**labels, **numbers, "defects": "\n".join(defects)})
    content = fold.to_bytes()
    if part.summaries is not None:
        _write_summaries(part, summaries)
    if store is not None:
        write(store, content, part.storage)
    return content


def _write_summaries(part: _Part, rows: list[dict[str, Any]]) -> None:
    """Write what was read of each recording as one Parquet file of a data set."""
    import pyarrow
    from pyarrow import parquet

    text, whole = pyarrow.string(), pyarrow.int64()
    kinds = {"place": whole, "file": text, "suite": text, "motion": text, "sha256": text}
    kinds |= {"samples": whole, "duration": pyarrow.float64(), "defects": text}
    buffer = io.BytesIO()
    parquet.write_table(
        pyarrow.Table.from_pylist(rows, schema=pyarrow.schema(list(kinds.items()))), buffer
    )
    name = f"{part.summaries}{rows[0]['place']:012d}.parquet"
    write(name, buffer.getvalue(), part.storage)


def _same(job: _Job) -> _Job:
    return job


def _merge(job: _Job, parts: list[bytes]) -> bytes:
    return _fleet(job).merge(parts)


def _parts(
    manifest: str | PathLike[str],
    size: int,
    storage: Mapping[str, Any] | None,
    folders: tuple[str | PathLike[str] | None, str | PathLike[str] | None],
) -> list[_Part]:
    """Return the recordings of each task."""
    if size < 1:
        raise SettingError(f"runs_per_task is {size}; give 1 or more")
    address, options = fspath(manifest), dict(storage or {})
    all_rows = in_order(read_manifest(address, storage_options=options))
    # A fold is as large as its suites: a task takes few of them, and its neighbours the same.
    all_rows.sort(key=lambda numbered: numbered[1].suite)
    if not all_rows:
        raise ReachtubeError(f"{address}: it lists no recording")
    head, slash, _ = address.replace("\\", "/").rpartition("/")
    resume, summaries = (
        None if folder is None else fspath(folder).rstrip("/") + "/" for folder in folders
    )
    return [
        _Part(all_rows[first : first + size], head + slash, options, resume, summaries)
        for first in range(0, len(all_rows), size)
    ]


def _folded(
    job: _Job, parts: list[_Part], client: Client | None, progress: Progress, what: str
) -> bytes:
    """Return the fold of all parts."""
    with shown(progress, what) as tell:

        def count(done: int) -> None:
            if tell is not None:
                tell(done, len(parts), [])

        if client is not None:
            return _on_dask(job, parts, client, count)
        whole = _fleet(job).fold()
        for done, part in enumerate(parts, 1):
            whole.merge(_fleet(job), _fold(job, part))
            count(done)
        return whole.to_bytes()


def _on_dask(job: _Job, parts: list[_Part], client: Any, count: Any) -> bytes:
    """Fold the parts on workers, and merge them as a tree."""
    from distributed import as_completed

    # A task, so that it is done again where the worker that holds its result ends. Scattered data
    # would be lost with its workers.
    shared = client.submit(_same, job, pure=False, retries=3)
    folds = [client.submit(_fold, shared, part, pure=False, retries=3) for part in parts]
    level = folds
    while len(level) > 1:
        groups = [level[first : first + GROUP] for first in range(0, len(level), GROUP)]
        level = [client.submit(_merge, shared, group, pure=False, retries=3) for group in groups]
    [last] = level
    done = 0
    try:
        # Nothing here keeps a fold, so that a worker lets go of it when it is merged.
        waiting: Any = as_completed(folds)  # type: ignore[no-untyped-call]
        del folds, level
        for _ in waiting:
            done += 1
            count(done)
        content: bytes = last.result()
        return content
    except BaseException:
        client.cancel([last], force=True)
        raise


def conform(
    robot: Robot | Abstraction,
    manifest: str | PathLike[str],
    *,
    torque: Torque,
    client: Client | None = None,
    runs_per_task: int = 1000,
    on_defect: OnDefect = "raise",
    resume: str | PathLike[str] | None = None,
    summaries: str | PathLike[str] | None = None,
    storage_options: Mapping[str, Any] | None = None,
    progress: Progress = None,
    **settings: Any,
) -> Model:
    """Find the smallest sets for a fleet's recordings.

    The model is that of `reachtube.conform` over the same recordings, to the last bit, whatever
    the number of workers and the order in which they finish.

    Parameters
    ----------
    robot, torque
        As for `reachtube.conform`.
    manifest
        A Parquet file, in any store that fsspec opens; see `read_manifest`.
    client
        A Dask client; this process does everything where none is given.
    runs_per_task
        Number of recordings that a task folds.
    on_defect
        Whether recordings with defects end the job, which then names all of them, or are left
        out and counted in the model.
    resume
        A folder for finished tasks, from which a job that was stopped goes on.
    summaries
        A folder for what was read of each recording, as a Parquet data set.
    storage_options
        For fsspec.
    settings
        The other settings of `reachtube.conform`, for the notion ``"hull"``.

    Returns
    -------
    Model
    """
    text = of_conformance(robot, torque=torque, **settings)
    if isinstance(robot, Abstraction):
        job = _Job("abstraction", robot._native.to_json(), text)
    else:
        job = _Job("robot", robot._native.description(), text)
    _fleet(job).fold()
    parts = _parts(manifest, runs_per_task, storage_options, (resume, summaries))
    whole = _folded(job, parts, client, progress, "fleet.conform")
    found, notes = _fleet(job).conform(whole, on_defect == "report")
    return told(found, notes, 3)


def check(
    model: Model,
    manifest: str | PathLike[str],
    *,
    client: Client | None = None,
    runs_per_task: int = 1000,
    on_defect: OnDefect = "raise",
    resume: str | PathLike[str] | None = None,
    summaries: str | PathLike[str] | None = None,
    storage_options: Mapping[str, Any] | None = None,
    until: float | None = None,
    max_gap: float | None = None,
    progress: Progress = None,
) -> Check:
    """Check whether a model encloses a fleet's recordings, with the worst witness of each suite.

    Parameters
    ----------
    model
        The model.
    manifest, client, runs_per_task, on_defect, resume, summaries, storage_options, progress
        As for `conform`.
    until, max_gap
        As for `reachtube.check`.

    Returns
    -------
    Check
    """
    job = _Job("model", model._text, differing("hull", until, max_gap))
    _fleet(job).fold()
    parts = _parts(manifest, runs_per_task, storage_options, (resume, summaries))
    whole = _folded(job, parts, client, progress, "fleet.check")
    return Check(_fleet(job).check(whole, on_defect == "report"))
