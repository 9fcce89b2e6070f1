"""How far and how long a robot moves after a stop."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import asdict, dataclass
from os import PathLike
from typing import TYPE_CHECKING, Any, Literal

from . import _html, _reachtube
from ._answer import Answer, Toml, infinite, toml_of
from ._arrays import names, whole
from ._model import source_for, text_of
from ._progress import Progress, shown
from ._recordings import source
from ._settings import differing
from .errors import SettingError

if TYPE_CHECKING:
    from ._logs import Logs
    from ._model import Model
    from ._settings import Data


@dataclass(frozen=True)
class WorstStop:
    """The stops of a joint from the samples of a suite."""

    suite: str
    """The suite."""
    joint: str
    """The joint."""
    way: float
    """The greatest proved way to standstill, rad or m; infinite if none is proved."""
    way_from: float
    """The time of the sample from which it is the greatest, s."""
    time: float
    """The latest proved standstill after a stop, s; infinite if none is proved."""
    time_from: float
    """The time of the sample from which it is the latest, s."""
    proved: int
    """Number of samples from which a standstill is proved."""
    samples: int
    """Number of samples from which a stop was followed."""
    skipped: int
    """Number of samples whose deceleration would lead beyond the end of the motion."""


@dataclass(frozen=True)
class AnnexRow:
    """A row of the table of ISO 10218-1, Annex B: one joint moves when the stop begins."""

    category: int
    """The stop category, 0 or 1."""
    joint: str
    """The joint that moves."""
    speed: float
    """Part of the greatest speed."""
    extension: float
    """Part of the greatest distance of the load from the joint's axis."""
    load: float
    """Part of the greatest load."""
    velocity: float
    """The speed when the stop begins, rad/s or m/s."""
    posture: tuple[float, ...]
    """The posture when the stop begins, n, rad or m."""
    way: float
    """The greatest proved way of the joint, rad or m; infinite if none is proved."""
    time: float
    """The latest proved time at which all joints stand, s; infinite if none is proved."""


@dataclass(frozen=True)
class RecordedStop:
    """A joint in a recorded stop, and the stop that is proved from the first recorded state."""

    recording: str
    """The recording."""
    joint: str
    """The joint."""
    velocity: float
    """Its velocity when the stop begins, rad/s or m/s."""
    way: float
    """The measured way, rad or m, with its sign."""
    time: float | None
    """The measured time of standstill, s; ``None`` if the joint moves until the end."""
    proved_way: tuple[float, float]
    """The least and the greatest proved way; infinite if none is proved."""
    proved_time: float
    """The latest proved time of standstill, s; infinite if none is proved."""
    is_within: bool
    """Whether the measured way lies within the proved ones, and the time is not later."""


class StopStudy(Answer):
    """How far and how long the joints of a robot move after a stop.

    ``print`` it for the answer in a few tables. ``bool`` is true if every stop is proved, and every
    recorded stop lies within the proved one.
    """

    __slots__ = ()

    @property
    def category(self) -> int:
        """The stop category along the motions and of the recorded stops, 0 or 1."""
        return int(self._answer["category"])

    @property
    def stops(self) -> list[WorstStop]:
        """The worst stop of each suite and joint."""
        bounds = ("way", "time")
        return [
            WorstStop(**{**row, **{name: infinite(row[name]) for name in bounds}})
            for row in self._answer["stops"]
        ]

    @property
    def annex_b(self) -> list[AnnexRow]:
        """The table of ISO 10218-1, Annex B; empty unless requested."""
        rows = (self._answer["annex_b"] or {"rows": []})["rows"]
        return [
            AnnexRow(
                **{
                    **row,
                    "posture": tuple(row["posture"]),
                    "way": infinite(row["way"]),
                    "time": infinite(row["time"]),
                }
            )
            for row in rows
        ]

    @property
    def recorded(self) -> list[RecordedStop]:
        """Recorded stops beside the proved ones."""

        def stop(row: dict[str, Any]) -> RecordedStop:
            low, high = row["proved_way"]
            way = (-infinite(None) if low is None else float(low), infinite(high))
            proved_time = infinite(row["proved_time"])
            return RecordedStop(**{**row, "proved_way": way, "proved_time": proved_time})

        return [stop(row) for row in self._answer["recorded"]]

    def to_pandas(self) -> Any:
        """Return a pandas DataFrame with one row for each suite and joint."""
        import pandas

        return pandas.DataFrame([asdict(row) for row in self.stops])

    def save(self, folder: str | PathLike[str], *, force: bool = False) -> None:
        """Write the page ``stop.html`` with the table of ISO 10218-1, Annex B.

        Parameters
        ----------
        folder
            Where the page is written; it is made if it does not exist.
        force
            Whether a page that exists is replaced.

        Raises
        ------
        SettingError
            For an answer without the table.
        """
        if not self._files:
            raise SettingError("there is no page without the table; give table=True to stop")
        self._save(folder, force)

    def __bool__(self) -> bool:
        return self.findings[0].code == "stands"

    def _repr_html_(self) -> str:
        text = _html.verdict(bool(self), self.findings[0].text)
        text += _html.lines(self.findings[1:])
        rows = [
            [row.suite, row.joint, f"{row.way:.4g}", f"{row.time:.3f}"] for row in self.stops
        ]
        header = ["suite", "joint", "greatest way [rad or m]", "latest standstill [s]"]
        return text + _html.table(header, rows)


def stop(
    model: Model,
    data: Data | Logs,
    brakes: Toml,
    *,
    category: Literal[0, 1] = 0,
    every: int = 1,
    table: bool = False,
    recorded: Data | None = None,
    suites: str | Sequence[str] | None = None,
    until: float | None = None,
    max_gap: float | None = None,
    progress: Progress = None,
) -> StopStudy:
    """Enclose how far and how long a robot moves after a stop, from every recorded sample.

    Parameters
    ----------
    model
        The model; its U is the error of the drives' torque in a stop of category 1.
    data
        The recordings, as for `check`.
    brakes
        The path of a TOML file with the brakes, or its keys: ``torque`` with the least and the
        greatest torque of each brake, n pairs in N m, and ``delay`` with the earliest and the
        latest time at which the brakes hold, s. ``error``, ``deceleration`` and ``payload`` are
        optional.
    category
        0 for drives off and brakes on, 1 for a controlled deceleration before.
    every
        A stop begins at every sample of this number.
    table
        Whether the table of ISO 10218-1, Annex B, and its page are made.
    recorded
        Recorded stops, each of which begins with its stop.
    suites
        Names of the suites to use; all if none are given.
    until
        Samples later than this many seconds after the first are not used.
    max_gap
        Longest time between two samples, s.
    progress
        As for `conform`.

    Returns
    -------
    StopStudy
        Stops that are not proved are returned, not raised.

    Raises
    ------
    SettingError
        Brakes that are not possible, or without ``deceleration`` for category 1.

    Examples
    --------
    >>> brakes = {"torque": [[45, 60]] * 6, "delay": [0.01, 0.03]}
    >>> study = reachtube.stop(model, "recordings", brakes)  # doctest: +SKIP
    >>> print(study)  # doctest: +SKIP
    """
    if category not in (0, 1):
        raise SettingError(f"category is {category!r}; give 0 or 1")
    count = whole("every", every, 1)
    text, origin = toml_of("brakes", brakes)
    with shown(progress, "stop") as tell:
        return StopStudy(
            _reachtube.stop(
                text_of(model),
                source_for(model, data, max_gap),
                names(suites),
                differing(None, until, max_gap),
                text,
                origin,
                (int(category), count, bool(table)),
                None if recorded is None else source(recorded),
                tell,
            )
        )
