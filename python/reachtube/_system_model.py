"""Models of linear systems: the smallest sets of recordings, checks, and reachable outputs."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import Any, ClassVar

import numpy as np

from . import _reachtube
from ._arrays import Array, frozen, numbers
from ._sealed import SampleCheck, SealedModel
from ._values import Values
from .errors import SettingError


class SystemModel(SealedModel):
    """A system with the smallest sets for which its reachable outputs hold recordings."""

    __slots__ = ()
    _command: ClassVar[str] = "conform"
    _parse = staticmethod(_reachtube.parse_system)

    @property
    def sets(self) -> dict[str, Any]:
        """X0, W and V, each with ``centre``, ``generators`` and ``scale``."""
        return dict(self._model["sets"])

    def check(self, runs: Sequence[Any]) -> SystemCheck:
        """Compare other recordings with the model.

        Parameters
        ----------
        runs
            The recordings, as for `System.conform`.

        Returns
        -------
        SystemCheck
            It is true if every output was proved to lie in the reachable set.
        """
        recorded = recorded_runs(self._model["system"], runs)
        return SystemCheck(_reachtube.check_runs(self._file, recorded))

    def reach(self, runs: Sequence[Any]) -> list[OutputTube]:
        """Compute the reachable outputs along recordings.

        Parameters
        ----------
        runs
            The recordings, as for `System.conform`.

        Returns
        -------
        list of OutputTube
        """
        system = self._model["system"]
        recorded = recorded_runs(system, runs)
        names = tuple(map(name_of, system["outputs"]))
        tubes = _reachtube.reach_runs(self._file, recorded)
        # A motion that starts from its past has fewer samples.
        return [
            OutputTube(names, frozen(times[len(times) - len(low) :]), *map(frozen, (at, low, high)))
            for (_, times, *_), (at, low, high) in zip(recorded, tubes, strict=True)
        ]


class SystemCheck(SampleCheck):
    """The answer of a check: whether recorded outputs lie in the reachable set."""

    __slots__ = ()
    _values: ClassVar[str] = "values"

    @property
    def runs(self) -> list[dict[str, Any]]:
        """For each recording the part of the sets that it needs, with output and time."""
        return list(self._content["runs"])


@dataclass(frozen=True, eq=False, repr=False)
class OutputTube(Values):
    """The reachable outputs at samples: outer bounds of their hull, with directed rounding.

    Attributes
    ----------
    outputs
        Names of the outputs, p.
    t : array of shape (K,)
        Times, s.
    nominal : array of shape (K, p)
        The nominal outputs.
    lower : array of shape (K, p)
        Lower bounds.
    upper : array of shape (K, p)
        Upper bounds.
    """

    outputs: tuple[str, ...]
    t: Array
    nominal: Array
    lower: Array
    upper: Array

    def __repr__(self) -> str:
        return f"<OutputTube of {', '.join(self.outputs)}: {len(self.t)} samples>"


def name_of(signal: str | Mapping[str, str]) -> str:
    """Return the name of a signal, which may have a unit."""
    return signal if isinstance(signal, str) else signal["name"]


def recorded_runs(system: Mapping[str, Any], runs: Sequence[Any]) -> list[Any]:
    """Return recordings as the product takes them."""
    inputs, outputs, states = (
        [name_of(signal) for signal in system.get(key, [])]
        for key in ("inputs", "outputs", "states")
    )
    recorded = []
    for number, run in enumerate(runs, start=1):
        missing = [name for name in (*outputs, *inputs) if name not in run]
        if missing:
            raise SettingError(f"run {number} has no column {', '.join(missing)}")
        columns = {
            name: numbers(f"{name} of run {number}", run[name]).ravel()
            for name in ("t", *outputs, *inputs, *states)
            if name in run
        }
        count = len(columns[outputs[0]])
        if wrong := sorted(name for name, column in columns.items() if len(column) != count):
            raise SettingError(f"run {number}: {', '.join(wrong)} has not {count} samples")
        for name, column in columns.items():
            if not np.isfinite(column).all():
                raise SettingError(f"{name} of run {number} is not finite at every sample")
        if "t" not in columns and system.get("step") is None:
            raise SettingError(f"run {number} has no times t, which a continuous system needs")
        times: Any = columns.get("t")
        if times is None:
            times = np.arange(count) * float(system["step"])
        if not (np.diff(times) > 0).all():
            raise SettingError(f"the times of run {number} do not increase")

        rows = [
            np.column_stack([columns[name] for name in names] or [np.zeros((count, 0))])
            for names in (inputs, outputs)
        ]
        known = states and all(name in columns for name in states)
        start = [float(columns[name][0]) for name in states] if known else None
        recorded.append((f"run {number}", times, *rows, start))
    if not recorded:
        raise SettingError("no recordings are given")
    return recorded
