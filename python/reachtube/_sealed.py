"""Model files as results: text with its own digest, and the findings of the call that made it."""

from __future__ import annotations

import json
from os import PathLike, fspath
from pathlib import Path
from typing import Any, ClassVar, TypeVar

from ._files import read_text, write_new
from ._findings import Finding
from ._record import Record

Own = TypeVar("Own", bound="SealedModel")


class SealedModel(Record):
    """A model file, with the findings and the summary of the call that made it."""

    __slots__ = ()
    _command: ClassVar[str]

    @staticmethod
    def _parse(text: str, origin: str) -> tuple[str, str]:
        raise NotImplementedError

    @property
    def _file(self) -> str:
        return str(self._content["model"])

    @property
    def _model(self) -> dict[str, Any]:
        model: dict[str, Any] = json.loads(self._file)
        return model

    @classmethod
    def _of(cls: type[Own], text: str, said: str = "{}") -> Own:
        """Return the model of a file's text, with findings and summary, if any."""
        return cls(json.dumps({"model": text, **json.loads(said)}))

    @property
    def verified(self) -> bool:
        """Whether every recorded sample was proved to lie in the sets."""
        return bool(self._model["verified"])

    @property
    def useful(self) -> bool:
        """Whether it is verified, and narrower than what there is without a model."""
        return bool(self._content["useful"])

    @property
    def findings(self) -> list[Finding]:
        """What spoke against the model when it was made; a file has none of it."""
        return [Finding._of(dict(finding)) for finding in self._content.get("findings", [])]

    def to_dict(self) -> dict[str, Any]:
        """Return the model's file as a new dictionary."""
        return self._model

    def save(self, path: str | PathLike[str], *, force: bool = False) -> None:
        """Write the model's file, whole or not at all.

        Parameters
        ----------
        path
            The file, in JSON.
        force
            Whether a file that exists is replaced.
        """
        write_new(Path(path), self._file, force=force)

    @classmethod
    def load(cls: type[Own], path: str | PathLike[str]) -> Own:
        """Read a file that `save` or the command wrote.

        Parameters
        ----------
        path
            The file.

        Returns
        -------
        object of this class
        """
        return cls._of(*cls._parse(read_text(path, cls._command), fspath(path)))

    def __bool__(self) -> bool:
        return self.useful

    def __str__(self) -> str:
        return str(self._content.get("summary", repr(self)))

    def __repr__(self) -> str:
        word = "conformant" if self.verified else "NOT PROVED conformant"
        if self.verified and not self.useful:
            word += ", but vacuous"
        return f"<{type(self).__name__} {word}: {len(self._model['recordings'])} recordings>"


class SampleCheck(Record):
    """The answer of a check: whether recorded values lie in the sets."""

    __slots__ = ()
    _values: ClassVar[str]

    @property
    def conformant(self) -> bool:
        """Whether every value at every sample was proved to lie in its set."""
        return bool(self._content["conformant"])

    @property
    def outside(self) -> int:
        """The number of values that were not proved to lie in their sets."""
        return int(self._content["outside"])

    def __bool__(self) -> bool:
        return self.conformant

    def __repr__(self) -> str:
        word = "conformant" if self.conformant else "not conformant"
        count = self._content[self._values]
        return f"<{type(self).__name__} {word}: {self.outside} of {count} {self._values} outside>"
