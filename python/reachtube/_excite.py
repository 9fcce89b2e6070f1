"""Exciting motions."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any, Literal

import numpy.typing as npt

from . import _reachtube
from ._arrays import Array, above_zero, check_choice, frozen, numbers, real, whole
from ._robot import Robot, native_of
from ._values import Values
from .errors import SettingError

#: Largest number of samples of a motion, and of harmonics of a joint.
MOST_SAMPLES, MOST_HARMONICS = 10_000_000, 1000


@dataclass(frozen=True, eq=False, repr=False)
class Excitation(Values):
    """A periodic motion that excites a robot's parameters, within its joint limits.

    Attributes
    ----------
    t : array of shape (K,)
        Times over one period, s.
    q : array of shape (K, n)
        Positions, rad.
    qd : array of shape (K, n)
        Velocities, rad/s.
    qdd : array of shape (K, n)
        Accelerations, rad/s².
    condition
        Condition number of the base regressor of this motion.
    random_condition
        Condition number of the base regressor of a random motion.
    """

    t: Array
    q: Array
    qd: Array
    qdd: Array
    condition: float
    random_condition: float

    def to_pandas(self) -> Any:
        """Return a pandas DataFrame with one row for each sample: t, q1.., qd1.., qdd1..."""
        import pandas

        columns = {"t": self.t}
        for prefix, values in {"q": self.q, "qd": self.qd, "qdd": self.qdd}.items():
            columns.update({f"{prefix}{j + 1}": column for j, column in enumerate(values.T)})
        return pandas.DataFrame(columns)

    def __repr__(self) -> str:
        return (
            f"<Excitation {self.t[-1]:g} s, {self.q.shape[1]} joints: condition number "
            f"{self.condition:.4g}, of a random motion {self.random_condition:.4g}>"
        )


def excite(
    robot: Robot,
    *,
    period: float = 10.0,
    harmonics: int = 5,
    criterion: Literal["determinant", "condition"] = "determinant",
    margin: float = 0.9,
    speed: float = 1.0,
    acceleration: npt.ArrayLike = (),
    torque_noise: npt.ArrayLike = (),
    starts: int = 4,
    trials: int = 1500,
    seed: int = 1,
    rate: float = 100.0,
) -> Excitation:
    """Design a motion that excites a robot's parameters, within its joint limits.

    The motion keeps within the joint limits only: check that the arm hits neither itself nor its
    surroundings before you run it.

    Parameters
    ----------
    robot
        The robot.
    period
        Period, s.
    harmonics
        Number of harmonics of each joint's Fourier series.
    criterion
        The determinant of the information matrix (D-optimal), or the condition number.
    margin
        The part of the limits that the motion may use.
    speed
        Largest speed of joints without a limit, rad/s.
    acceleration
        Largest accelerations, rad/s²: none, one, or n numbers.
    torque_noise
        Standard deviations of the torque, N m: none, one, or n numbers.
    starts
        Number of searches.
    trials
        Number of motions that each search tries.
    seed
        The seed of the random numbers.
    rate
        Samples per second; the period has 10 million samples at most.

    Returns
    -------
    Excitation

    Raises
    ------
    SettingError
        An argument that is not possible.
    """
    period, rate = above_zero("period", period), above_zero("rate", rate, "Hz")
    if period * rate > MOST_SAMPLES:
        raise SettingError(
            f"a period of {period} s at a rate of {rate} per second has {period * rate:g} "
            f"samples; choose period and rate so that there are {MOST_SAMPLES} at most"
        )
    check_choice("criterion", criterion, ("determinant", "condition"))
    limits = numbers("acceleration", acceleration).ravel().tolist()
    noise = numbers("torque_noise", torque_noise).ravel().tolist()
    if len(noise) == 1:
        noise *= robot.joints
    t, motion, condition, random = _reachtube.excite(
        native_of(robot),
        period,
        whole("harmonics", harmonics, 1, MOST_HARMONICS),
        criterion == "condition",
        real("margin", margin),
        real("speed", speed),
        limits,
        noise,
        whole("starts", starts, 1),
        whole("trials", trials, 1),
        whole("seed", seed),
        rate,
    )
    q, qd, qdd = (frozen(values) for values in motion)
    return Excitation(frozen(t), q, qd, qdd, condition, random)
