"""Arms under their controllers: models of commanded and actual positions."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from os import PathLike, fspath
from typing import Any, ClassVar

import numpy as np
import numpy.typing as npt

from . import _reachtube
from ._arrays import Array, above_zero, frozen, numbers
from ._sealed import SampleCheck, SealedModel
from ._values import Values
from .errors import SettingError

#: Names of times, and of commanded and actual positions, by which they are found.
TIMES = ("t", "time", "timestamp")
PAIRS = (
    ("command", "actual"),
    ("action", "observation.state"),
    ("q_d", "q"),
    ("target_q", "actual_q"),
    ("desired", "actual"),
    ("reference", "feedback"),
)


class TrackingModel(SealedModel):
    """A model of an arm under its controller: how far it strays from its command.

    Examples
    --------
    >>> import numpy as np, reachtube as rt
    >>> t = 0.01 * np.arange(400)
    >>> late = lambda k: np.sin((1 + 0.1 * k) * (t[:, None] - 0.01)) * 0.5
    >>> command = lambda k: np.sin((1 + 0.1 * k) * t[:, None]) * 0.5
    >>> runs = [{"t": t, "command": command(k), "actual": late(k)} for k in range(4)]
    >>> model = rt.TrackingModel.of(runs, joints=["hinge"])
    >>> model.useful, round(1e3 * model.lags["hinge"], 1)
    (True, 10.0)
    """

    __slots__ = ()
    _command: ClassVar[str] = "model"
    _parse = staticmethod(_reachtube.parse_tracking)

    @classmethod
    def of(
        cls,
        runs: Sequence[Any],
        *,
        joints: Sequence[str] | None = None,
        units: Sequence[str] | None = None,
    ) -> TrackingModel:
        """Make a model of recordings of one arm.

        Parameters
        ----------
        runs
            The recordings: each is a dictionary or a data frame with times (``t``, ``time`` or
            ``timestamp``) [s], and commanded and actual positions (``command`` and ``actual``, or
            ``action`` and ``observation.state``), one row for each sample [rad].
        joints
            The names of the joints; ``joint_0`` and so on by default.
        units
            ``"rad"`` or ``"m"`` for each joint; all are revolute by default.

        Returns
        -------
        TrackingModel
            It is useful if each sample is proved to lie in the sets, and these are narrower than
            the largest error + 20 %.

        Raises
        ------
        SettingError
            If a recording has not these numbers, or they are no measurement.
        """
        followed = [_followed(number, run) for number, run in enumerate(runs, start=1)]
        if not followed:
            raise SettingError("no recordings are given")
        count = followed[0][2].shape[1]
        names = list(joints) if joints is not None else [f"joint_{i}" for i in range(count)]
        kinds = list(units) if units is not None else ["rad"] * count
        for what, given in (("joints", names), ("units", kinds)):
            if len(given) != count:
                raise SettingError(f"{what} has {len(given)} entries for {count} joints")
        if wrong := sorted(set(kinds) - {"rad", "m"}):
            raise SettingError(f"units has {', '.join(wrong)}; give rad or m")
        of_arm = list(zip(names, kinds, strict=True))
        _check_widths(followed, count)
        return cls._of(*_reachtube.make_tracking(of_arm, followed))

    @property
    def joints(self) -> list[str]:
        """The names of the joints."""
        return [joint["name"] for joint in self._model["joints"]]

    @property
    def lags(self) -> dict[str, float]:
        """The time by which each joint is late, s."""
        model = self._model
        return {joint["name"]: model["delay"] - joint["speed"] for joint in model["joints"]}

    def check(self, runs: Sequence[Any]) -> TrackingCheck:
        """Compare other recordings with the model.

        Parameters
        ----------
        runs
            The recordings, as for `of`.

        Returns
        -------
        TrackingCheck
            It is true if every position was proved to lie in its set.
        """
        followed = [_followed(number, run) for number, run in enumerate(runs, start=1)]
        of_arm = [(joint["name"], joint["unit"]) for joint in self._model["joints"]]
        _check_widths(followed, len(of_arm))
        return TrackingCheck(_reachtube.check_tracking(self._file, of_arm, followed))

    def tube(self, t: npt.ArrayLike, command: npt.ArrayLike) -> PlanTube:
        """Return where the joints can be while the arm follows a plan.

        Parameters
        ----------
        t : array of shape (K,)
            Times of the samples, s.
        command : array of shape (K, n)
            Commanded positions, rad.

        Returns
        -------
        PlanTube

        Raises
        ------
        SettingError
            If the plan does not fit the joints.
        ReachtubeError
            If it is faster than the recordings.
        """
        times, positions = _times("the plan", t), _rows("command", command)
        _check_widths([("the plan", times, positions, positions)], len(self.joints))
        lower, upper = _reachtube.plan_tube(self._file, times, positions)
        return PlanTube(tuple(self.joints), *map(frozen, (times, positions, lower, upper)))

    def tolerances(self) -> dict[str, tuple[float, float]]:
        """Return for each joint the tolerance along a trajectory and at its goal, rad."""
        return {name: (along, goal) for name, along, goal in _reachtube.tolerances(self._file)}

    def padding(
        self, urdf: str | PathLike[str], *, speed: float = 1.0, same_time: bool = False
    ) -> dict[str, float]:
        """Return by how much the links of a URDF have to grow to hold the arm in any pose.

        Parameters
        ----------
        urdf
            The file, with collision shapes.
        speed
            The part of the recorded speeds that plans reach, up to 1.
        same_time
            Whether obstacles move, so that the arm is compared with the plan at the same time; by
            default it is compared with the path.

        Returns
        -------
        dict
            The padding of each link, m.
        """
        part = above_zero("speed", speed, "of the recorded speeds")
        if part > 1.0:
            raise SettingError(f"speed is {part}; give a part of the recorded speeds, up to 1")
        links = _reachtube.paddings(self._file, fspath(urdf), part)
        return {link: time if same_time else path for link, path, time in links}


class TrackingCheck(SampleCheck):
    """The answer of a check: whether actual positions lie in the sets."""

    __slots__ = ()
    _values: ClassVar[str] = "positions"

    @property
    def motions(self) -> list[dict[str, Any]]:
        """For each motion the part of the sets that it needs, with joint and time."""
        return list(self._content["motions"])


@dataclass(frozen=True, eq=False, repr=False)
class PlanTube(Values):
    """Where the joints of an arm can be at the samples of a plan: outer bounds.

    Attributes
    ----------
    joints
        Names of the joints, n.
    t : array of shape (K,)
        Times, s.
    command : array of shape (K, n)
        The plan, rad.
    lower : array of shape (K, n)
        Lower bounds, rad.
    upper : array of shape (K, n)
        Upper bounds, rad.
    """

    joints: tuple[str, ...]
    t: Array
    command: Array
    lower: Array
    upper: Array

    def __repr__(self) -> str:
        return f"<PlanTube of {', '.join(self.joints)}: {len(self.t)} samples>"


def _followed(number: int, run: Mapping[str, Any]) -> tuple[str, Array, Array, Array]:
    """Return name, times, commanded and actual positions of a recording."""
    name = f"run {number}"
    time = next((key for key in TIMES if key in run), None)
    pair = next((pair for pair in PAIRS if all(key in run for key in pair)), None)
    if time is None or pair is None:
        raise SettingError(
            f"{name} has no {'times' if time is None else 'commanded and actual positions'}; give "
            "t, command and actual"
        )
    times = _times(name, run[time])
    command, actual = (_rows(f"{key} of {name}", run[key]) for key in pair)
    if not len(times) == len(command) == len(actual) or command.shape != actual.shape:
        shapes = f"{times.shape}, {command.shape} and {actual.shape}"
        raise SettingError(f"{name}: times and positions have the shapes {shapes}")
    return name, times, command, actual


def _times(name: str, values: npt.ArrayLike) -> Array:
    times = numbers(f"the times of {name}", values).ravel()
    if not (np.isfinite(times).all() and (np.diff(times) > 0).all()):
        raise SettingError(f"the times of {name} do not increase")
    return times - times[0] if len(times) else times


def _rows(name: str, values: Any) -> Array:
    """Return positions with a row for each sample; a column of a frame may hold arrays."""
    given = np.asarray(values)
    if given.dtype == object:
        try:
            given = np.stack([np.asarray(row, dtype=np.float64) for row in given])
        except (TypeError, ValueError):
            raise SettingError(f"{name} has rows of different lengths") from None
    rows = numbers(name, given)
    rows = rows.reshape(-1, 1) if rows.ndim == 1 else rows
    if rows.ndim != 2 or not np.isfinite(rows).all():
        raise SettingError(f"{name} is no table of finite numbers, with a row for each sample")
    return rows


def _check_widths(followed: Sequence[tuple[str, Array, Array, Array]], count: int) -> None:
    for name, times, command, _ in followed:
        if command.shape[1] != count:
            width = command.shape[1]
            raise SettingError(f"{name} has positions of {width} joints, but {count} are needed")
        if not len(times) == len(command) >= 3:
            raise SettingError(
                f"{name} has {len(times)} times and {len(command)} positions; give as many of "
                "both, and 3 at least"
            )
