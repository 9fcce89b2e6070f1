"""Identification of robots."""

from __future__ import annotations

import json
import warnings
from collections.abc import Iterable, Mapping, Sequence
from os import PathLike, fspath
from pathlib import Path
from typing import Any, Literal, TypeAlias

from . import _reachtube
from ._arrays import check_choice, json_of
from ._files import write_new
from ._progress import Progress, shown
from ._record import Record
from ._recordings import Run
from ._robot import Robot, native_of
from .errors import ReachtubeError, ReachtubeWarning, SettingError

Logs: TypeAlias = "Sequence[Run | str | PathLike[str]] | Run | str | PathLike[str]"


class Identification(Record):
    """A robot identified from recordings, with the quality of its fits and its validation.

    It holds the texts that describe it: what the command prints as JSON, the robot file and the
    page.
    """

    __slots__ = ()

    @classmethod
    def _of(cls, summary: str, robot: str, page: str) -> Identification:
        return cls(json.dumps({"summary": summary, "robot": robot, "page": page}))

    def __init__(self, text: str) -> None:
        super().__init__(text)
        object.__setattr__(self, "_content", json.loads(self._content["summary"]))

    def _kept(self, name: str) -> str:
        return str(json.loads(self._text)[name])

    @property
    def robot(self) -> Robot:
        """The identified robot."""
        return Robot.from_dict(self._content["robot"])

    @property
    def warnings(self) -> list[str]:
        """Implausible results, and steps that were not possible."""
        return [str(warning) for warning in self._content["warnings"]]

    @property
    def parameters(self) -> list[dict[str, Any]]:
        """The identifiable combinations: name, value, standard error, ..."""
        return list(self.to_dict()["parameters"])

    @property
    def validation(self) -> list[dict[str, Any]]:
        """Errors of the predicted torque, for each recording that was held out."""
        return list(self.to_dict()["validation"])

    def to_dict(self) -> dict[str, Any]:
        """Return everything as a new dictionary, with the keys of the command's JSON."""
        content: dict[str, Any] = json.loads(self._kept("summary"))
        return content

    def to_pandas(self) -> Any:
        """Return a pandas DataFrame with one row for each identifiable combination."""
        import pandas

        return pandas.DataFrame(self.parameters)

    def save(self, path: str | PathLike[str], *, force: bool = False) -> None:
        """Write the robot file, with standard errors.

        Parameters
        ----------
        path
            The file, in TOML; its folder is made if it does not exist.
        force
            Whether a file that exists is replaced.

        Raises
        ------
        ReachtubeError
            If the file exists and ``force`` is false, or cannot be written.
        """
        write_new(Path(path), self._kept("robot"), force=force)

    def report(self, path: str | PathLike[str], *, force: bool = False) -> Path:
        """Write the page about the identification.

        Parameters
        ----------
        path
            The file, in HTML; its folder is made if it does not exist.
        force
            Whether a file that exists is replaced.

        Returns
        -------
        Path
            The page.

        Raises
        ------
        ReachtubeError
            If the file exists and ``force`` is false, or cannot be written.
        """
        write_new(Path(path), self._kept("page"), force=force)
        return Path(path)

    def save_urdf(
        self, original: Robot, path: str | PathLike[str], *, force: bool = False
    ) -> None:
        """Write a URDF with the identified values, and a TOML file with the others beside it.

        Parameters
        ----------
        original
            The robot that `Robot.from_urdf` or `Robot.load` read from a URDF; all other text of
            the URDF stays as it is.
        path
            The URDF to write. The TOML file has the same name, with the suffix ``.toml``.
        force
            Whether files that exist are replaced.

        Raises
        ------
        ReachtubeError
            If `original` was not read from a URDF, a file exists and ``force`` is false, or a file
            cannot be written.
        """
        texts = original._native.updated_urdf(self.robot._native)
        if texts is None:
            raise ReachtubeError(f"{original.name} was not read from a URDF; use save()")
        target = Path(path)
        write_new(target, texts[0], force=force)
        write_new(target.with_suffix(".toml"), texts[1], force=force)

    def __repr__(self) -> str:
        count, determined = len(self._content["parameters"]), self._content["determined"]
        name = self._content["robot"]["name"]
        return f"<Identification of {name}: {determined} of {count} combinations determined>"


def _recorded(logs: Logs) -> tuple[list[str], list[tuple[_reachtube.Run, int | None]]]:
    """Return paths, and runs with their places in the order of recording."""
    items = [logs] if isinstance(logs, (Run, str, PathLike)) else logs
    if not isinstance(items, Iterable):
        raise SettingError(f"recordings are of type {type(logs).__name__}; give runs or paths")
    items = list(items)
    for item in items:
        if not isinstance(item, (Run, str, PathLike)):
            kind = type(item).__name__
            raise SettingError(f"a recording is of type {kind}; give runs or paths")
    paths = [fspath(item) for item in items if not isinstance(item, Run)]
    return paths, [(item._native, item.order) for item in items if isinstance(item, Run)]


def identify(
    robot: Robot,
    *,
    excitation: Logs = (),
    rest: Logs = (),
    one_joint: Logs = (),
    validate: Logs = (),
    settings: str | PathLike[str] | None = None,
    prepare: dict[str, Any] | None = None,
    model: dict[str, Any] | None = None,
    torque: Literal["motor", "link"] | None = None,
    progress: Progress = None,
) -> Identification:
    """Identify gravity, friction and inertia of a robot from recordings of motor torques.

    Parameters
    ----------
    robot
        Its geometry, and the prior of its links.
    excitation
        Recordings of exciting motions: runs, or paths of CSV files or folders of them.
    rest
        Recordings of poses at rest, likewise.
    one_joint
        Recordings of slow motions of single joints, likewise.
    validate
        Recordings of motions that are held out, likewise.
    settings
        A TOML file with recordings and settings, whose paths are relative to its folder.
    prepare
        Settings of the preparation by their names in the TOML file's section, for example
        ``prepare={"cut_off": 5.0}``.
    model
        Settings of the model by their names in the TOML file's section, for example
        ``model={"saturating": False}``.
    torque
        What the recorded torques are: ``"motor"`` (motor torque at the output side of the gear) or
        ``"link"`` (link-side torque, which does not drive the motors' inertia); as the settings say
        if it is not given, and they say motor by default.
    progress
        As for `conform`.

    Returns
    -------
    Identification
        Implausible results also produce a warning, `ReachtubeWarning`.

    Raises
    ------
    DefectsError
        Recordings with defects, all of them.
    ReachtubeError
        Settings that do not suit the recordings, and fits that are not possible.
    """
    toml, folder = None, Path()
    if settings is not None:
        folder = Path(settings).parent
        try:
            toml = Path(settings).read_text(encoding="utf-8")
        except (OSError, UnicodeDecodeError) as error:
            raise ReachtubeError(f"{settings}: {error}") from None
    for name, section in {"prepare": prepare, "model": model}.items():
        if not isinstance(section or {}, Mapping):
            raise SettingError(f"{name} is {section!r}; give settings by their names")
    own = dict(model or {})
    if torque is not None:
        check_choice("torque", torque, ("motor", "link"))
        own["motor_inertia"] = torque == "motor"
    given = json_of("settings", {"prepare": dict(prepare or {}), "model": own})
    here = Path.cwd()
    recorded = []
    for logs in (rest, one_joint, excitation, validate):
        paths, runs = _recorded(logs)
        recorded.append(([str(here / path) for path in paths], runs))
    with shown(progress, "identify") as tell:
        found = Identification._of(
            *_reachtube.identify(native_of(robot), recorded, toml, given, str(folder), tell)
        )
    for warning in found.warnings:
        warnings.warn(warning, ReachtubeWarning, 3)
    return found
