"""Linear systems that are seen through their outputs, and the smallest sets of their recordings."""

from __future__ import annotations

import json
from collections.abc import Mapping, Sequence
from os import PathLike, fspath
from typing import Any

import numpy as np
import numpy.typing as npt

from . import _reachtube
from ._arrays import numbers
from ._system_model import OutputTube, SystemModel, name_of, recorded_runs
from .errors import SettingError

#: The matrices of a system, by their names.
MATRICES = ("A", "B", "C", "D", "E", "F")


class System:
    """A linear system x' = A x + B u + E w, y = C x + D u + F v, seen through its outputs.

    Parameters
    ----------
    A
        The matrix A, as in a system file (docs/systems.md); or a state-space system of
        ``scipy.signal`` or python-control, which has A, B, C, D and the step.
    B
        The matrix of the inputs.
    C
        The matrix of the outputs; by default each output is the state of its name.
    D
        The matrix from inputs to outputs.
    E
        The matrix of w; by default B, or 1 without B.
    F
        The matrix of v; by default 1.
    step
        The time between samples of a discrete system, s; ``None`` for a continuous one.
    states
        Names of the states; ``x1`` and so on by default.
    inputs
        Names of the columns of inputs; ``u1`` and so on by default.
    outputs
        Names of the columns of outputs; ``y1`` and so on by default.
    X0
        The set of starts: ``"box"``, ``"none"``, or a dictionary with ``generators`` or
        ``radius``, ``scale`` and ``fixed``.
    W
        The set of disturbances, likewise.
    V
        The set of noise, likewise; none by default.
    centre
        Where the centres of boxes lie: ``"free"`` or ``"zero"``.
    delay
        The delay of each input, s.
    start
        Where recordings start: ``"columns"``, ``{"samples": 10}`` or ``{"at": [..]}``.
    weights
        The weight of each output in the cost.

    Examples
    --------
    >>> import reachtube as rt
    >>> system = rt.System([[0.5]], C=[[1]], step=1.0, start={"at": [4.0]}, X0="none")
    >>> model = system.conform([{"y1": [4.0, 2.0, 1.5]}])
    >>> model.verified, round(model.sets["W"]["scale"][0], 6)
    (True, 0.166667)
    """

    __slots__ = ("_description",)

    def __init__(
        self,
        A: Any,
        B: npt.ArrayLike | None = None,
        C: npt.ArrayLike | None = None,
        D: npt.ArrayLike | None = None,
        E: npt.ArrayLike | None = None,
        F: npt.ArrayLike | None = None,
        *,
        step: float | None = None,
        states: Sequence[str] | None = None,
        inputs: Sequence[str] | None = None,
        outputs: Sequence[str] | None = None,
        X0: str | Mapping[str, Any] | None = None,
        W: str | Mapping[str, Any] | None = None,
        V: str | Mapping[str, Any] | None = None,
        centre: str | None = None,
        delay: Mapping[str, float] | None = None,
        start: str | Mapping[str, Any] | None = None,
        weights: npt.ArrayLike | None = None,
    ) -> None:
        if all(hasattr(A, name) for name in "ABCD"):
            # A system of scipy.signal or python-control; dt is None or 0 for a continuous one.
            given, A = A, A.A
            B, C, D = given.B, given.C, given.D
            dt = getattr(given, "dt", None)
            if dt is True:
                raise SettingError("the step of the system is not known; give its dt")
            step = step if step is not None else (dt or None)
        matrices = {
            name: _matrix(name, given)
            for name, given in zip(MATRICES, (A, B, C, D, E, F), strict=True)
            if given is not None
        }
        width = {name: len(rows[0]) if rows else 0 for name, rows in matrices.items()}
        sets = {"X0": X0, "W": W, "V": V, "centre": centre}
        content: dict[str, Any] = {
            "kind": "continuous" if step is None else "discrete",
            "step": step,
            "states": _names(states, "x", len(matrices["A"])),
            "inputs": _names(inputs, "u", width.get("B", 0)),
            "outputs": _names(outputs, "y", len(matrices.get("C", []))),
            "delay": dict(delay or {}),
            "start": start,
            "weights": None if weights is None else numbers("weights", weights).tolist(),
            "sets": {name: _plain(given) for name, given in sets.items() if given is not None},
            **matrices,
        }
        kept = {name: value for name, value in content.items() if value is not None}
        self._description = json.dumps(_plain(kept))
        _reachtube.check_system(self._description)

    @classmethod
    def load(cls, path: str | PathLike[str]) -> System:
        """Read a system file.

        Parameters
        ----------
        path
            The file, in TOML.

        Returns
        -------
        System
        """
        return cls._of(json.loads(_reachtube.open_system(fspath(path))))

    @classmethod
    def arx(cls, inputs: Sequence[str], outputs: Sequence[str], step: float) -> System:
        """Return a system whose numbers `conform` finds, from columns and the time between samples.

        Parameters
        ----------
        inputs
            Names of columns.
        outputs
            Names of columns.
        step
            The time between samples, s.

        Returns
        -------
        System
        """
        names = {"inputs": list(inputs), "outputs": list(outputs)}
        return cls._of({"kind": "arx", "step": float(step), **names})

    @classmethod
    def _of(cls, description: Mapping[str, Any]) -> System:
        made = cls.__new__(cls)
        made._description = json.dumps(description)
        _reachtube.check_system(made._description)
        return made

    def to_dict(self) -> dict[str, Any]:
        """Return the description, with the keys of a system file."""
        content: dict[str, Any] = json.loads(self._description)
        return content

    def conform(self, runs: Sequence[Any]) -> SystemModel:
        """Find the smallest sets that hold all recordings, and prove them.

        Parameters
        ----------
        runs
            The recordings: each is a dictionary or a data frame with a column for each output and
            input, and ``t`` [s]. A discrete system counts samples without ``t``. A column for each
            state gives the start.

        Returns
        -------
        SystemModel
            It is verified if every recorded output was proved to lie in the reachable set.

        Raises
        ------
        SettingError
            If a recording has not the columns, or its times do not fit.
        """
        recorded = recorded_runs(self.to_dict(), runs)
        return SystemModel._of(*_reachtube.conform_system(self._description, recorded))

    def reach(self, t: npt.ArrayLike) -> OutputTube:
        """Compute the reachable outputs of a system whose sets and start are given.

        Parameters
        ----------
        t : array of shape (K,)
            Times of samples, s, evenly spaced from 0. Inputs are 0.

        Returns
        -------
        OutputTube
        """
        model = SystemModel._of(*_reachtube.given_system(self._description))
        names = [name_of(signal) for key in ("inputs", "outputs") for signal in self.to_dict()[key]]
        times = numbers("t", t)
        run = {name: np.zeros(len(times)) for name in names}
        return model.reach([{"t": times, **run}])[0]

    def __eq__(self, other: object) -> bool:
        return type(other) is System and other._description == self._description

    def __hash__(self) -> int:
        return hash(self._description)

    def __repr__(self) -> str:
        description = self.to_dict()
        outputs = ", ".join(map(name_of, description["outputs"]))
        return f"<System {description['kind']}: outputs {outputs}>"


def _matrix(name: str, given: npt.ArrayLike) -> list[list[float]]:
    rows = numbers(name, given)
    if rows.ndim != 2:
        raise SettingError(f"{name} has the shape {rows.shape}; give rows and columns")
    return [[float(entry) for entry in row] for row in rows]


def _names(given: Sequence[str] | None, letter: str, count: int) -> list[Any]:
    return list(given) if given is not None else [f"{letter}{i + 1}" for i in range(count)]


def _plain(given: Any) -> Any:
    """Return what JSON has, with lists in place of arrays."""
    if isinstance(given, Mapping):
        return {name: _plain(value) for name, value in given.items()}
    return given.tolist() if isinstance(given, np.ndarray) else given
