"""Answers of `stop` and `verify`: records with findings, a summary and files."""

from __future__ import annotations

import json
from collections.abc import Mapping
from os import PathLike, fspath
from pathlib import Path
from typing import Any, TypeAlias

from ._arrays import json_of
from ._files import check_new, write_new
from ._findings import Finding
from ._record import Record
from .errors import ReachtubeError, SettingError

#: What a TOML file has: its path, or its keys.
Toml: TypeAlias = "str | PathLike[str] | Mapping[str, Any]"


class Answer(Record):
    """An answer with findings, a summary for people, and files."""

    __slots__ = ()

    @property
    def _answer(self) -> dict[str, Any]:
        answer: dict[str, Any] = self._content["answer"]
        return answer

    @property
    def _files(self) -> dict[str, str]:
        return dict(self._content["files"])

    @property
    def findings(self) -> list[Finding]:
        """The findings of the answer, the verdict first."""
        return [Finding._of(dict(finding)) for finding in self._content["findings"]]

    def to_dict(self) -> dict[str, Any]:
        """Return everything as a new dictionary, with the keys of the command's JSON."""
        content: dict[str, Any] = json.loads(self._text)["answer"]
        return content

    def __str__(self) -> str:
        return str(self._content["summary"])

    def __repr__(self) -> str:
        return f"<{type(self).__name__} {self.findings[0].text}>"

    def _save(self, folder: str | PathLike[str], force: bool) -> None:
        files = {Path(folder) / name: text for name, text in self._files.items()}
        for path in files:
            check_new(path, force=force)
        for path, text in files.items():
            write_new(path, text, force=force)


def infinite(value: float | None) -> float:
    """Return a bound, which is infinite if JSON has null."""
    return float("inf") if value is None else float(value)


def toml_of(what: str, given: Toml) -> tuple[str, str | None]:
    """Return the text of a TOML file and its path, or keys as JSON and ``None``."""
    if isinstance(given, Mapping):
        return json_of(what, dict(given)), None
    if not isinstance(given, (str, PathLike)):
        raise SettingError(
            f"{what} is of type {type(given).__name__}; give the path of a TOML file, or its keys"
        )
    try:
        return Path(given).read_text(encoding="utf-8"), fspath(given)
    except (OSError, UnicodeDecodeError) as error:
        raise ReachtubeError(f"{given}: {error}; docs/verify.md describes the file") from None
