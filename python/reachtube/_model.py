"""Models with their uncertainty sets."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from html import escape
from os import PathLike, fspath
from pathlib import Path
from typing import Any

from . import _html, _reachtube
from ._arrays import Array, array_of, names
from ._box import Box
from ._bytes import checked
from ._check import Check
from ._files import read_text, write_new
from ._findings import Finding, Report, findings_of
from ._logs import Logs, native_of_logs
from ._progress import Progress, shown
from ._record import Record
from ._recordings import source
from ._robot import Robot
from ._settings import Data, Notion, differing, refuse_gap_of_logs
from .errors import ModelFileError, ReachtubeError, SettingError


class Model(Record):
    """A model of a robot's motion with uncertainty sets X0, U and V.

    It is reachset conformant with the recordings it was made of where `verified` is true: each lies
    in the reachable set, at its samples, which was proved with directed rounding.

    States are ordered q then q̇; units are SI units.
    """

    __slots__ = ()

    def __init__(self, text: str) -> None:
        if not isinstance(text, str) or not text.lstrip().startswith("{"):
            raise SettingError(
                "conform and model make a model, and Model.load(PATH) reads its file; Model was "
                f"given {text!r:.100}"
            )
        super().__init__(text)

    @classmethod
    def load(cls, path: str | PathLike[str]) -> Model:
        """Read a model file, as ``reachtube conform --out`` or `save` wrote it.

        Parameters
        ----------
        path
            The file.

        Returns
        -------
        Model

        Raises
        ------
        ModelFileError
            For another file, one of another version, or one that was changed.
        """
        text = read_text(path, "conform")
        _reachtube.check_model(text, fspath(path))
        return cls(text)

    def save(self, path: str | PathLike[str], *, force: bool = False) -> None:
        """Write the model file, whole or not at all.

        The bounds of a calibrated model count the other models in the folder that some of the same
        recordings calibrated, as the command ``conform`` does.

        Parameters
        ----------
        path
            The file, in JSON; its folder is made if it does not exist.
        force
            Whether a file that exists is replaced.

        Raises
        ------
        ReachtubeError
            If the file exists and ``force`` is false, or cannot be written.
        """
        text = self._text
        if self._content.get("calibration") is not None:
            text = _reachtube.among_others(text, fspath(path))
        write_new(Path(path), text, force=force)

    def to_bytes(self) -> bytes:
        """Return the model file, whose format has a version."""
        return self._text.encode()

    @classmethod
    def from_bytes(cls, data: bytes) -> Model:
        """Return the model of a model file's bytes.

        Parameters
        ----------
        data
            The bytes, as `to_bytes` returns them or a model file has them.

        Returns
        -------
        Model

        Raises
        ------
        ModelFileError
            For other bytes, bytes of another version, or bytes that were changed.
        """
        try:
            text = checked(data).decode()
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
        """The reachable set's widths, summed over states and integrated over time; ``None`` where
        a set was lost. Costs of a file without ``cost_of_samples`` are sums over samples."""
        return self._number("cost")

    @property
    def cost_of_samples(self) -> float | None:
        """The cost as the paper sums it, over states and distinct sample times; ``None`` where a
        set was lost, and for files of older versions."""
        return self._number("cost_of_samples")

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
    def findings(self) -> list[Finding]:
        """What the answer says, statement by statement: the verdict first."""
        return findings_of(_reachtube.model_findings(self._text))

    @property
    def report(self) -> Report:
        """The answer for people, as the command prints it."""
        return Report(*_reachtube.model_report(self._text))

    @property
    def warnings(self) -> list[str]:
        """The findings that are warnings, as sentences."""
        return [str(finding) for finding in self.findings if finding.severity == "warning"]

    @property
    def violation_probability(self) -> float:
        """Upper bound of the probability that the next motion leaves the set; see `trust`."""
        return float(self._content["trust"]["violation_probability"])

    @property
    def trust(self) -> dict[str, Any]:
        """The bound for the next motion: its confidence, its assumptions (``basis``), and whether
        it is a guarantee or an indication (``kind``)."""
        return dict(self._content["trust"])

    @property
    def proof(self) -> dict[str, Any]:
        """What was proved, with the worst witness where it was not."""
        return dict(self._content["proof"])

    @property
    def simulated(self) -> bool:
        """Whether it was made of simulated recordings."""
        return bool(self._content["data"].get("simulated", False))

    @property
    def settings(self) -> dict[str, Any]:
        """The settings of the sets and of the arm."""
        return {**self._content["drive"]["settings"], **self._content["settings"]}

    @property
    def robot(self) -> Robot:
        """The robot."""
        robot = dict(self._content["drive"]["robot"])
        if "seen" in self._content:
            robot["identified_from"] = self._content["seen"]
        return Robot.from_dict(robot)

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

    @property
    def state_units(self) -> tuple[str, ...]:
        """The units of the states, 2n: rad and rad/s, or m and m/s for prismatic joints."""
        joints = self._content["drive"]["robot"]["joint"]
        kinds = [joint.get("type", "revolute") for joint in joints]
        lengths = ["m" if kind == "prismatic" else "rad" for kind in kinds]
        return (*lengths, *(f"{unit}/s" for unit in lengths))

    def _number(self, name: str) -> float | None:
        value = self._content.get(name)
        return None if value is None else float(value)

    def check(
        self,
        data: Data | Logs,
        *,
        suites: str | Sequence[str] | None = None,
        notion: Notion | None = None,
        until: float | None = None,
        max_gap: float | None = None,
        progress: Progress = None,
    ) -> Check:
        """Check whether the model encloses other recordings, as the function `check` does.

        Parameters
        ----------
        data
            The recordings, as for the function `check`.
        suites
            Names of the suites to use; all where none are given.
        notion
            Directions in which recordings must lie in the set; the model's own where not given.
        until
            Samples later than this many seconds after the first are not used; the model's own limit
            where it is not given.
        max_gap
            Longest time between two samples, s.
        progress
            As for `conform`.

        Returns
        -------
        Check
            A check that fails is returned with witnesses, not raised.
        """
        recordings = source_for(self, data, max_gap)
        # Logs show why they leave the sets.
        logs = native_of_logs(data) if "preparation" in self._content else ([], None)
        settings = differing(notion, until, max_gap)
        with shown(progress, "check") as tell:
            return Check(
                _reachtube.check(self._text, recordings, names(suites), settings, *logs, tell)
            )

    def _rows_of_sets(self) -> Iterator[tuple[str, str, str, float, float]]:
        """Yield set, entry, unit, centre and radius of all entries."""
        n = self.joints
        units = list(self.state_units)
        states = [f"q{j + 1}" for j in range(n)] + [f"qd{j + 1}" for j in range(n)]
        forces = ["N" if unit == "m" else "N m" for unit in units[:n]]
        inputs = [f"u{j + 1}" for j in range(n)]
        boxes = [("X0", states, units, self.initial_set), ("U", inputs, forces, self.input_set)]
        if self.noise_set is not None:
            boxes.append(("V", states, units, self.noise_set))
        for name, entries, own, box in boxes:
            for k, entry in enumerate(entries):
                yield name, entry, own[k], float(box.centre[k]), float(box.radius[k])

    def to_pandas(self) -> Any:
        """Return the sets as a pandas DataFrame: one row for each entry of X0, U and V."""
        import pandas

        rows = [
            {"set": name, "entry": entry, "unit": unit, "centre": centre, "radius": radius}
            for name, entry, unit, centre, radius in self._rows_of_sets()
        ]
        return pandas.DataFrame(rows)

    def __repr__(self) -> str:
        words = "conformant" if self.verified else "NOT PROVED CONFORMANT"
        cost = "lost" if self.cost is None else f"{self.cost:.6g}"
        proof = self._content["proof"]
        return f"<Model {words}: cost {cost}, {proof['runs']} recordings, {proof['rows']} rows>"

    def _repr_html_(self) -> str:
        findings = self.findings
        of = {finding.code: finding for finding in findings}
        text = _html.verdict(self.verified, str(findings[0]))
        text += _html.lines(
            each for each in findings if each.code == "cost" or each.severity != "info"
        )
        rows = list(self._rows_of_sets())
        largest: dict[tuple[str, str], float] = {}
        for name, _, unit, _, radius in rows:
            largest[name, unit] = max(radius, largest.get((name, unit), 0.0))
        cells = [
            [name, entry, f"{centre:.4g}", f"{radius:.4g}", escape(unit),
             _html.bar(radius, largest[name, unit])]
            for name, entry, unit, centre, radius in rows
        ]
        text += _html.table(["set", "entry", "centre", "radius", "unit", ""], cells)
        last = ("next-motion", "no-guarantee")
        return text + _html.lines(of[code] for code in last if code in of)


def text_of(model: Model) -> str:
    """Return the text of a model."""
    if not isinstance(model, Model):
        kind = type(model).__name__
        raise SettingError(f"the model is of type {kind}; give a Model, such as Model.load(PATH)")
    return model._text


def source_for(model: Model, data: Logs, max_gap: float | None = None) -> _reachtube.Source:
    """Return the native source of recordings that are compared with a model.

    Logs for a model that `model` made are prepared as its own were.
    """
    if "preparation" in model._content:
        refuse_gap_of_logs(max_gap)
        return _reachtube.prepared(model._text, *native_of_logs(data))
    return source(data)  # type: ignore[arg-type]
