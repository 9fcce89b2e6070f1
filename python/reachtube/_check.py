"""Answers of checks: whether other recordings lie in a model's reachable set."""

from __future__ import annotations

from html import escape
from typing import Any

from . import _html, _reachtube
from ._findings import Finding, findings_of
from ._record import Record


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
        """The value furthest outside: suite, run, time, part, state, side and excess."""
        worst = self._content["violations"]["worst"]
        return None if worst is None else dict(worst)

    @property
    def suites(self) -> list[dict[str, Any]]:
        """The same for each suite."""
        return list(self._content["suites"])

    @property
    def trust(self) -> dict[str, Any] | None:
        """The statement about the next motion; ``None`` if a recording was in the fit."""
        trust = self._content.get("trust")
        return None if trust is None else dict(trust)

    @property
    def findings(self) -> list[Finding]:
        """The findings of the answer, the verdict first."""
        return findings_of(_reachtube.check_findings(self._text))

    @property
    def notes(self) -> list[str]:
        """Notes about the recordings for the user."""
        return [str(note) for note in self._content["notes"]]

    def to_pandas(self) -> Any:
        """Return a pandas DataFrame with one row for each suite."""
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
        text = _html.verdict(self.conformant, str(self.findings[0]))
        rows = []
        for suite in self.suites:
            worst = suite["violations"]["worst"] or {}
            place = f"{worst['state']} at {worst['time']:.3f} s in {worst['run']}" if worst else ""
            excess = f"{worst['excess']:.3g}" if worst else ""
            count = str(suite["violations"]["count"])
            rows.append([escape(suite["suite"]), str(suite["runs"]), count, excess, escape(place)])
        return text + _html.table(["suite", "runs", "outside", "furthest", "where"], rows)
