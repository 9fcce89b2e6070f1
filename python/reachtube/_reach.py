"""Reachable sets along recordings."""

from __future__ import annotations

import json
from collections.abc import Sequence
from dataclasses import dataclass
from os import PathLike, fspath
from pathlib import Path
from typing import Any, Literal

import numpy as np
import numpy.typing as npt

from . import _reachtube
from ._arrays import Array, check_choice, frozen, names, numbers
from ._files import check_new
from ._logs import Logs
from ._model import Model, source_for, text_of
from ._progress import Progress, shown
from ._settings import Data, differing
from ._values import Values
from .errors import SettingError


@dataclass(frozen=True, eq=False, repr=False)
class ReachableSet(Values):
    """The reachable set along a suite, or along one run with a nominal motion of its own.

    Outer: at each sample and over each step between samples, the bounds enclose every state that
    the model can reach, with directed rounding. The noise set V is not part of them.

    Attributes
    ----------
    suite
        The suite.
    run
        The run, if it has a nominal motion of its own.
    t : array of shape (K,)
        Times since the first sample, s.
    nominal : array of shape (K, 2n)
        The nominal motion at samples; q then q̇.
    lower : array of shape (K, 2n)
        Lower bounds at samples.
    upper : array of shape (K, 2n)
        Upper bounds at samples.
    step_lower : array of shape (K - 1, 2n)
        Lower bounds over the steps from one sample to the next.
    step_upper : array of shape (K - 1, 2n)
        Upper bounds over the steps.
    lost
        Where and why the set ended before its suite; ``None`` if it did not.
    units
        Units of the states, 2n: rad and rad/s, or m and m/s for prismatic joints.
    """

    suite: str
    run: str | None
    t: Array
    nominal: Array
    lower: Array
    upper: Array
    step_lower: Array
    step_upper: Array
    lost: dict[str, Any] | None
    units: tuple[str, ...]

    @property
    def joints(self) -> int:
        """The number of joints n."""
        return int(self.nominal.shape[1]) // 2

    def contains(self, states: npt.ArrayLike) -> npt.NDArray[np.bool_]:
        """Return which states are within the bounds at the samples.

        It compares numbers as they are; `check` is what proves enclosure.

        Parameters
        ----------
        states : array of shape (K, 2n)
            States at the samples, q then q̇, in the units of `units`.

        Returns
        -------
        array of bool of shape (K, 2n)
        """
        given = numbers("states", states)
        if given.shape != self.lower.shape:
            raise SettingError(
                f"states has the shape {given.shape}, but {self.lower.shape} is needed: one row "
                "for each sample, one column for each state"
            )
        inside: npt.NDArray[np.bool_] = (self.lower <= given) & (given <= self.upper)
        return inside

    def to_pandas(self) -> Any:
        """Return a pandas DataFrame with one row for each sample.

        The columns are t, then lower, nominal and upper of each state.
        """
        import pandas

        n = self.joints
        columns = {"t": self.t}
        for i in range(2 * n):
            state = f"q{i + 1}" if i < n else f"qd{i - n + 1}"
            parts = {"lower": self.lower, "nominal": self.nominal, "upper": self.upper}
            columns.update({f"{state}_{kind}": part[:, i] for kind, part in parts.items()})
        return pandas.DataFrame(columns)

    def __repr__(self) -> str:
        name = self.suite if self.run is None else f"{self.suite}, {self.run}"
        end = f"lost after {self.t[-1]:g} s" if self.lost else f"{self.t[-1]:g} s"
        return f"<ReachableSet {name}: {len(self.t)} samples, {end}>"


def reach(
    model: Model,
    data: Data | Logs,
    *,
    suites: str | Sequence[str] | None = None,
    until: float | None = None,
    max_gap: float | None = None,
    progress: Progress = None,
) -> list[ReachableSet]:
    """Compute the reachable sets of a model along recordings, at samples and between them.

    Parameters
    ----------
    model
        The model.
    data
        The recordings, as for `check`.
    suites
        Names of the suites to use; all by default.
    until
        Samples later than this many seconds after the first are not used; the model's own limit
        if it is not given.
    max_gap
        Longest time between two samples, s.
    progress
        As for `conform`.

    Returns
    -------
    list of ReachableSet
        One for each suite whose runs share their input, and for each other run.
    """
    with shown(progress, "reach") as tell:
        found = _reachtube.reach(
            text_of(model),
            source_for(model, data, max_gap),
            names(suites),
            differing(None, until, max_gap),
            tell,
        )
    return [
        ReachableSet(
            suite,
            run,
            frozen(t),
            frozen(samples[0]),
            frozen(samples[1]),
            frozen(samples[2]),
            frozen(steps[0]),
            frozen(steps[1]),
            None if lost is None else json.loads(lost),
            model.state_units,
        )
        for suite, run, t, samples, steps, lost in found
    ]


def report(
    model: Model,
    data: Data | Logs,
    folder: str | PathLike[str],
    *,
    suites: str | Sequence[str] | None = None,
    until: float | None = None,
    max_gap: float | None = None,
    assets: Literal["inside", "beside"] = "inside",
    force: bool = False,
    progress: Progress = None,
) -> Path:
    """Write the page that compares a model with recordings.

    Parameters
    ----------
    model
        The model.
    data
        The recordings, as for `check`.
    folder
        Where ``report.html`` is written; it works offline.
    suites
        Names of the suites to use; all by default.
    until
        Samples later than this many seconds after the first are not used; the model's own limit
        if it is not given.
    max_gap
        Longest time between two samples, s.
    assets
        Whether the library of the figures (5 MB) is in the page or beside it.
    force
        Whether a page that exists is replaced.
    progress
        As for `conform`.

    Returns
    -------
    Path
        The page.
    """
    check_choice("assets", assets, ("inside", "beside"))
    check_new(Path(folder) / "report.html", force=force)
    settings = differing(None, until, max_gap)
    with shown(progress, "report") as tell:
        return Path(
            _reachtube.report(
                text_of(model),
                source_for(model, data, max_gap),
                names(suites),
                settings,
                fspath(folder),
                assets == "beside",
                tell,
            )
        )

