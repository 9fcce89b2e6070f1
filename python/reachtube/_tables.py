"""Runs made of the columns of tables, and of arrays by their names."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import Any

import numpy as np

from ._arrays import Array, names, numbers
from ._recordings import Run
from .errors import Defect, DefectsError, ReachtubeError, SettingError


def run_of_columns(
    origin: str,
    columns: Mapping[str, Any],
    joints: Sequence[str] | None,
    suite: str | None,
    motion: str | None,
) -> Run:
    """Return the run of columns t, q1.., qd1.., tau1.. or, with `joints`, position.NAME, ..."""
    if joints is None:
        count = 0
        while f"q{count + 1}" in columns:
            count += 1
        if count == 0:
            raise ReachtubeError(
                f"{origin}: there is no column q1; name the joints of columns position.NAME with "
                f"joints=, or the columns as in the CSV format; there are {', '.join(columns)}"
            )
        wanted = {
            part: [f"{prefix}{j + 1}" for j in range(count)]
            for part, prefix in {"q": "q", "qd": "qd", "tau": "tau"}.items()
        }
    else:
        prefixes = {"q": "position", "qd": "velocity", "tau": "effort"}
        own = names(joints)
        wanted = {part: [f"{p}.{name}" for name in own] for part, p in prefixes.items()}
    missing = [name for part in ("q", "qd", "tau") for name in wanted[part] if name not in columns]
    if "t" not in columns:
        missing.insert(0, "t")
    if missing:
        raise ReachtubeError(
            f"{origin}: these columns are missing: {', '.join(missing)}; there are "
            f"{', '.join(columns)}"
        )
    parts: dict[str, Array] = {
        part: np.column_stack([numbers(name, columns[name]) for name in each])
        for part, each in wanted.items()
    }
    times = numbers("t", columns["t"])
    warm = [name for j in range(len(wanted["q"])) if (name := f"temp{j + 1}") in columns]
    if joints is None and len(warm) == len(wanted["q"]):
        parts["temp"] = np.column_stack([numbers(name, columns[name]) for name in warm])
    check_finite(origin, {"t": times[:, None], **parts})
    return Run(times, parts["q"], parts["qd"], parts["tau"], name=Path(origin).name, suite=suite,
               motion=motion, temperature=parts.get("temp"))


def check_finite(origin: str, parts: Mapping[str, Array]) -> None:
    """Name every column that holds a number which is not finite."""
    defects = []
    for name, values in parts.items():
        for j in range(values.shape[1]):
            wrong = np.flatnonzero(~np.isfinite(values[:, j]))
            if len(wrong):
                joint = None if name == "t" else j + 1
                problem = (
                    f"{name} is not a finite number in {len(wrong)} samples, first in sample "
                    f"{wrong[0]} (from 0)"
                )
                remedy = "drop these samples, or record again"
                defects.append(Defect(origin, None, joint, "value", problem, remedy))
    if defects:
        places = [
            f"{origin}{f': joint {d.joint}' if d.joint else ''}: {d.problem}; {d.remedy}"
            for d in defects
        ]
        raise DefectsError("\n".join(places), tuple(defects))


def run_of_arrays(
    origin: str,
    arrays: Mapping[str, Any],
    joints: Sequence[str] | None,
    suite: str | None,
    motion: str | None,
) -> Run:
    """Return the run of the arrays t, q, qd and tau, with the columns of `joints` if given."""
    missing = [name for name in ("t", "q", "qd", "tau") if name not in arrays]
    if missing:
        there = ", ".join(arrays) or "none"
        raise ReachtubeError(
            f"{origin}: these arrays are missing: {', '.join(missing)}; there are {there}"
        )
    order: Any = slice(None)
    if joints is not None:
        order = places_of(origin, arrays.get("joints"), joints)
    parts = {}
    for name in ("q", "qd", "tau"):
        values = numbers(name, arrays[name])
        if values.ndim != 2:
            raise SettingError(f"{origin}: {name} has the shape {values.shape}; give K x n")
        parts[name] = values[:, order]
    times = numbers("t", arrays["t"])
    if times.ndim != 1:
        raise SettingError(f"{origin}: t has the shape {times.shape}; give one axis")
    check_finite(origin, {"t": times[:, None], **parts})
    return Run(times, parts["q"], parts["qd"], parts["tau"], name=Path(origin).name, suite=suite,
               motion=motion)


def places_of(origin: str, found: Any, joints: Sequence[str]) -> list[int]:
    """Return the column of each joint."""
    if found is None:
        raise ReachtubeError(f"{origin}: it does not name its joints; leave joints= out, or add "
                             "an array joints with their names")
    known = [name.decode() if isinstance(name, bytes) else str(name) for name in np.ravel(found)]
    wanted = names(joints)
    missing = [name for name in wanted if name not in known]
    if missing:
        raise ReachtubeError(
            f"{origin}: these joints are missing: {', '.join(missing)}; there are "
            f"{', '.join(known)}"
        )
    return [known.index(name) for name in wanted]
