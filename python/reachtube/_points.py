"""The recorded points of a fleet, which the notions phase-plane and exact ask in rounds."""

from __future__ import annotations

import functools
from collections.abc import Iterator
from typing import Any

from . import _reachtube
from ._jobs import Entry, Job, Part, as_tree, fleet_of, read_one, same


@functools.lru_cache(maxsize=2)
def _problem(job: Job, whole: bytes) -> _reachtube.FleetProblem:
    """Return what a worker needs of all recordings to find the points of some."""
    return fleet_of(job).problem(whole)


def _points(job: Job, whole: bytes, part: Part) -> _reachtube.PartPoints:
    """Read the points of a part."""

    def recorded() -> Iterator[tuple[Entry, bytes | _reachtube.Run | None]]:
        for place, row in part.rows:
            entry, found = read_one(place, row, part)
            yield entry, None if isinstance(found, tuple) else found

    return _reachtube.PartPoints.read(_problem(job, whole), recorded())


def _answer(job: Job, whole: bytes, points: _reachtube.PartPoints, question: bytes) -> bytes:
    return points.answer(_problem(job, whole), question)


def _merge_answers(answers: list[bytes]) -> bytes:
    return _reachtube.PartPoints.merge(answers)


class Points:
    """The recorded points of a fleet, which workers hold, or this process where there are none.

    The cutting planes of the notions ``"phase-plane"`` and ``"exact"`` ask all of them in rounds.
    Answers merge in any order to the same bits.
    """

    def __init__(self, job: Job, parts: list[Part], client: Any, whole: Any) -> None:
        self._job, self._parts, self._client, self._whole = job, parts, client, whole
        self._held: list[Any] | None = None
        self._shared: Any = None
        self._asked: Any = None
        self._is_over = False

    def ask(self, question: bytes) -> bytes:
        """Return the answer of all points to a question."""
        if self._client is None:
            return self._ask_here(question)
        if self._held is None:
            self._shared = self._submit(same, self._job)
            self._held = [
                self._submit(_points, self._shared, self._whole, part) for part in self._parts
            ]
        put = self._submit(same, question)
        answers = [
            self._submit(_answer, self._shared, self._whole, points, put) for points in self._held
        ]
        asked = self._asked = as_tree(
            functools.partial(self._client.submit, _merge_answers), answers
        )
        del answers, put
        if self._is_over:
            asked.cancel()
        content: bytes = asked.result()
        return content

    def _submit(self, task: Any, *arguments: Any) -> Any:
        return self._client.submit(task, *arguments, pure=False, retries=3)

    def _ask_here(self, question: bytes) -> bytes:
        if self._held is None:
            self._held = [
                _points(self._job, self._whole, part) for part in self._parts if not self._is_over
            ]
        answers = [
            _answer(self._job, self._whole, points, question)
            for points in self._held
            if not self._is_over
        ]
        return _merge_answers(answers)

    def close(self) -> None:
        """Drop the points; a question that waits ends."""
        self._is_over = True
        if self._client is None:
            _problem.cache_clear()
        elif self._asked is not None:
            # Only what no other task needs can be cancelled: Dask's scheduler ends the connection
            # of a client that cancels a task whose dependents are not wanted any more.
            self._asked.cancel()
        self._held = self._shared = self._asked = self._whole = None
