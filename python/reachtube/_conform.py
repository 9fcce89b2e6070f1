"""The smallest sets, and their check on other recordings."""

from __future__ import annotations

import logging
import warnings
from collections.abc import Sequence
from os import PathLike, fspath
from typing import Literal

import numpy.typing as npt

from . import _reachtube
from ._abstraction import Abstraction
from ._arrays import above_zero, names, real
from ._check import Check
from ._logs import Logs, native_of_logs
from ._model import Model, text_of
from ._progress import Progress, shown
from ._recordings import source
from ._robot import Robot
from ._settings import Data, Group, Notion, Torque, among, of_conformance, refuse_gap_of_logs
from .errors import ReachtubeWarning, SettingError

log = logging.getLogger("reachtube")


def conform(
    robot: Robot | Abstraction,
    data: Data | Logs,
    *,
    torque: Torque,
    suites: str | Sequence[str] | None = None,
    paper_model: Literal[1, 2, 3] = 1,
    order: int = 1,
    expansion: npt.ArrayLike | None = None,
    fit: Sequence[Group] = (),
    pull: float | None = None,
    disturbance: Literal["sample", "constant", "measurable"] = "sample",
    centre: Literal["free", "origin", "zero"] = "free",
    notion: Notion = "hull",
    states: Literal["all", "positions"] = "all",
    initial_limit: Literal["none", "positions", "states"] = "none",
    stiction: bool = False,
    weights: Literal["unit"] | npt.ArrayLike = "unit",
    noise: Literal["none", "fitted"] | npt.ArrayLike = "none",
    sensor_noise: npt.ArrayLike | None = None,
    input_doubling: npt.ArrayLike | None = None,
    nominal: Literal["mean", "own", "past"] = "mean",
    equations: Literal["model", "robot", "velocity", "decaying", "held"] = "model",
    calibrate: Sequence[str] = (),
    method: Literal["program", "bisection"] = "program",
    until: float | None = None,
    horizon: float | None = None,
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
        The recordings: a data set, runs, or the path of a folder as for `Recordings.open`. With
        ``horizon`` they may be logs as they are, as for `model`.
    torque
        What the recorded torques are: ``"compensated"`` (the model's input: gravity and Coulomb
        friction are already subtracted), ``"motor"`` (motor torque at the output side of the
        gear) or ``"link"`` (link-side torque of a joint torque sensor). It is never guessed.
    suites
        Names of the suites to use, or patterns such as ``"A*"``; all by default.
    paper_model
        Model 1, 2 or 3 of the paper. Not for an abstraction, which has its own.
    order
        The order of its Taylor polynomials. Not for an abstraction.
    expansion
        Where the model is expanded: n positions, rad, or also n velocities, rad/s. Not for an
        abstraction.
    fit
        Groups of parameters of the nominal model that are chosen for the smallest sets.
    pull
        The weight of the pull of a fit toward the identified values, from 0 to 1; chosen by leaving
        one motion out if it is not given.
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
    stiction
        Widen U by the dry friction that is possible where joints may come to rest, for other
        motions under the same motor torque.
    weights
        Weights of the states in the cost: 1, or 2 or 2n numbers.
    noise
        Measurement noise V: none, fitted to the recordings, or its radii, 2 or 2n numbers, rad and
        rad/s.
    sensor_noise
        Radii of the sensors' noise, 2 or 2n numbers, rad and rad/s, which limit V; estimated from
        the recordings if they are not given.
    input_doubling
        Accelerations of the nominal motion, one per joint, rad/s², at which U is twice what it is
        at rest; U is the same along every motion if they are not given.
    nominal
        Where nominal motions start: at the mean of a suite's first states, at each run's own, or
        where the samples before a window of a log tell that it starts.
    equations
        Whose equations of motion nominal motions satisfy: the model's, or the robot's own, which
        leaves to U what the robot itself does not explain and needs a linear model. ``"velocity"``,
        ``"decaying"`` and ``"held"`` need neither the robot nor its torque: U is a set of
        accelerations, about a motion whose velocity or acceleration at the start goes on.
    calibrate
        Motions that are held out from the fit, to which the sets are then scaled.
    method
        Programs, or the paper's bisection.
    until
        Samples later than this many seconds after the first are not used.
    horizon
        Length of the windows into which recordings are cut, s, each a suite of its own. Torques of
        motors or links are filtered before, and the robot's gravity and dry friction are subtracted
        from them. `check`, `reach` and `report` do the same to theirs.
    max_gap
        Longest time between two samples, s.
    resume
        A file that keeps the progress of a long search, and from which it goes on.
    progress
        ``True`` for a bar; a function is called with what is done, all, and sentences.

    Returns
    -------
    Model
        With ``verified`` false if it could not be proved, which is not an error.
        Implausible results also produce a warning, `ReachtubeWarning`.

    Raises
    ------
    DefectsError
        Recordings with defects, all of them.
    SettingError
        An argument that is not possible.
    KeyboardInterrupt
        Within 0.2 s, with nothing written.
    """
    given = among(locals())
    recordings, preparation, before = _cut(robot, data, torque, horizon, until, max_gap, calibrate)
    if preparation is not None:
        given["torque"] = "compensated"
    settings = of_conformance(robot, **given)
    with shown(progress, "conform") as tell:
        text, notes = _reachtube.conform(
            robot._native if isinstance(robot, Robot) else None,
            robot._native if isinstance(robot, Abstraction) else None,
            recordings,
            names(suites),
            settings,
            names(fit),
            None if pull is None else real("pull", pull),
            None if resume is None else fspath(resume),
            preparation,
            tell,
        )
    return told(text, [*before, *notes], 4)


def _cut(
    robot: Robot | Abstraction,
    data: Data | Logs,
    torque: Torque,
    horizon: float | None,
    until: float | None,
    max_gap: float | None,
    calibrate: Sequence[str],
) -> tuple[_reachtube.Source, str | None, list[str]]:
    """Return recordings, cut into windows where there is a horizon, what was done, and notes."""
    if horizon is None:
        return source(data), None, []  # type: ignore[arg-type]
    length = above_zero("horizon", horizon)
    if until is not None:
        raise SettingError("horizon and until exclude each other: windows end at the horizon")
    refuse_gap_of_logs(max_gap)
    return _reachtube.cut(
        robot._native if isinstance(robot, Robot) else None,
        robot._native if isinstance(robot, Abstraction) else None,
        torque,
        length,
        names(calibrate),
        *native_of_logs(data),
    )


def told(text: str, notes: list[str], level: int) -> Model:
    """Return the model, and report its notes and warnings to the caller `level` frames above."""
    for note in notes:
        log.info(note)
    found = Model(text)
    for finding in found.findings:
        if finding.severity != "info":
            warnings.warn(str(finding), ReachtubeWarning, level)
    return found


def check(
    model: Model,
    data: Data | Logs,
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
    model
        The model.
    data
        The recordings. For a model that `model` made they are logs, which are prepared as its own
        were.
    suites
        Names of the suites to use; all by default.
    notion
        Directions in which recordings must lie in the set; the model's own by default.
    until
        Samples later than this many seconds after the first are not used; the model's own limit
        if it is not given.
    max_gap
        Longest time between two samples, s.
    progress
        As for `conform`.

    Returns
    -------
    Check
        A check that fails is returned with witnesses, not raised.
    """
    text_of(model)
    return model.check(
        data, suites=suites, notion=notion, until=until, max_gap=max_gap, progress=progress
    )
