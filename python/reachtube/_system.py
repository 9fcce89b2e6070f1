"""Linear systems that are seen through their outputs, and the smallest sets of their recordings."""

from __future__ import annotations

import json
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from os import PathLike, fspath
from pathlib import Path
from typing import Any

import numpy as np
import numpy.typing as npt

from . import _reachtube
from ._arrays import Array, frozen, numbers
from ._files import write_new
from ._findings import Finding
from ._record import Record
from ._values import Values
from .errors import ReachtubeError, SettingError

#: The matrices of a system, by their names.
MATRICES = ("A", "B", "C", "D", "E", "F")


class System:
    """A linear system x' = A x + B u + E w, y = C x + D u + F v, seen through its outputs.

    Parameters
    ----------
    A, B, C, D, E, F
        The matrices, as in a system file (docs/systems.md). A state-space system of
        ``scipy.signal`` or python-control stands for A, B, C, D and the step.
    step
        The time between samples of a discrete system, s; ``None`` for a continuous one.
    states, inputs, outputs
        Names; inputs and outputs have the names of their columns. ``x1``, ``u1`` and ``y1`` on by
        default.
    X0, W, V
        The sets: ``"box"``, ``"none"``, or a dictionary with ``generators`` or ``radius``,
        ``scale`` and ``fixed``.
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
        try:
            import tomllib
        except ImportError:  # Python 3.10
            import tomli as tomllib
        try:
            with open(path, "rb") as file:
                return cls._of(tomllib.load(file))
        except (OSError, tomllib.TOMLDecodeError) as error:
            raise ReachtubeError(f"{path}: {error}; give a TOML file with a system") from None

    @classmethod
    def arx(cls, inputs: Sequence[str], outputs: Sequence[str], step: float) -> System:
        """Return a system whose numbers `conform` finds, from columns and the time between samples.

        Parameters
        ----------
        inputs, outputs
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
        recorded = _recorded(self.to_dict(), runs)
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
        model = SystemModel._of(_reachtube.given_system(self._description))
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


class SystemModel(Record):
    """A system with the smallest sets for which its reachable outputs hold recordings."""

    __slots__ = ()

    @property
    def _model(self) -> dict[str, Any]:
        model: dict[str, Any] = json.loads(self._content["model"])
        return model

    @classmethod
    def _of(cls, text: str, said: str = "{}") -> SystemModel:
        """Return the model of a file's text, with findings and summary, if any."""
        return cls(json.dumps({"model": text, **json.loads(said)}))

    @property
    def verified(self) -> bool:
        """Whether every recorded output was proved to lie in the reachable set."""
        return bool(self._model["verified"])

    @property
    def useful(self) -> bool:
        """Whether it is verified, and narrower than outputs that are held or go on."""
        without = self._model.get("without_model")
        return self.verified and (without is None or without["narrower"] > 1.0)

    @property
    def sets(self) -> dict[str, Any]:
        """X0, W and V, each with ``centre``, ``generators`` and ``scale``."""
        return dict(self._model["sets"])

    @property
    def system(self) -> System:
        """The system, with the numbers that were found."""
        return System._of(self._model["system"])

    @property
    def findings(self) -> list[Finding]:
        """What spoke against the model when it was made; a file has none of it."""
        return [Finding._of(dict(finding)) for finding in self._content.get("findings", [])]

    def to_dict(self) -> dict[str, Any]:
        """Return the model's file as a new dictionary."""
        return self._model

    def save(self, path: str | PathLike[str], *, force: bool = False) -> None:
        """Write the model's file, whole or not at all.

        Parameters
        ----------
        path
            The file, in JSON.
        force
            Whether a file that exists is replaced.
        """
        write_new(Path(path), self._content["model"], force=force)

    @classmethod
    def load(cls, path: str | PathLike[str]) -> SystemModel:
        """Read a file that `save` or ``reachtube conform --system --out`` wrote.

        Parameters
        ----------
        path
            The file.

        Returns
        -------
        SystemModel
        """
        try:
            text = Path(path).read_text(encoding="utf-8")
        except (OSError, UnicodeDecodeError) as error:
            raise ReachtubeError(f"{path}: {error}; give a file that `conform` wrote") from None
        return cls._of(_reachtube.parse_system(text, fspath(path)))

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
        recorded = _recorded(self._model["system"], runs)
        return SystemCheck(_reachtube.check_runs(self._content["model"], recorded))

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
        recorded = _recorded(system, runs)
        names = tuple(map(name_of, system["outputs"]))
        tubes = _reachtube.reach_runs(self._content["model"], recorded)
        # A motion that starts from its past has fewer samples.
        return [
            OutputTube(names, frozen(times[len(times) - len(low) :]), *map(frozen, (at, low, high)))
            for (_, times, *_), (at, low, high) in zip(recorded, tubes, strict=True)
        ]

    def __bool__(self) -> bool:
        return self.useful

    def __str__(self) -> str:
        return str(self._content.get("summary", repr(self)))

    def __repr__(self) -> str:
        word = "conformant" if self.verified else "NOT PROVED conformant"
        if self.verified and not self.useful:
            word += ", but vacuous"
        return f"<SystemModel {word}: {len(self._model['recordings'])} recordings>"


class SystemCheck(Record):
    """The answer of a check: whether recorded outputs lie in the reachable set."""

    __slots__ = ()

    @property
    def conformant(self) -> bool:
        """Whether every output at every sample was proved to lie in the set."""
        return bool(self._content["conformant"])

    @property
    def outside(self) -> int:
        """The number of outputs that were not proved to lie in the set."""
        return int(self._content["outside"])

    @property
    def runs(self) -> list[dict[str, Any]]:
        """For each recording the part of the sets that it needs, with output and time."""
        return list(self._content["runs"])

    def __bool__(self) -> bool:
        return self.conformant

    def __repr__(self) -> str:
        word = "conformant" if self.conformant else "not conformant"
        return f"<SystemCheck {word}: {self.outside} of {self._content['values']} outputs outside>"


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


def _recorded(system: Mapping[str, Any], runs: Sequence[Any]) -> list[Any]:
    """Return recordings as the product takes them."""
    inputs, outputs, states = (
        [name_of(signal) for signal in system[key]] for key in ("inputs", "outputs", "states")
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
        times = columns.get("t")
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
