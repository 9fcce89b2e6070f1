"""Recordings from robot logs and from files of other libraries.

`bag` reads MCAP and rosbag2; `ros1`, `parquet`, `npz` and `hdf5` read what Python libraries write.
Every reader gives `Run`, and joints are matched by name where the file names them.
"""

from __future__ import annotations

import logging
import warnings
from collections.abc import Iterator, Sequence
from contextlib import contextmanager
from os import PathLike, fspath
from pathlib import Path
from typing import Any, Literal

import numpy as np

from . import _reachtube
from ._arrays import Array, above_zero, check_choice, names
from ._recordings import Recordings, Run
from ._tables import check_finite, places_of, run_of_arrays, run_of_columns
from .errors import ReachtubeError, ReachtubeWarning

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

    Returns
    -------
    Recordings

    Raises
    ------
    DefectsError
        Values that are missing or not finite, and gaps.
    ReachtubeError
        A damaged file, with the byte; a joint that is not in the log, with the joints that are.
    """
    check_choice("time", time, ("header", "log"))
    slow = above_zero("rest_speed", rest_speed, "rad/s")
    limit = None if max_gap is None else above_zero("max_gap", max_gap)
    files = [paths] if isinstance(paths, (str, PathLike)) else list(paths)
    found, notes, lost = _reachtube.read_log(
        [fspath(path) for path in files],
        names(topic),
        names(joints),
        time == "log",
        recover,
        (marker, bool(repeats), slow, limit),
    )
    for note in notes:
        log.info(note)
    for loss in lost:
        warnings.warn(loss, ReachtubeWarning, 2)
    return Recordings(
        Run._of(run, own_suite or suite, own_motion or motion, name)
        for run, name, own_suite, own_motion in found
    )


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

    Returns
    -------
    Run

    Raises
    ------
    DefectsError
        Values that are not finite.
    ReachtubeError
        A file that cannot be read, or that lacks a column.
    """
    from pyarrow import parquet as files

    with _opened(path):
        found = files.read_table(fspath(path))
    columns = {name: found.column(name).to_numpy() for name in found.column_names}
    return run_of_columns(fspath(path), columns, joints, suite, motion)


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
        The file. An array ``joints`` names the columns of the others if there is one.
    joints
        Names of the robot's joints, in its order; the file must name its own then.
    suite
        The suite of the run.
    motion
        The motion of the run.

    Returns
    -------
    Run

    Raises
    ------
    DefectsError
        Values that are not finite.
    ReachtubeError
        A file that cannot be read, or that lacks an array or a joint.
    """
    with _opened(path), np.load(path, allow_pickle=False) as file:
        arrays = {name: file[name] for name in file.files}
    return run_of_arrays(fspath(path), arrays, joints, suite, motion)


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

    Returns
    -------
    Run

    Raises
    ------
    DefectsError
        Values that are not finite.
    ReachtubeError
        A file that cannot be read, or that lacks the group, an array or a joint.
    """
    import h5py

    with _opened(path), h5py.File(path, "r") as file:
        if group not in file:
            raise ReachtubeError(f"{path}: there is no group {group}; there are {', '.join(file)}")
        found = file[group]
        arrays = {name: found[name][()] for name in found if hasattr(found[name], "dtype")}
        if "joints" in found.attrs:
            arrays.setdefault("joints", found.attrs["joints"])
    return run_of_arrays(fspath(path), arrays, joints, suite, motion)


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

    Returns
    -------
    Run

    Raises
    ------
    DefectsError
        Values that are not finite.
    ReachtubeError
        A bag that cannot be read, or that lacks the topic or a joint.
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
    check_finite(origin, {"q": q, "qd": qd, "tau": tau})
    return Run(times, q, qd, tau, name=Path(origin).name, suite=suite, motion=motion)


def _message(
    origin: str, count: int, message: Any, joints: Sequence[str]
) -> tuple[Array, Array, Array]:
    """Return position, velocity and effort of a message, in the order of the joints."""
    order = places_of(f"{origin}, message {count} (from 0)", message.name, joints)
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
