"""Recordings of a fleet: more than one machine holds, folded in parts.

A manifest lists the recordings, in any store that fsspec opens. Each task folds some of them into
what sets and verdicts need of them, which does not grow with their number, and folds merge in any
order. So the model is the same to the last bit on one machine and on any number of Dask workers.
"""

from __future__ import annotations

import inspect
from collections.abc import Mapping, Sequence
from os import PathLike, fspath
from typing import TYPE_CHECKING, Any, Literal, TypeAlias

from . import _conform
from ._abstraction import Abstraction
from ._arrays import check_choice, names, real, whole
from ._check import Check
from ._conform import told
from ._jobs import Job, Part, fleet_of, fold_of, on_dask
from ._manifest import Recording, in_order, of_robots, read_manifest, write_manifest
from ._model import Model, text_of
from ._progress import Progress, shown
from ._robot import Robot
from ._settings import Group, Notion, Torque, among, differing, of_conformance
from .errors import ReachtubeError

if TYPE_CHECKING:
    from distributed import Client

__all__ = ["Recording", "check", "conform", "read_manifest", "write_manifest"]

OnDefect: TypeAlias = Literal["raise", "report"]

Robots: TypeAlias = "str | Sequence[str | None] | None"

def _parts(
    manifest: str | PathLike[str],
    size: int,
    storage: Mapping[str, Any] | None,
    folders: tuple[str | PathLike[str] | None, str | PathLike[str] | None],
    robots: Robots,
) -> list[Part]:
    """Return the recordings of each task."""
    size = whole("runs_per_task", size, 1)
    address, options = fspath(manifest), dict(storage or {})
    listed = list(enumerate(read_manifest(address, storage_options=options)))
    all_rows = in_order(of_robots(listed, robots, address))
    # A fold is as large as its suites: a task takes few of them, and its neighbours the same.
    all_rows.sort(key=lambda numbered: numbered[1].suite)
    if not all_rows:
        raise ReachtubeError(f"{address}: it lists no recording")
    head, slash, _ = address.replace("\\", "/").rpartition("/")
    resume, summaries = (
        None if folder is None else fspath(folder).rstrip("/") + "/" for folder in folders
    )
    return [
        Part(all_rows[first : first + size], head + slash, options, resume, summaries)
        for first in range(0, len(all_rows), size)
    ]


def _folded(
    job: Job, parts: list[Part], client: Client | None, progress: Progress, what: str
) -> bytes:
    """Return the fold of all parts."""
    with shown(progress, what) as tell:

        def count(done: int) -> None:
            if tell is not None:
                tell(done, len(parts), [])

        if client is not None:
            return on_dask(job, parts, client, count)
        whole = fleet_of(job).fold()
        for done, part in enumerate(parts, 1):
            whole.merge(fleet_of(job), fold_of(job, part))
            count(done)
        return whole.to_bytes()


def conform(
    robot: Robot | Abstraction,
    manifest: str | PathLike[str],
    *,
    torque: Torque,
    fit: Sequence[Group] = (),
    pull: float | None = None,
    robots: Robots = None,
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

    The model equals `reachtube.conform`'s over the same recordings, to the last bit, whatever
    the number of workers and the order in which they finish.

    Parameters
    ----------
    robot
        A robot, or an abstraction of one made by `abstract`.
    manifest
        A Parquet file, in any store that fsspec opens; see `read_manifest`.
    torque
        What the recorded torques are, as for `reachtube.conform`.
    fit
        Groups of parameters of the nominal model that are fitted, as for `reachtube.conform`. What
        is fitted are envelopes, and no recording is read again; so warm-up, which is another for
        each run, is only fitted where a fold keeps whole recordings, as with ``nominal="own"``.
    pull
        The weight of the pull of a fit, as for `reachtube.conform`.
    robots
        Names in the manifest's column ``robot``, whose recordings are used. A manifest of several
        robots is refused if none is chosen; ``None`` in a list stands for rows without a name.
    client
        A Dask client; this process does everything if none is given.
    runs_per_task
        Number of recordings that a task folds.
    on_defect
        Whether recordings with defects end the job, which then names all of them, or are left
        out and counted in the model.
    resume
        A folder for finished tasks, from which a job that was stopped continues, if the
        manifest has the SHA-256 of each recording of a task.
    summaries
        A folder for what was read of each recording, as a Parquet data set.
    storage_options
        Options of the store, for fsspec.
    progress
        As for `reachtube.conform`.
    settings
        The other settings of `reachtube.conform`. Only the notion ``"hull"`` is proved of a
        fleet: the others need all points in one memory.

    Returns
    -------
    Model
    """
    known = among(inspect.signature(_conform.conform).parameters)
    for name in settings:
        if name not in known:
            raise TypeError(f"fleet.conform() has no argument {name!r}")
    check_choice("on_defect", on_defect, ("raise", "report"))
    text = of_conformance(robot, torque=torque, **settings)
    if isinstance(robot, Abstraction):
        job = Job("abstraction", robot._native.to_json(), text)
    else:
        job = Job("robot", robot._native.description(), text)
    groups, pull = names(fit), None if pull is None else real("pull", pull)
    fleet_of(job).fold()
    fleet_of(job).check_fit(groups, pull)
    parts = _parts(manifest, runs_per_task, storage_options, (resume, summaries), robots)
    whole = _folded(job, parts, client, progress, "fleet.conform")
    with shown(progress, "fleet.conform: sets") as tell:
        found, notes = fleet_of(job).conform(whole, on_defect == "report", groups, pull, tell)
    return told(found, notes, 4)


def check(
    model: Model,
    manifest: str | PathLike[str],
    *,
    robots: Robots = None,
    client: Client | None = None,
    runs_per_task: int = 1000,
    on_defect: OnDefect = "raise",
    resume: str | PathLike[str] | None = None,
    summaries: str | PathLike[str] | None = None,
    storage_options: Mapping[str, Any] | None = None,
    notion: Notion | None = None,
    until: float | None = None,
    max_gap: float | None = None,
    progress: Progress = None,
) -> Check:
    """Check whether a model encloses a fleet's recordings, with the worst witness of each suite.

    Parameters
    ----------
    model
        The model.
    manifest
        A Parquet file, in any store that fsspec opens; see `read_manifest`.
    robots
        Names in the manifest's column ``robot``, whose recordings are used, as for `conform`.
    client
        A Dask client; this process does everything if none is given.
    runs_per_task
        Number of recordings that a task folds.
    on_defect
        Whether recordings with defects end the job, or are left out and counted.
    resume
        A folder for finished tasks, from which a job that was stopped continues, if the
        manifest has the SHA-256 of each recording of a task.
    summaries
        A folder for what was read of each recording, as a Parquet data set.
    storage_options
        Options of the store, for fsspec.
    notion
        Directions in which recordings must lie in the set; the model's own by default. A
        model of another notion than ``"hull"`` is checked with ``notion="hull"``.
    until
        Samples later than this many seconds after the first are not used; the model's own limit
        if it is not given.
    max_gap
        Longest time between two samples, s.
    progress
        As for `reachtube.conform`.

    Returns
    -------
    Check
    """
    check_choice("on_defect", on_defect, ("raise", "report"))
    job = Job("model", text_of(model), differing(notion, until, max_gap))
    fleet_of(job).fold()
    parts = _parts(manifest, runs_per_task, storage_options, (resume, summaries), robots)
    whole = _folded(job, parts, client, progress, "fleet.check")
    return Check(fleet_of(job).check(whole, on_defect == "report"))
