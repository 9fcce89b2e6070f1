"""Jobs of fleets: what a task folds, here or on workers of Dask."""

from __future__ import annotations

import functools
import hashlib
import io
import json
from dataclasses import dataclass
from typing import Any, Literal, NamedTuple, TypeAlias, TypeVar

from . import _reachtube
from ._manifest import Recording
from ._robot import Robot
from ._store import read, write
from ._tables import run_of_columns
from .errors import ReachtubeError

Own = TypeVar("Own")

#: How many folds merge at once.
GROUP = 8


@dataclass(frozen=True)
class Job:
    """What every task of a job needs: the text of a robot, abstraction or model, and settings."""

    kind: Literal["robot", "abstraction", "model"]
    text: str
    settings: str

    def digest(self) -> str:
        parts = json.dumps([self.kind, self.text, self.settings])
        return hashlib.sha256(parts.encode()).hexdigest()


class Part(NamedTuple):
    """The recordings of a task: their places in the manifest, and where they are."""

    rows: list[tuple[int, Recording]]
    base: str
    storage: dict[str, Any]
    resume: str | None
    summaries: str | None


@functools.lru_cache(maxsize=4)
def fleet_of(job: Job) -> _reachtube.Fleet:
    """Return the native part of a job, which a worker makes once."""
    if job.kind == "model":
        return _reachtube.Fleet.to_check(job.text, job.settings)
    if job.kind == "robot":
        robot = _reachtube.Robot.from_description(job.text)
        return _reachtube.Fleet.to_conform(robot, None, job.settings)
    model = _reachtube.Abstraction.parse(job.text, "abstraction")
    return _reachtube.Fleet.to_conform(None, model, job.settings)


#: What was read of a recording: the content of a CSV file, a run, or problem and remedy.
Read: TypeAlias = "bytes | _reachtube.Run | tuple[str, str]"

Entry: TypeAlias = "tuple[int, str, str, str | None, int, str | None, float | None]"


def _read_one(place: int, row: Recording, part: Part) -> tuple[Entry, Read]:
    """Read one recording."""
    order, warm = row.order or 0, row.temperature
    entry = (place, row.file, row.suite, row.motion, order, row.sha256, warm)
    address = row.file if "://" in row.file or row.file.startswith("/") else part.base + row.file
    content = read(address, part.storage)
    if content is None:
        return entry, ("there is no such file", "restore it, or leave it out")
    if not row.file.endswith(".parquet"):
        return entry, content
    found = hashlib.sha256(content).hexdigest()
    if row.sha256 is not None and row.sha256.lower() != found:
        problem = f"its SHA-256 is {found}, but the manifest says {row.sha256}"
        return entry, (problem, "restore the file, or write the manifest again")
    from pyarrow import ArrowInvalid, parquet

    try:
        table = parquet.read_table(io.BytesIO(content))
        columns = {name: table.column(name).to_numpy() for name in table.column_names}
        run = run_of_columns(row.file, columns, None, row.suite, row.motion)
    except (ReachtubeError, ArrowInvalid) as error:
        return entry, (str(error), "record it again, or leave it out")
    return entry, run._native


def _take(
    fold: _reachtube.Fold, entry: Entry, found: Read
) -> tuple[tuple[str, int, float] | None, list[str]]:
    """Fold one recording; whatever is wrong with it is kept as its defect."""
    if isinstance(found, bytes):
        return fold.take_csv(entry, found)
    if isinstance(found, tuple):
        return fold.take_defect(entry, *found)
    return fold.take_run(entry, found)


def fold_of(job: Job, part: Part) -> bytes:
    """Fold the recordings of a task, or take what an earlier job finished."""
    store = None
    # A recording without a digest may be another one by now.
    if part.resume is not None and all(row.sha256 is not None for _, row in part.rows):
        rows = json.dumps([job.digest(), part.base, part.rows]).encode()
        store = f"{part.resume}{hashlib.sha256(rows).hexdigest()}.fold"
        known = read(store, part.storage)
        if known is not None:
            try:
                fleet_of(job).merge([known])
                return known
            except ReachtubeError:
                pass
    fold = fleet_of(job).fold()
    summaries: list[dict[str, Any]] = []
    sound = True
    for place, row in part.rows:
        summary, defects = _take(fold, *_read_one(place, row, part))
        sound = sound and not defects
        if part.summaries is not None:
            sha256, samples, duration = summary or (None, None, None)
            numbers = {"sha256": sha256, "samples": samples, "duration": duration}
            labels = {"place": place, "file": row.file, "suite": row.suite, "motion": row.motion}
            summaries.append({**labels, **numbers, "defects": "\n".join(defects)})
    content = fold.to_bytes()
    if part.summaries is not None:
        _write_summaries(part, summaries)
    # What is wrong with a recording may be mended.
    if store is not None and sound:
        write(store, content, part.storage)
    return content


def _write_summaries(part: Part, rows: list[dict[str, Any]]) -> None:
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


def same(value: Own) -> Own:
    """Return a value, as a task whose result can be made again where its worker ends."""
    return value


def _merge(job: Job, parts: list[bytes]) -> bytes:
    return fleet_of(job).merge(parts)


def on_dask(job: Job, parts: list[Part], client: Any, count: Any) -> bytes:
    """Fold the parts on workers, and merge them as a tree."""
    from distributed import as_completed

    # Scattered data would be lost with the workers that hold it.
    shared = client.submit(same, job, pure=False, retries=3)
    folds = [client.submit(fold_of, shared, part, pure=False, retries=3) for part in parts]
    last = _as_tree(functools.partial(client.submit, _merge, shared), folds)
    # Nothing here keeps a fold, so that a worker drops it when it is merged.
    waiting: Any = as_completed(folds)  # type: ignore[no-untyped-call]
    del folds
    done = 0
    try:
        for _ in waiting:
            done += 1
            count(done)
        content: bytes = last.result()
        return content
    except BaseException:
        with waiting.lock:
            rest = [*waiting.futures, *waiting.queue.queue]
        # Only what no other task needs can be cancelled: Dask's scheduler ends the connection of
        # a client that cancels a task whose dependents are not wanted any more.
        client.cancel([last])
        client.cancel([*rest, shared])
        raise


def _as_tree(submit: Any, level: list[Any]) -> Any:
    """Merge the results of tasks in groups, and these again."""
    while len(level) > 1:
        groups = [level[first : first + GROUP] for first in range(0, len(level), GROUP)]
        level = [submit(group, pure=False, retries=3) for group in groups]
    return level[0]
