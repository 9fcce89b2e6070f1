"""Recordings filtered and cut into windows."""

from __future__ import annotations

import logging
from collections.abc import Mapping, Sequence
from typing import Any

import numpy.typing as npt

from . import _reachtube
from ._arrays import above_zero, finite, json_of, mapping, names
from ._logs import Logs, native_of_logs
from ._recordings import Recordings
from ._robot import Robot, native_of

log = logging.getLogger("reachtube")


def prepare(
    robot: Robot,
    data: Logs,
    *,
    repeats: bool = False,
    window: float | None = None,
    cut_off: float | None = None,
    gains: npt.ArrayLike | None = None,
    joints: Sequence[str] | None = None,
    compensate: bool = False,
    torque: str | None = None,
    columns: Mapping[str, str | int] | None = None,
    max_gap: float | None = None,
) -> Recordings:
    """Filter recordings, cut them into windows, and return them as test suites in memory.

    Sample times are made even, and positions, velocities and torques are filtered forward and
    backward, without delay, as ``reachtube prepare`` does. Changes are logged to the logger
    ``reachtube``.

    Parameters
    ----------
    robot
        The robot that was recorded.
    data
        Logs: paths of CSV files or folders, runs, or a data set.
    repeats
        Whether logs whose names differ only after the last ``_`` are repeats of one motion: they
        are aligned in time, and each window of all of them is one suite.
    window
        Length of the windows, above 0 s; whole recordings if it is not given.
    cut_off
        Cut-off frequency of the low-pass, above 0 and below half the sample rate, Hz; chosen from
        the recordings if it is not given.
    gains
        Factors of the recorded torques, n; for motor currents in N m/A.
    joints
        Names of the robot's joints in the order of the recorded columns; the robot's order if they
        are not given.
    compensate
        Whether the torque becomes the input u: motor torque less the robot's gravity and dry
        friction, for ``torque="compensated"``.
    torque
        The kind of the recorded torques, if they are compensated: ``"motor"``, the default, or
        ``"link"`` for torques behind the gear, which are the input of a robot without ``armature``.
    columns
        Columns of logs with ambiguous names, by the keys ``q``, ``qd``, ``tau``, ``current``,
        ``time``, ``rate``, ``first``, ``time_unit`` and ``angle``, such as
        ``{"q": "pos_{}", "first": 0}``.
    max_gap
        Longest time between two samples, above 0 s.

    Returns
    -------
    Recordings
        One run for each window, for `conform`.

    Raises
    ------
    DefectsError
        Recordings with defects, all of them.
    ReachtubeError
        If no recording is as long as a window.

    Examples
    --------
    >>> import numpy as np, reachtube as rt
    >>> robot = rt.Robot.lwa4p()
    >>> t = np.arange(0.0, 3.0, 0.004)
    >>> q = 0.3 * np.sin(2 * t[:, None] + np.arange(6))
    >>> qd = 0.6 * np.cos(2 * t[:, None] + np.arange(6))
    >>> run = rt.Run(t, q, qd, robot.gravity(q), name="wave")
    >>> windows = rt.prepare(robot, run, window=0.5, cut_off=10.0, compensate=True)
    >>> len(windows), windows.suites[:2]
    (5, ['wave_w01', 'wave_w02'])
    """
    settings: dict[str, Any] = {"joints": names(joints)}
    if cut_off is not None:
        settings["cut_off"] = above_zero("cut_off", cut_off, "Hz")
    if max_gap is not None:
        settings["max_gap"] = above_zero("max_gap", max_gap)
    length = None if window is None else above_zero("window", window)
    if gains is not None:
        settings["gains"] = finite("gains", gains)
    if torque is not None:
        settings["torque"] = torque
    if columns is not None:
        settings["columns"] = mapping("columns", columns)
    paths, runs = native_of_logs(data)
    native, used, changes = _reachtube.prepare(
        native_of(robot),
        paths,
        runs,
        json_of("settings", settings),
        (length, repeats, compensate),
    )
    log.info("the cut-off frequency is %g Hz", used)
    for change in changes:
        log.info(change)
    return Recordings._of(native)
