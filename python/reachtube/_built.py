"""From logs to a model, in one call."""

from __future__ import annotations

import json
import logging
import warnings
from collections.abc import Mapping, Sequence
from dataclasses import asdict, dataclass
from html import escape
from os import PathLike, fspath
from pathlib import Path
from typing import Any, Literal

import numpy.typing as npt

from . import _html, _reachtube
from ._arrays import above_zero, finite, json_of, mapping, names, real
from ._files import check_new, write_new
from ._findings import Finding
from ._logs import Logs, native_of_logs
from ._model import Model
from ._progress import Progress, shown
from ._record import Record
from ._robot import Robot, native_of
from ._settings import Group, Torque
from .errors import ReachtubeWarning, SettingError

log = logging.getLogger("reachtube")


@dataclass(frozen=True)
class JointRow:
    """The set of one joint's position at the horizon, beside the joint's motion."""

    name: str
    """The joint."""
    half_width: float | None
    """Half the width of the set, rad or m; ``None`` if the reachable set was lost."""
    displacement: float
    """How far the joint moves in a window, root mean square, and at least 5 % of its range, rad or
    m."""
    ratio: float | None
    """Half the width by the displacement: up to 0.5 the set is useful, above 1 it is too wide."""
    growth: float | None
    """The factor by which the set would have to grow where a motion that was held out leaves it
    furthest; ``None`` if none could be compared."""
    narrower: float | None
    """By which factor the set is narrower than without a model, both as wide as a motion needs them
    that was left out; ``None`` if none was compared."""


@dataclass(frozen=True)
class HeldOut:
    """The comparison with motions that were held out from every choice."""

    windows: int
    """Number of windows."""
    rows: int
    """Number of rows (window, sample, state)."""
    outside: int
    """Number of rows outside the reachable set."""
    motions: int | None
    """Number of motions; ``None`` if motions were held out in part only."""
    factor: float | None
    """Factor of the radii of X0 and U with which the sets enclose all of them, 1 if they do;
    ``None`` if no factor suffices."""
    failure: str | None
    """Why the motions could not be compared; ``None`` if they were."""


@dataclass(frozen=True)
class HorizonWidths:
    """The width of the sets at a horizon that was tried."""

    horizon: float
    """The horizon, s."""
    ratios: tuple[float, ...]
    """Half the width of each joint's set by its displacement; empty if no sets were found."""
    reason: str | None
    """Why no sets were found; ``None`` if they were."""
    with_fit: bool
    """Whether a fit was tried."""


@dataclass(frozen=True)
class Choice:
    """A choice that was made, and why."""

    key: str
    """The key in the file of choices."""
    value: str
    """The choice, in words."""
    reason: str
    """The reason."""


class BuiltModel(Record):
    """A model made of logs, the choices behind it, and its comparison with motions held out.

    ``print`` it for the answer in a few lines. ``bool`` is true if it is conformant and useful.
    """

    __slots__ = ()

    @property
    def _answer(self) -> dict[str, Any]:
        answer: dict[str, Any] = self._content["answer"]
        return answer

    @property
    def _files(self) -> dict[str, str]:
        return dict(self._content["files"])

    @property
    def model(self) -> Model:
        """The model, as `conform` returns it; `check` and `reach` prepare logs for it."""
        return Model(self._files["model.json"])

    @property
    def robot(self) -> Robot:
        """The robot: as described, or identified from the logs."""
        return Robot.from_toml(self._files["robot.toml"], "robot.toml")

    @property
    def useful(self) -> bool:
        """Whether the model is conformant, and its sets are narrow enough at the horizon."""
        return bool(self._answer["useful"])

    @property
    def conformant(self) -> bool:
        """Whether the sets were proved to enclose every window, at its samples."""
        return bool(self._answer["conformant"])

    @property
    def horizon(self) -> float:
        """Time up to which the model predicts, s."""
        return float(self._answer["horizon"])

    @property
    def joints(self) -> list[JointRow]:
        """The set of each joint at the horizon, beside its motion."""
        return [JointRow(**row) for row in self._answer["joints"]]

    @property
    def held_out(self) -> HeldOut:
        """The comparison with motions that were held out."""
        return HeldOut(**self._answer["held_out"])

    @property
    def horizons(self) -> list[HorizonWidths]:
        """The width of the sets at each horizon that was tried."""

        def widths(row: dict[str, Any]) -> HorizonWidths:
            ratios = (float("inf") if ratio is None else float(ratio) for ratio in row["ratios"])
            return HorizonWidths(row["horizon"], tuple(ratios), row["reason"], row["with_fit"])

        return [widths(row) for row in self._answer["horizons"]]

    @property
    def choices(self) -> list[Choice]:
        """The choices, in the order in which they were made."""
        return [Choice(**row) for row in self._answer["choices"]]

    @property
    def findings(self) -> list[Finding]:
        """The findings of the answer.

        What contradicts the logs or the robot comes first, then the verdict.
        """
        return [Finding._of(dict(finding)) for finding in self._answer["findings"]]

    def to_dict(self) -> dict[str, Any]:
        """Return everything as a new dictionary, with the keys of the command's JSON."""
        content: dict[str, Any] = json.loads(self._text)["answer"]
        for finding in content["findings"]:
            del finding["written"]
        return content

    def to_pandas(self) -> Any:
        """Return a pandas DataFrame with one row for each joint."""
        import pandas

        return pandas.DataFrame([asdict(row) for row in self.joints])

    def save(self, folder: str | PathLike[str], *, force: bool = False) -> None:
        """Write what ``reachtube model --out`` writes.

        The files are ``model.json``, ``robot.toml``, ``choices.toml``, ``page/report.html``, and
        ``held-out/report.html`` about the motions that were held out. A ``model.json`` that is
        replaced hands on the number of models that were compared with the same motions; the summary
        and the pages count this model alone.

        Parameters
        ----------
        folder
            Where the files are written; it is made if it does not exist.
        force
            Whether files that exist are replaced.
        """
        files = {Path(folder) / name: text for name, text in self._files.items()}
        for path in files:
            check_new(path, force=force)
        model = Path(folder) / "model.json"
        files[model] = _reachtube.among_others(files[model], fspath(model))
        for path, text in files.items():
            write_new(path, text, force=force)

    def __bool__(self) -> bool:
        return self.useful

    def __str__(self) -> str:
        return str(self._content["summary"])

    def __repr__(self) -> str:
        return f"<BuiltModel {self._content['verdict']}>"

    def _repr_html_(self) -> str:
        text = _html.verdict(self.useful, self._content["verdict"])
        said = [str(finding) for finding in self.findings if finding.severity != "info"]
        text += "".join(f"<p>{escape(sentence)}</p>" for sentence in said)

        def number(value: float | None, form: str) -> str:
            return "-" if value is None else format(value, form)

        rows = [
            [
                escape(row.name),
                number(row.half_width, ".3g"),
                number(row.ratio, ".0%"),
                number(row.growth, ".3g"),
            ]
            for row in self.joints
        ]
        header = ["joint", "half the set [rad or m]", "of its motion", "factor, held out"]
        return text + _html.table(header, rows)


def model(
    robot: Robot,
    data: Logs | None = None,
    torque: Torque | None = None,
    *,
    settings: str | PathLike[str] | None = None,
    horizon: float | None = None,
    held_out: str | Sequence[str] | None = None,
    gains: npt.ArrayLike | None = None,
    fit: Sequence[Group] | None = None,
    pull: float | None = None,
    columns: Mapping[str, str | int] | None = None,
    topic: str | Sequence[str] | None = None,
    joints: Sequence[str] | None = None,
    marker: str | None = None,
    time: Literal["header", "log"] | None = None,
    progress: Progress = None,
) -> BuiltModel:
    """Make a model of a robot from logs as they are: sets, horizon, verdict and page.

    Every choice that is not given is made from the logs, with its reason, as ``reachtube model``
    does: the recordings are sorted, some motions are held out, the robot is identified if its
    description does not explain the torques, and the horizon is the longest time at which no
    joint's set is wider than its motion.

    Parameters
    ----------
    robot
        The robot that was recorded.
    data
        Logs: paths of CSV files, MCAP, rosbag2 or folders of them, runs, or a data set. The logs of
        ``settings`` if it is not given.
    torque
        What the recorded torques are: ``"motor"``, ``"link"`` or ``"compensated"``, as for
        `conform`. It is never guessed; ``settings`` may name it.
    settings
        A file of choices, as `BuiltModel.save` writes it (``choices.toml``). The same choices give
        the same model.
    horizon
        Time up to which the model predicts, above 0 s.
    held_out
        Motions that are held out from every choice; by default every fourth.
    gains
        Factors of the recorded torques, n; for motor currents in N m/A. They also state that the
        torques are right where they contradict the robot's description.
    fit
        Groups of parameters of the nominal model that are fitted for small sets, as for `conform`;
        takes minutes. By default as in ``settings``, or none.
    pull
        The weight of the pull of a fit, as for `conform`.
    columns
        Columns of CSV files with ambiguous names, as ``{"q": "pos_{}", "first": 0}``; the keys
        are ``q``, ``qd``, ``tau``, ``current``, ``time``, ``rate`` (Hz, for logs without a time),
        ``first``, ``time_unit`` and ``angle``.
    topic
        Topics with joint states in MCAP and rosbag2; by default the only one that names joints of
        the robot.
    joints
        Names of the joints in MCAP and rosbag2, in the robot's order; by default the robot's names.
    marker
        Topic in MCAP and rosbag2 that marks runs; by default each log is one recording.
    time
        The stamps in the messages' headers, or the times at which the log received them.
    progress
        As for `conform`; a function gets each choice as a sentence.

    Returns
    -------
    BuiltModel
        A model that is not conformant, or too wide to be of use, is returned, not raised.
        Warnings also produce a `ReachtubeWarning`.

    Raises
    ------
    DefectsError
        Recordings with defects, all of them.
    SettingError
        An argument that is not possible, or a motion to hold out that does not exist.
    ReachtubeError
        Logs of which no model can be made, with the reason.

    Examples
    --------
    >>> import reachtube as rt
    >>> robot = rt.Robot.load("arm.urdf")  # doctest: +SKIP
    >>> built = rt.model(robot, "logs", torque="motor")  # doctest: +SKIP
    >>> print(built)  # doctest: +SKIP
    >>> built.save("arm")  # doctest: +SKIP
    """
    given = _numbers(horizon=horizon, pull=pull, gains=gains)
    if torque is not None:
        given["torque"] = torque
    if held_out is not None:
        given["held-out"] = names(held_out)
    if fit is not None:
        given["fit"] = names(fit)
    if columns is not None:
        given["columns"] = mapping("columns", columns)
    log_table = {"topic": names(topic), "joints": names(joints), "marker": marker, "time": time}
    if any(log_table.values()):
        given["log"] = {key: value for key, value in log_table.items() if value}
    given |= robot._source if isinstance(robot, Robot) else {}
    paths, runs = ([], None) if data is None else native_of_logs(data)
    if not isinstance(settings, (str, PathLike, type(None))):
        kind = type(settings).__name__
        raise SettingError(f"settings is of type {kind}; give the path of a file of choices")
    file = None if settings is None else fspath(settings)
    with shown(progress, "model") as tell:
        text, notes = _reachtube.model(
            native_of(robot), paths, runs, file, json_of("choices", given), tell
        )
    found = BuiltModel(text)
    for note in [*notes, *(f"{own.key}: {own.value} ({own.reason})" for own in found.choices)]:
        log.info(note)
    for finding in found.findings:
        if finding.severity != "info":
            warnings.warn(str(finding), ReachtubeWarning, 2)
    return found


def _numbers(
    *,
    horizon: float | None,
    pull: float | None,
    gains: npt.ArrayLike | None,
) -> dict[str, Any]:
    """Return the numbers that are given, by the keys of a file of choices."""
    given: dict[str, Any] = {}
    if horizon is not None:
        given["horizon"] = above_zero("horizon", horizon)
    if pull is not None:
        if not 0 <= real("pull", pull) <= 1:
            raise SettingError(f"pull is {pull}; give a weight from 0 to 1")
        given["pull"] = real("pull", pull)
    if gains is not None:
        given["gains"] = finite("gains", gains)
    return given
