"""Whether the links of a robot stay clear of obstacles."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import asdict, dataclass
from os import PathLike
from pathlib import Path
from typing import Any, Literal

from . import _html, _reachtube
from ._answer import Answer, Toml, infinite, toml_of
from ._model import Model, source_for, text_of
from ._progress import Progress, shown
from .errors import SettingError


@dataclass(frozen=True)
class Clearance:
    """The smallest proved distance of a link from an obstacle over a motion."""

    link: str
    """The joint that moves the link."""
    obstacle: str
    """The obstacle."""
    distance: float
    """A lower bound over all motions of the model, m; negative if none above 0 is proved."""
    time: float
    """Start of the step in which it is the smallest, s."""


@dataclass(frozen=True)
class Margin:
    """How far a link can be from where it is on the nominal motion."""

    link: str
    """The joint that moves the link."""
    margin: float
    """An upper bound over all motions of the model, m; infinite without one."""
    time: float
    """Start of the step in which it is the largest, s."""


@dataclass(frozen=True)
class WitnessStop:
    """The stop that ends a simulated motion."""

    from_time: float
    """The time at which it begins, s."""
    brake: tuple[float, ...]
    """The torque of each brake, N m."""
    delay: float
    """The time from which the brakes hold, after the drives are off, s."""
    error: tuple[float, ...]
    """What is added to the torque of each joint, N m."""

    @classmethod
    def _of(cls, row: dict[str, Any]) -> WitnessStop:
        brake, error = tuple(row["brake"]), tuple(row["error"])
        return cls(float(row["from"]), brake, float(row["delay"]), error)


@dataclass(frozen=True)
class Witness:
    """The simulated motion that comes closest to an obstacle."""

    link: str
    """The joint that moves the link."""
    obstacle: str
    """The obstacle."""
    distance: float
    """Their distance in floating point, m; negative if they overlap."""
    time: float
    """Time of that sample, s."""
    start: tuple[float, ...]
    """The initial state, 2n, rad and rad/s."""
    stop: WitnessStop | None
    """The stop that ends it; ``None`` if it goes on."""

    @classmethod
    def _of(cls, row: dict[str, Any]) -> Witness:
        stop = row["stop"]
        stop = None if stop is None else WitnessStop._of(stop)
        return cls(**{**row, "start": tuple(row["start"]), "stop": stop})


@dataclass(frozen=True)
class StopTrigger:
    """How far a walking person must be from a link when a stop of the motion is triggered."""

    link: str
    """The joint that moves the link."""
    distance: float
    """The distance, m; infinite if a standstill is not proved."""
    way: float
    """The way of the link until standstill, m."""
    time: float
    """The time from the sample before the stop until standstill, s."""
    stop_at: float
    """The time of the sample at which that stop begins, s."""


@dataclass(frozen=True)
class MotionVerdict:
    """The verdict about a motion."""

    case: str
    """The suite, and the run if it has its own nominal motion."""
    answer: Literal["safe", "undecided", "unsafe"]
    """The answer."""
    clearances: tuple[Clearance, ...]
    """The smallest proved distance of each link from each obstacle, smallest first."""
    margins: tuple[Margin, ...]
    """The margin of each link."""
    closest: Witness | None
    """The simulated motion that comes closest; ``None`` if the answer is safe."""
    stops: tuple[StopTrigger, ...] | None
    """The trigger distance of each link; ``None`` if the scenario has no ``[stop]``."""

    @classmethod
    def _of(cls, row: dict[str, Any]) -> MotionVerdict:
        def clearance(pair: dict[str, Any]) -> Clearance:
            # Without a bound nothing is proved.
            distance = -infinite(None) if pair["distance"] is None else float(pair["distance"])
            return Clearance(**{**pair, "distance": distance})

        def trigger(one: dict[str, Any]) -> StopTrigger:
            distance, way, time = (infinite(one[key]) for key in ("distance", "way", "time"))
            return StopTrigger(one["link"], distance, way, time, float(one["from"]))

        found, stops = row["closest"], row["stops"]
        return cls(
            row["case"],
            row["answer"],
            tuple(clearance(pair) for pair in row["clearances"]),
            tuple(Margin(**{**one, "margin": infinite(one["margin"])}) for one in row["margins"]),
            None if found is None else Witness._of(found),
            None if stops is None else tuple(trigger(one) for one in stops["trigger"]),
        )


class Verification(Answer):
    """Whether the links of a robot stay clear of obstacles on every motion of a model.

    ``print`` it for the answer in a few tables. ``bool`` is true if it is safe.
    """

    __slots__ = ()

    @property
    def answer(self) -> Literal["safe", "undecided", "unsafe"]:
        """The worst answer of all motions."""
        answer: Literal["safe", "undecided", "unsafe"] = self._answer["answer"]
        return answer

    @property
    def motions(self) -> list[MotionVerdict]:
        """The verdict about each motion."""
        return [MotionVerdict._of(row) for row in self._answer["motions"]]

    @property
    def pictures(self) -> dict[str, str]:
        """The arm, what its links sweep, and the obstacles: SVG by file name, one per motion."""
        return {name: text for name, text in self._files.items() if name.endswith(".svg")}

    def to_pandas(self) -> Any:
        """Return a pandas DataFrame with one row for each motion, link and obstacle."""
        import pandas

        rows = [
            {"case": motion.case, "answer": motion.answer, **asdict(pair)}
            for motion in self.motions
            for pair in motion.clearances
        ]
        return pandas.DataFrame(rows)

    def save(self, folder: str | PathLike[str], *, force: bool = False) -> None:
        """Write the files that ``reachtube verify --out`` writes.

        Parameters
        ----------
        folder
            Where the files are written; it is made if it does not exist.
        force
            Whether files that exist are replaced.
        """
        self._save(folder, force)

    def __bool__(self) -> bool:
        return self.answer == "safe"

    def _repr_html_(self) -> str:
        text = _html.verdict(bool(self), self.findings[0].text) + _html.lines(self.findings[1:])
        place = self.findings[0].place
        order = [motion.case for motion in self.motions]
        pictures = list(self.pictures.values())
        if place in order and order.index(place) < len(pictures):
            text += pictures[order.index(place)]
        return text


def verify(scenario: Toml, *, progress: Progress = None) -> Verification:
    """Decide whether the links of a robot stay clear of obstacles on every motion of a model.

    Parameters
    ----------
    scenario
        The path of a TOML file, or its keys: ``model`` with a model or its path, ``data`` with
        recordings as for `check`, and ``obstacle`` with a list of obstacles. For the file of a
        `TrackingModel`, ``plan`` and ``robot`` with their paths replace ``data``. The guide "From
        sets to safety" describes all keys. Paths are relative to the file's folder, or to the
        current one if keys are given.
    progress
        As for `conform`.

    Returns
    -------
    Verification
        An arm that is not safe is returned, not raised.

    Raises
    ------
    SettingError
        A scenario that is not possible.

    Examples
    --------
    >>> table = {"name": "table", "half-space": {"normal": [0, 0, 1], "offset": -0.3}}
    >>> answer = reachtube.verify(  # doctest: +SKIP
    ...     {"model": model, "data": "recordings", "obstacle": [table]}
    ... )
    >>> print(answer)  # doctest: +SKIP
    """
    in_memory = None
    if isinstance(scenario, Mapping) and "data" not in scenario:
        if isinstance(scenario.get("model"), Model):
            raise SettingError("scenario has a model and no data; give the recordings as data")
    if isinstance(scenario, Mapping) and {"model", "data"} <= scenario.keys():
        model, data = scenario["model"], scenario["data"]
        model = model if isinstance(model, Model) else Model.load(model)
        in_memory = (text_of(model), source_for(model, data))
        scenario = {**scenario, "model": "model", "data": "recordings"}
    text, origin = toml_of("scenario", scenario)
    folder = str(Path.cwd() if origin is None else Path(origin).absolute().parent)
    with shown(progress, "verify") as tell:
        return Verification(_reachtube.verify(text, origin, folder, in_memory, tell))
