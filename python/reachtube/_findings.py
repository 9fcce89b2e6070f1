"""Findings of an answer, and reports of them."""

from __future__ import annotations

import json
from dataclasses import dataclass, field
from typing import Any, Literal

from . import _html


@dataclass(frozen=True)
class Finding:
    """One statement about an answer; ``str`` returns it as a sentence, with its remedy."""

    severity: Literal["info", "warning", "failure"]
    """How much it matters."""
    code: str
    """What it is about. Codes are stable; sentences are not."""
    text: str
    """The sentence, without the remedy."""
    place: str | None = None
    """The suite, recording, joint or motion that it is about."""
    numbers: dict[str, float] = field(default_factory=dict)
    """The numbers by their names, in SI units."""
    remedy: dict[str, str] | None = None
    """A setting that helps: ``setting``, ``value`` (empty if you choose it), ``effect``."""
    _written: str = field(default="", repr=False)

    @classmethod
    def _of(cls, content: dict[str, Any]) -> Finding:
        written = content.pop("written")
        return cls(**content, _written=written)

    def __str__(self) -> str:
        return self._written


def findings_of(text: str) -> list[Finding]:
    """Return the findings in a JSON list."""
    return [Finding._of(content) for content in json.loads(text)]


class Report:
    """An answer for people: ``print`` it, or let a notebook show it."""

    __slots__ = ("_sections", "_text")

    def __init__(self, text: str, sections: str) -> None:
        self._text = text
        self._sections = json.loads(sections)["sections"]

    @property
    def findings(self) -> list[Finding]:
        """The findings, in the order in which they are read."""
        return [
            Finding._of(dict(content))
            for section in self._sections
            for content in section["findings"]
        ]

    def __str__(self) -> str:
        return self._text

    def __repr__(self) -> str:
        return f"<Report: {len(self.findings)} findings>"

    def _repr_html_(self) -> str:
        return _html.report(self._sections)
