"""Recordings from robot logs and from files of other libraries.

`bag` reads MCAP and rosbag2; `ros1`, `parquet`, `npz` and `hdf5` read what Python libraries write.
Every reader gives `Run`, and joints are matched by name where the file names them.
"""

from __future__ import annotations

import logging
import warnings
from collections.abc import Iterable, Iterator, Mapping, Sequence
from contextlib import contextmanager
from os import PathLike, fspath
from pathlib import Path
from typing import Any, Literal

import numpy as np

from . import _reachtube
from ._arrays import Array, names, numbers
from ._recordings import Recordings, Run
from .errors import Defect, DefectsError, ReachtubeError, ReachtubeWarning, SettingError

__all__ = ["bag", "hdf5", "npz", "parquet", "ros1"]

log = logging.getLogger("reachtube")

Path_ = str | PathLike[str]


@contextmanager
def _opened(path: Path_) -> Iterator[None]:
    """Name the file where another library cannot read it."""
    if not Path(path).exists():
        raise ReachtubeError(f"{fspath(path)}: there is no such file")
    try:
        yield
    except ReachtubeError:
        raise
    except Exception as error:
        # Each library has exceptions of its own.
        raise ReachtubeError(f"{fspath(path)}: it could not be read: {error}") from error


def bag(
    paths: Path_ | Sequence[Path_],
    *,
    topic: str | Sequence[str] | None = None,
    joints: Sequence[str],
    marker: str | None = None,
    repeats: bool = False,
    rest_speed: float = 0.01,
    time: Literal["header", "log"] = "header",
    recover: bool = False,
    suite: str | None = None,
    motion: str | None = None,
    max_gap: float | None = None,
) -> Recordings:
    """Read MCAP files, .db3 files of rosbag2 or folders of one bag, with JointState messages.

    Parameters
    ----------
    paths
        One log or several.
    topic
        Topics with ``sensor_msgs/msg/JointState``; several complement each other. By default the
        only one that names one of ``joints``.
    joints
        Names of the robot's joints in the log, in the order of the robot, as
        ``robot.joint_names``. Joints are matched by name, whatever their order in a message.
    marker
        A topic that marks runs: a suite's name starts a run, empty text ends it.
    repeats
        Whether motions between rests are runs, and repeated motions suites.
    rest_speed
        The speed below which a joint rests, rad/s.
    time
        The stamps in the messages' headers, or the times at which the log received them.
    recover
        Whether the whole parts of a damaged log are read; lost parts produce a warning.
    suite
        The suite of runs that are not cut by markers or repeats.
    motion
        The motion of runs that are not cut by markers or repeats.
    max_gap
        Longest time between two samples, s.

    Raises
    ------
    DefectsError
        Values that are missing or not finite, and gaps.
    ReachtubeError
        A damaged file, with the byte; a joint that is not in the log, with the joints that are.
    """
    files = [paths] if isinstance(paths, (str, PathLike)) else list(paths)
    found, notes, lost = _reachtube.read_log(
        [fspath(path) for path in files],
        names(topic),
        names(joints),
        time == "log",
        recover,
        (marker, repeats, rest_speed, max_gap),
    )
    for note in notes:
        log.info(note)
    for loss in lost:
        warnings.warn(loss, ReachtubeWarning, 2)
    return Recordings(
        Run._of(run, own_suite or suite, own_motion or motion, name)
        for run, name, own_suite, own_motion in found
    )


def _run_of_columns(
    origin: str,
    columns: Mapping[str, Any],
    joints: Sequence[str] | None,
    suite: str | None,
    motion: str | None,
) -> Run:
    """Return the run of columns t, q1.., qd1.., tau1.. or, with `joints`, position.NAME, ..."""
    if joints is None:
        count = 0
        while f"q{count + 1}" in columns:
            count += 1
        if count == 0:
            raise ReachtubeError(
                f"{origin}: there is no column q1; name the joints of columns position.NAME with "
                f"joints=, or the columns as in the CSV format; there are {', '.join(columns)}"
            )
        wanted = {
            part: [f"{prefix}{j + 1}" for j in range(count)]
            for part, prefix in {"q": "q", "qd": "qd", "tau": "tau"}.items()
        }
    else:
        prefixes = {"q": "position", "qd": "velocity", "tau": "effort"}
        wanted = {part: [f"{p}.{name}" for name in joints] for part, p in prefixes.items()}
    missing = [name for part in ("q", "qd", "tau") for name in wanted[part] if name not in columns]
    if "t" not in columns:
        missing.insert(0, "t")
    if missing:
        raise ReachtubeError(
            f"{origin}: these columns are missing: {', '.join(missing)}; there are "
            f"{', '.join(columns)}"
        )
    parts: dict[str, Array] = {
        part: np.column_stack([numbers(name, columns[name]) for name in own])
        for part, own in wanted.items()
    }
    times = numbers("t", columns["t"])
    warm = [name for j in range(len(wanted["q"])) if (name := f"temp{j + 1}") in columns]
    if joints is None and len(warm) == len(wanted["q"]):
        parts["temp"] = np.column_stack([numbers(name, columns[name]) for name in warm])
    _check_finite(origin, {"t": times[:, None], **parts})
    return Run(times, parts["q"], parts["qd"], parts["tau"], name=Path(origin).name, suite=suite,
               motion=motion, temperature=parts.get("temp"))


def _check_finite(origin: str, parts: Mapping[str, Array]) -> None:
    """Name every column that holds a number which is not finite."""
    defects = []
    for name, values in parts.items():
        for j in range(values.shape[1]):
            wrong = np.flatnonzero(~np.isfinite(values[:, j]))
            if len(wrong):
                joint = None if name == "t" else j + 1
                problem = (
                    f"{name} is not a finite number in {len(wrong)} samples, first in sample "
                    f"{wrong[0]} (from 0)"
                )
                remedy = "drop these samples, or record again"
                defects.append(Defect(origin, None, joint, "value", problem, remedy))
    if defects:
        places = [
            f"{origin}{f': joint {d.joint}' if d.joint else ''}: {d.problem}; {d.remedy}"
            for d in defects
        ]
        raise DefectsError("\n".join(places), tuple(defects))


def parquet(
    path: Path_,
    *,
    joints: Sequence[str] | None = None,
    suite: str | None = None,
    motion: str | None = None,
) -> Run:
    """Read a run from a Parquet file.

    Parameters
    ----------
    path
        A file with the columns ``t``, ``q1..``, ``qd1..``, ``tau1..`` of the CSV format.
    joints
        Names of the robot's joints, in its order, where the columns are ``position.NAME``,
        ``velocity.NAME`` and ``effort.NAME``, in any order.
    suite
        The suite of the run.
    motion
        The motion of the run.
    """
    from pyarrow import parquet as files

    with _opened(path):
        found = files.read_table(fspath(path))
    columns = {name: found.column(name).to_numpy() for name in found.column_names}
    return _run_of_columns(fspath(path), columns, joints, suite, motion)


def npz(
    path: Path_,
    *,
    joints: Sequence[str] | None = None,
    suite: str | None = None,
    motion: str | None = None,
) -> Run:
    """Read a run from an NPZ file with the arrays ``t``, ``q``, ``qd``, ``tau``.

    Parameters
    ----------
    path
        The file. An array ``joints`` names the columns of the others where there is one.
    joints
        Names of the robot's joints, in its order; the file must name its own then.
    suite
        The suite of the run.
    motion
        The motion of the run.
    """
    with _opened(path), np.load(path, allow_pickle=False) as file:
        arrays = {name: file[name] for name in file.files}
    return _run_of_arrays(fspath(path), arrays, joints, suite, motion)


def hdf5(
    path: Path_,
    *,
    group: str = "/",
    joints: Sequence[str] | None = None,
    suite: str | None = None,
    motion: str | None = None,
) -> Run:
    """Read a run from a group of an HDF5 file with the data sets ``t``, ``q``, ``qd``, ``tau``.

    Parameters
    ----------
    path
        The file.
    group
        The group in it.
    joints
        Names of the robot's joints, in its order; the file then has the names of its own as a data
        set or an attribute ``joints``.
    suite
        The suite of the run.
    motion
        The motion of the run.
    """
    import h5py

    with _opened(path), h5py.File(path, "r") as file:
        if group not in file:
            raise ReachtubeError(f"{path}: there is no group {group}; there are {', '.join(file)}")
        found = file[group]
        arrays = {name: found[name][()] for name in found if hasattr(found[name], "dtype")}
        if "joints" in found.attrs:
            arrays.setdefault("joints", found.attrs["joints"])
    return _run_of_arrays(fspath(path), arrays, joints, suite, motion)


def _run_of_arrays(
    origin: str,
    arrays: Mapping[str, Any],
    joints: Sequence[str] | None,
    suite: str | None,
    motion: str | None,
) -> Run:
    missing = [name for name in ("t", "q", "qd", "tau") if name not in arrays]
    if missing:
        there = ", ".join(arrays) or "none"
        raise ReachtubeError(
            f"{origin}: these arrays are missing: {', '.join(missing)}; there are {there}"
        )
    order: Any = slice(None)
    if joints is not None:
        order = _order(origin, arrays.get("joints"), joints)
    parts = {}
    for name in ("q", "qd", "tau"):
        values = numbers(name, arrays[name])
        if values.ndim != 2:
            raise SettingError(f"{origin}: {name} has the shape {values.shape}; give K x n")
        parts[name] = values[:, order]
    times = numbers("t", arrays["t"])
    if times.ndim != 1:
        raise SettingError(f"{origin}: t has the shape {times.shape}; give one axis")
    _check_finite(origin, {"t": times[:, None], **parts})
    return Run(times, parts["q"], parts["qd"], parts["tau"], name=Path(origin).name, suite=suite,
               motion=motion)


def _order(origin: str, found: Any, joints: Sequence[str]) -> list[int]:
    """Return the column of each joint."""
    if found is None:
        raise ReachtubeError(f"{origin}: it does not name its joints; leave joints= out, or add "
                             "an array joints with their names")
    known = [name.decode() if isinstance(name, bytes) else str(name) for name in np.ravel(found)]
    missing = [name for name in joints if name not in known]
    if missing:
        raise ReachtubeError(
            f"{origin}: these joints are missing: {', '.join(missing)}; there are "
            f"{', '.join(known)}"
        )
    return [known.index(name) for name in joints]


def ros1(
    path: Path_,
    *,
    topic: str,
    joints: Sequence[str],
    suite: str | None = None,
    motion: str | None = None,
) -> Run:
    """Read a run from a ROS 1 bag with ``sensor_msgs/JointState`` messages.

    Parameters
    ----------
    path
        The bag.
    topic
        The topic. Times are the stamps in the messages' headers.
    joints
        Names of the robot's joints, in its order; messages may have them in any other.
    suite
        The suite of the run.
    motion
        The motion of the run.
    """
    from rosbags.highlevel import AnyReader

    origin = fspath(path)
    stamps: list[int] = []
    rows: list[tuple[Array, Array, Array]] = []
    with _opened(path), AnyReader([Path(path)]) as reader:
        connections = [known for known in reader.connections if known.topic == topic]
        if not connections:
            there = ", ".join(sorted({known.topic for known in reader.connections}))
            raise ReachtubeError(f"{origin}: there is no topic {topic}; there are {there}")
        for connection, _, data in reader.messages(connections=connections):
            message: Any = reader.deserialize(data, connection.msgtype)
            rows.append(_message(origin, len(rows), message, joints))
            stamp = message.header.stamp
            stamps.append(int(stamp.sec) * 1_000_000_000 + int(stamp.nanosec))
    if not rows:
        raise ReachtubeError(f"{origin}: the topic {topic} has no message")
    q, qd, tau = (np.array(part) for part in zip(*rows, strict=True))
    # From the first stamp on, nanoseconds are exact in double precision.
    times = np.array([stamp - stamps[0] for stamp in stamps]) / 1e9
    _check_finite(origin, {"q": q, "qd": qd, "tau": tau})
    return Run(times, q, qd, tau, name=Path(origin).name, suite=suite, motion=motion)


def _message(
    origin: str, count: int, message: Any, joints: Iterable[str]
) -> tuple[Array, Array, Array]:
    """Return position, velocity and effort of a message, in the order of the joints."""
    order = _order(f"{origin}, message {count} (from 0)", message.name, list(joints))
    parts = []
    for name in ("position", "velocity", "effort"):
        values = np.asarray(getattr(message, name), dtype=np.float64)
        if len(values) != len(message.name):
            raise ReachtubeError(
                f"{origin}: message {count} (from 0) has {len(values)} numbers in {name} for "
                f"{len(message.name)} joints; record {name} of every joint"
            )
        parts.append(values[order])
    return parts[0], parts[1], parts[2]
