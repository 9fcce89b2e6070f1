"""A monitor: samples of a running robot beside the sets of a model."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING, Literal

import numpy as np
import numpy.typing as npt

from . import _reachtube
from ._arrays import Array, above_zero, frozen, numbers
from ._findings import Finding, findings_of
from ._model import text_of
from ._recordings import source
from .errors import SettingError

if TYPE_CHECKING:
    from ._model import Model
    from ._settings import Data


@dataclass(frozen=True)
class Leave:
    """A measured value outside the reachable set of a window."""

    time: float
    """Time of the sample, s."""
    window: float
    """Time of the window's first sample, s."""
    part: int
    """The part of the system, such as a joint, from 1."""
    state: str
    """The state, such as ``q1`` or ``qd1``."""
    side: Literal["upper", "lower"]
    """The side of the set."""
    value: float
    """The measured value, rad or rad/s."""
    excess: float
    """How far outside, rad or rad/s."""
    radius: float
    """The radius of the set, rad or rad/s."""
    proved: bool
    """Whether it is proved that no disturbance of the model explains the window."""
    first: bool
    """Whether it is the first value of its window outside."""


@dataclass(frozen=True)
class Alarm:
    """A number outside its range in healthy motion: calibrated, not proved."""

    time: float
    """Time of the sample, s."""
    fault: Literal["push", "drag", "payload"]
    """What changed: a sudden torque, the friction of a joint, or the mass at the tip."""
    part: int | None
    """The part of the system, such as a joint, from 1; ``None`` for the payload."""
    value: float
    """The number, N m or kg."""
    low: float
    """The least number without an alarm."""
    high: float
    """The largest number without an alarm."""


class Monitor:
    """Compares samples with the reachable sets of a linear model as they are recorded.

    Make one with `monitor`. Windows of the motion begin at measured states and overlap. Within
    each, values are compared as `check` compares the rows of a recording.
    """

    __slots__ = ("_native",)

    def __init__(self, native: _reachtube.Monitor) -> None:
        if not isinstance(native, _reachtube.Monitor):
            raise SettingError("monitor(model, step=SECONDS) makes a monitor")
        self._native = native

    def push(
        self,
        t: npt.ArrayLike,
        q: npt.ArrayLike,
        qd: npt.ArrayLike,
        tau: npt.ArrayLike,
    ) -> list[Leave]:
        """Take one sample, or K of them, and return the values that are outside.

        Parameters
        ----------
        t
            Time of a sample, or K times, s.
        q
            Positions, n or K x n, rad (m for prismatic joints).
        qd
            Velocities, n or K x n, rad/s (m/s for prismatic joints).
        tau
            Torques of the model's kind, n or K x n, N m (N for prismatic joints).

        Returns
        -------
        list of Leave
            Empty if every value is in the sets.

        Raises
        ------
        SettingError
            For a sample that cannot be used, by its index; those before it count.
        """
        # One sample is a batch of one.
        times = np.atleast_1d(numbers("t", t))
        parts = {name: numbers(name, part) for name, part in (("q", q), ("qd", qd), ("tau", tau))}
        if np.ndim(t) == 0:
            parts = {name: part[np.newaxis] for name, part in parts.items()}
        return [Leave(*left) for left in self._native.push(times, *parts.values())]

    def finish(self) -> None:
        """End a recording, and begin anew at any time."""
        self._native.finish()

    @property
    def alarms(self) -> list[Alarm]:
        """All alarms so far; none unless the monitor was made with ``healthy``."""
        return [Alarm(*alarm) for alarm in self._native.alarms()]  # type: ignore[arg-type]

    @property
    def alarm_bound(self) -> float | None:
        """How probable an alarm is, at most, in one more healthy recording."""
        return self._native.alarm_bound()

    @property
    def findings(self) -> list[Finding]:
        """What was found so far: the verdict, the first value outside, the first alarm."""
        return findings_of(self._native.findings())

    @property
    def samples(self) -> int:
        """Number of samples that were judged."""
        return self._native.totals()[0]

    @property
    def windows(self) -> int:
        """Number of windows that ended."""
        return self._native.totals()[1]

    @property
    def windows_left(self) -> int:
        """Number of windows with a value outside."""
        return self._native.totals()[2]

    @property
    def rows(self) -> int:
        """Number of rows: the values of windows in one state at one sample."""
        return self._native.totals()[3]

    @property
    def rows_outside(self) -> int:
        """Number of rows that do not hold."""
        return self._native.totals()[4]

    @property
    def used(self) -> Array:
        """The part of the set's radius that the open windows and the last one used, 2n."""
        return frozen(self._native.used())

    @property
    def largest_used(self) -> Array:
        """The largest part of the set's radius that was used, 2n."""
        return frozen(self._native.largest_used())

    @property
    def drift(self) -> Array:
        """Where in the set windows end, in parts of its radius, on average over about 16, 2n."""
        return frozen(self._native.drift())

    @property
    def delay(self) -> float:
        """The time by which answers are late, s, if samples are filtered."""
        return self._native.delay()

    @property
    def horizon(self) -> float:
        """The length of a window, s."""
        return self._native.horizon()

    def __repr__(self) -> str:
        left = "never left" if self.windows_left == 0 else f"{self.windows_left} windows left"
        return f"<Monitor {left}: {self.samples} samples, {self.windows} windows ended>"


def monitor(
    model: Model,
    *,
    step: float,
    horizon: float | None = None,
    every: float | None = None,
    max_gap: float | None = None,
    differentiate: bool = False,
    healthy: Data | None = None,
) -> Monitor:
    """Return a monitor of a linear model for samples of a running robot.

    Parameters
    ----------
    model
        The model. Where its logs were filtered, samples are too, and answers come later.
    step
        Time between samples, s. Samples at other times are interpolated.
    horizon
        Length of a window, s; by default as long as the model's recordings were used.
    every
        Time from the beginning of one window to the next, s; by default a quarter of a window.
    max_gap
        The longest time between two samples, s; by default 1.9 steps.
    differentiate
        Take velocities from the filtered positions.
    healthy
        At least two recordings of healthy motion, as samples are given: the monitor raises an
        alarm, too, for a sudden torque, a drag or a payload outside its range in them.

    Returns
    -------
    Monitor

    Examples
    --------
    >>> watch = reachtube.monitor(model, step=0.004, horizon=0.2)  # doctest: +SKIP
    >>> for left in watch.push(run.t, run.q, run.qd, run.tau):  # doctest: +SKIP
    ...     print(left.time, left.state, left.excess)
    """

    def optional(name: str, value: float | None) -> float | None:
        return None if value is None else above_zero(name, value)

    native = _reachtube.Monitor(
        text_of(model),
        above_zero("step", step),
        optional("horizon", horizon),
        optional("every", every),
        optional("max_gap", max_gap),
        bool(differentiate),
        None if healthy is None else source(healthy),
    )
    return Monitor(native)
