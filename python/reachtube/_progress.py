"""Progress of long jobs."""

from __future__ import annotations

import logging
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from typing import Any, TypeAlias

log = logging.getLogger("reachtube")

#: ``True`` draws a bar with tqdm where it is installed; a function is called with the number of
#: finished parts, the number of all parts, and sentences about finished steps.
Progress: TypeAlias = "bool | Callable[[int, int, list[str]], object] | None"


@contextmanager
def shown(progress: Progress, what: str) -> Iterator[Any]:
    """Yield the function that the native part calls, or nothing."""
    if callable(progress):
        yield progress
        return
    if not progress:
        yield None
        return
    try:
        from tqdm.auto import tqdm
    except ImportError:
        yield lambda done, total, sentences: log.info("%s: %d of %d", what, done, total)
        return
    with tqdm(desc=what, unit="part") as bar:

        def tell(done: int, total: int, sentences: list[str]) -> None:
            bar.total = total or None
            bar.update(done - bar.n)
            if sentences:
                bar.set_postfix_str(sentences[-1])

        yield tell
