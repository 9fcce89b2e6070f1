"""The smallest sets, and their check on other recordings."""

from __future__ import annotations

import json
import logging
import warnings
from collections.abc import Iterable, Sequence
from os import PathLike, fspath
from pathlib import Path
from typing import Any, Literal, TypeAlias

import numpy.typing as npt

from . import _html, _reachtube
from ._abstraction import Abstraction
from ._arrays import Array, array_of, names, numbers
from ._box import Box
from ._files import write_new
from ._progress import Progress, shown
from ._record import Record
from ._recordings import Recordings, Run, source
from ._robot import Robot
from .errors import ModelFileError, ReachtubeError, ReachtubeWarning, SettingError

log = logging.getLogger("reachtube")

Torque: TypeAlias = Literal["compensated", "motor", "link"]
Notion: TypeAlias = Literal["hull", "phase-plane", "exact", "trace"]
Group: TypeAlias = Literal["inertia", "viscous", "cubic", "coulomb", "warm-up", "payload"]
Data: TypeAlias = "Recordings | Run | Iterable[Run]"


class Model(Record):
    """A model of a robot's motion with uncertainty sets X0, U and V.

    It is reachset conformant with the recordings it was made of where `verified` is true: each lies
    in the reachable set, at its samples, which was proved with directed rounding.

    States are ordered q then q̇; units are SI units.
    """

    __slots__ = ()

    @classmethod
    def load(cls, path: str | PathLike[str]) -> Model:
        """Read a model file, as ``reachtube conform --out`` or `save` wrote it.

        Raises
        ------
        ModelFileError
            For another file, one of another version, or one that was changed.
        """
        try:
            text = Path(path).read_text(encoding="utf-8")
        except (OSError, UnicodeDecodeError) as error:
            raise ReachtubeError(f"{path}: {error}; give a file that `conform` wrote") from None
        _reachtube.check_model(text, fspath(path))
        return cls(text)

    def save(self, path: str | PathLike[str], *, force: bool = False) -> None:
        """Write the model file. A file that exists is replaced with ``force=True`` only."""
        write_new(Path(path), self._text, force=force)

    def to_bytes(self) -> bytes:
        """Return the model file, whose format has a version."""
        return self._text.encode()

    @classmethod
    def from_bytes(cls, data: bytes) -> Model:
        """Return the model of a model file's bytes."""
        try:
            text = data.decode()
        except UnicodeDecodeError as error:
            raise ModelFileError(f"these bytes are no model file: {error}") from None
        _reachtube.check_model(text, "bytes")
        return cls(text)

    @property
    def verified(self) -> bool:
        """Whether the sets were proved to enclose the recordings, at samples."""
        return bool(self._content["verified"])

    @property
    def cost(self) -> float | None:
        """Sum of the reachable set's widths over states and sample times; ``None`` where a set
        was lost."""
        return self._number("cost")

    @property
    def cost_lower_bound(self) -> float | None:
        """No sets of a linear model cost less, to the solver's tolerance."""
        return self._number("cost_lower_bound")

    @property
    def optimality_gap(self) -> float | None:
        """How far the cost may be above the least, relative to the lower bound."""
        return self._number("optimality_gap")

    @property
    def initial_set(self) -> Box:
        """X0 around the nominal initial state, 2n, rad and rad/s."""
        return Box._of(self._content["initial_set"])

    @property
    def input_set(self) -> Box:
        """U around the nominal input, n, N m."""
        return Box._of(self._content["input_set"])

    @property
    def noise_set(self) -> Box | None:
        """V, the measurement noise, 2n, where it was asked for."""
        record = self._content.get("noise_set")
        return None if record is None else Box._of(record)

    @property
    def warnings(self) -> list[str]:
        """What can hardly be right about the answer, and the most likely cause."""
        return [str(warning["text"]) for warning in self._content.get("warnings", [])]

    @property
    def violation_probability(self) -> float:
        """Upper bound of the probability that the next motion leaves the set; see `trust`."""
        return float(self._content["trust"]["violation_probability"])

    @property
    def trust(self) -> dict[str, Any]:
        """The bound for the next motion, its confidence, and its assumptions (``basis``)."""
        return dict(self._content["trust"])

    @property
    def proof(self) -> dict[str, Any]:
        """What was proved, with the worst witness where it was not."""
        return dict(self._content["proof"])

    @property
    def settings(self) -> dict[str, Any]:
        """The settings."""
        return dict(self._content["settings"])

    @property
    def robot(self) -> Robot:
        """The robot."""
        return Robot.from_dict(self._content["robot"])

    @property
    def a(self) -> Array | None:
        """A of ẋ = A x + B u + d, 2n x 2n; ``None`` for a model that is not linear."""
        return array_of(self._content["a"]) if "a" in self._content else None

    @property
    def b(self) -> Array | None:
        """B, 2n x n; ``None`` for a model that is not linear."""
        return array_of(self._content["b"]) if "b" in self._content else None

    @property
    def joints(self) -> int:
        """The number of joints n."""
        return len(self._content["input_set"]["centre"])

    def _number(self, name: str) -> float | None:
        value = self._content.get(name)
        return None if value is None else float(value)

    def to_pandas(self) -> Any:
        """Return the sets as a pandas DataFrame: one row for each entry of X0, U and V."""
        import pandas

        rows = [
            {"set": name, "entry": entry, "unit": unit, "centre": centre, "radius": radius}
            for name, entry, unit, centre, radius in _html.rows_of_sets(self)
        ]
        return pandas.DataFrame(rows)

    def __repr__(self) -> str:
        words = "conformant" if self.verified else "NOT PROVED CONFORMANT"
        cost = "lost" if self.cost is None else f"{self.cost:.6g}"
        proof = self._content["proof"]
        return f"<Model {words}: cost {cost}, {proof['runs']} recordings, {proof['rows']} rows>"

    def _repr_html_(self) -> str:
        return _html.model(self)


class Check(Record):
    """The answer of a check: whether recordings lie in a model's reachable set, and where not."""

    __slots__ = ()

    @property
    def conformant(self) -> bool:
        """Whether every recording was proved to lie in the set, at its samples."""
        return bool(self._content["conformant"])

    @property
    def violations(self) -> int:
        """Number of rows (suite, sample, state) outside."""
        return int(self._content["violations"]["count"])

    @property
    def rows(self) -> int:
        """Number of rows."""
        return int(self._content["rows"])

    @property
    def worst(self) -> dict[str, Any] | None:
        """The value furthest outside: suite, run, time, joint, state, side and excess."""
        worst = self._content["violations"]["worst"]
        return None if worst is None else dict(worst)

    @property
    def suites(self) -> list[dict[str, Any]]:
        """The same for each suite."""
        return list(self._content["suites"])

    @property
    def trust(self) -> dict[str, Any] | None:
        """What the check says of the next motion; ``None`` where a recording was in the fit."""
        trust = self._content.get("trust")
        return None if trust is None else dict(trust)

    @property
    def notes(self) -> list[str]:
        """What a user should know about the recordings."""
        return [str(note) for note in self._content["notes"]]

    def to_pandas(self) -> Any:
        """Return one row for each suite."""
        import pandas

        rows = [
            {
                "suite": suite["suite"],
                "runs": suite["runs"],
                "rows": suite["rows"],
                "outside": suite["violations"]["count"],
                **{
                    key: (suite["violations"]["worst"] or {}).get(key)
                    for key in ("run", "time", "state", "excess")
                },
            }
            for suite in self._content["suites"]
        ]
        return pandas.DataFrame(rows)

    def __bool__(self) -> bool:
        return self.conformant

    def __repr__(self) -> str:
        words = "conformant" if self.conformant else "not conformant"
        return f"<Check {words}: {self.violations} of {self.rows} rows outside>"

    def _repr_html_(self) -> str:
        return _html.check(self)


def _radii(name: str, values: npt.ArrayLike, joints: int) -> list[float]:
    """Return 2n numbers; two stand for all positions and all velocities."""
    given = numbers(name, values).ravel()
    if given.size == 2:
        return [float(given[0])] * joints + [float(given[1])] * joints
    if given.size != 2 * joints:
        raise SettingError(f"{name} has {given.size} numbers; give 2 or {2 * joints}")
    return [float(value) for value in given]


def conform(
    robot: Robot | Abstraction,
    data: Data,
    *,
    torque: Torque,
    suites: str | Sequence[str] | None = None,
    model: Literal[1, 2, 3] = 1,
    order: int = 1,
    expansion: npt.ArrayLike | None = None,
    fit: Sequence[Group] = (),
    pull: float | None = None,
    disturbance: Literal["sample", "constant", "measurable"] = "sample",
    centre: Literal["free", "origin", "zero"] = "free",
    notion: Notion = "hull",
    states: Literal["all", "positions"] = "all",
    initial_limit: Literal["none", "positions", "states"] = "none",
    weights: Literal["unit", "spread"] | npt.ArrayLike = "unit",
    noise: Literal["none", "fitted"] | npt.ArrayLike = "none",
    sensor_noise: npt.ArrayLike | None = None,
    nominal: Literal["mean", "own"] = "mean",
    calibrate: Sequence[str] = (),
    method: Literal["program", "bisection"] = "program",
    explain: Literal["default"] | tuple[float, float] | None = "default",
    until: float | None = None,
    max_gap: float | None = None,
    resume: str | PathLike[str] | None = None,
    progress: Progress = None,
) -> Model:
    """Find the smallest uncertainty sets for which a model encloses every recording.

    Parameters
    ----------
    robot
        A robot, or an abstraction of one made by `abstract`.
    data
        The recordings.
    torque
        What the recorded torques are: ``"compensated"`` (the model's input: gravity and Coulomb
        friction are already subtracted), ``"motor"`` (motor torque at the output side of the
        gear) or ``"link"`` (link-side torque of a joint torque sensor). It is never guessed.
    suites
        Names of the suites to use; all where none are given.
    model, order, expansion
        Model 1, 2 or 3 of the paper, the order of its Taylor polynomials, and where it is
        expanded: n positions, or also n velocities. Not for an abstraction, which has its own.
    fit, pull
        Groups of parameters of the nominal model that are chosen for the smallest sets, and the
        weight of the pull toward the identified values, from 0 to 1; chosen by leaving one motion
        out where it is not given.
    disturbance
        How the disturbance may change: from sample to sample, not at all, or at any time.
    centre
        Centres of X0 and U: anywhere, where the set contains the origin, or at the origin.
    notion
        Directions in which recordings must lie in the reachable set.
    states
        States that must be enclosed.
    initial_limit
        How far X0 may reach: positions or states no further than the recorded starts.
    weights
        Weights of the states in the cost: 1, the reciprocal of the spread, or 2 or 2n numbers.
    noise, sensor_noise
        Measurement noise V, or its radii, 2 or 2n numbers; and those of the sensors, which limit
        it, estimated from the recordings where they are not given.
    nominal
        Where nominal motions start: at the mean of a suite's first states, or at each run's own.
    calibrate
        Motions that are kept back from the fit, to which the sets are then scaled.
    method
        Programs, or the paper's bisection.
    explain
        Tolerances, rad and rad/s, within which a motion of the model itself is searched for near
        each recording. The default is not to, but for models that are not linear.
    until
        Samples later than this many seconds after the first are not used.
    max_gap
        Longest time between two samples, s.
    resume
        A file that keeps the progress of a long search, and from which it goes on.
    progress
        ``True`` for a bar; a function is called with what is done, all, and sentences.

    Returns
    -------
    Model
        With ``verified`` false where it could not be proved: that is no error. What can hardly
        be right is also warned of, as `ReachtubeWarning`.

    Raises
    ------
    DefectsError
        Recordings with defects, all of them.
    SettingError
        An argument that is not possible.
    KeyboardInterrupt
        Within 0.2 s, with nothing written.
    """
    joints = robot.joints
    settings: dict[str, Any] = {
        "torque": torque,
        "disturbance": disturbance,
        "centre": centre,
        "notion": notion,
        "states": states,
        "initial_limit": initial_limit,
        "nominal": nominal,
        "calibrate": names(calibrate),
        "method": method,
    }
    is_own = (model, order, expansion) == (1, 1, None)
    if isinstance(robot, Abstraction):
        if not is_own:
            raise SettingError("model, order and expansion are those of the abstraction")
    else:
        settings["abstraction"] = {"model": model, "order": order}
        if expansion is not None:
            settings["expansion"] = numbers("expansion", expansion).ravel().tolist()
    if isinstance(weights, str):
        settings["weights"] = weights
    else:
        settings["weights"] = {"given": _radii("weights", weights, joints)}
    if isinstance(noise, str):
        settings["noise"] = noise
    else:
        settings["noise"] = {"fixed": _radii("noise", noise, joints)}
    if sensor_noise is not None:
        settings["sensor_noise"] = _radii("sensor_noise", sensor_noise, joints)
    if explain is None:
        settings["explain"] = None
    elif explain != "default":
        settings["explain"] = {"position": explain[0], "velocity": explain[1]}
    settings.update(_limits(until, max_gap))
    with shown(progress, "conform") as tell:
        text, notes = _reachtube.conform(
            robot._native if isinstance(robot, Robot) else None,
            robot._native if isinstance(robot, Abstraction) else None,
            source(data),
            names(suites),
            json.dumps(settings),
            names(fit),
            pull,
            None if resume is None else fspath(resume),
            tell,
        )
    for note in notes:
        log.info(note)
    found = Model(text)
    if not found.verified:
        warnings.warn("the sets are NOT PROVED to enclose the recordings", ReachtubeWarning, 2)
    for warning in found.warnings:
        warnings.warn(warning, ReachtubeWarning, 2)
    return found


def _limits(until: float | None, max_gap: float | None) -> dict[str, float]:
    """Return the limits of time that are given."""
    limits = {"until": until, "max_gap": max_gap}
    for name, value in limits.items():
        if value is not None and not 0 < value < float("inf"):
            raise SettingError(f"{name} is {value} s; it must be above 0")
    return {name: value for name, value in limits.items() if value is not None}


def differing(
    notion: Notion | None, until: float | None, max_gap: float | None
) -> str:
    """Return the settings that differ from a model's, for the native part."""
    settings: dict[str, Any] = dict(_limits(until, max_gap))
    if notion is not None:
        settings["notion"] = notion
    return json.dumps(settings)


def check(
    model: Model,
    data: Data,
    *,
    suites: str | Sequence[str] | None = None,
    notion: Notion | None = None,
    until: float | None = None,
    max_gap: float | None = None,
    progress: Progress = None,
) -> Check:
    """Check whether a model encloses other recordings, whose torques are of the model's kind.

    Parameters
    ----------
    model, data
        The model, and the recordings.
    suites, until, max_gap, progress
        As for `conform`; ``until`` is that of the model where it is not given.
    notion
        Directions in which recordings must lie in the set; the model's own where not given.

    Returns
    -------
    Check
        Not conformant is a value, with witnesses.
    """
    with shown(progress, "check") as tell:
        return Check(
            _reachtube.check(
                model._text, source(data), names(suites), differing(notion, until, max_gap), tell
            )
        )
