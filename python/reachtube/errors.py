"""Exceptions and warnings of reachtube."""

from __future__ import annotations

from dataclasses import dataclass


class ReachtubeError(Exception):
    """A job that could not be done; the text has the problem and the remedy.

    A model that is not conformant is no error but a value.
    """


@dataclass(frozen=True)
class Defect:
    """A defect of a recording.

    Attributes
    ----------
    file
        The file, or the name of a run in memory.
    line
        Line of the file, from 1; ``None`` if there is none.
    joint
        Number of the joint, from 1; ``None`` if there is none.
    kind
        ``"header"``, ``"gap"``, ``"value"``, ...
    problem
        The problem, as a sentence.
    remedy
        The remedy, as a sentence.
    """

    file: str
    line: int | None
    joint: int | None
    kind: str
    problem: str
    remedy: str


class DefectsError(ReachtubeError):
    """Recordings with defects.

    Attributes
    ----------
    defects : tuple of Defect
        All defects of all recordings.
    """

    defects: tuple[Defect, ...]

    def __init__(self, text: str, defects: tuple[Defect, ...] = ()) -> None:
        super().__init__(text)
        self.defects = tuple(defects)

    def __reduce__(self) -> tuple[type[DefectsError], tuple[str, tuple[Defect, ...]]]:
        return type(self), (str(self), self.defects)


class SettingError(ReachtubeError, ValueError):
    """An argument that is not possible; the text names it, its value and what it may be."""


class ModelFileError(ReachtubeError):
    """A file or text that is no model, or a model of another version."""


class ReachtubeWarning(UserWarning):
    """An implausible answer; the text gives the reason and the most likely cause."""
