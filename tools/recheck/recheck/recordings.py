"""Reading of recordings: the index `runs.csv` and one CSV file per run.

Values are the doubles nearest to the decimals as written. Times are exact: their differences from
the first time are rounded to a picosecond.
"""

import csv
import hashlib
import math
import re
from dataclasses import dataclass, field
from decimal import ROUND_HALF_UP, Context, Decimal
from pathlib import Path

from .errors import BadInput
from .grid import Grid, grid_of

PER_SECOND = Decimal(10**12)
# Digits enough for any number of a file; ROUND_HALF_UP takes halves away from zero.
EXACT = Context(prec=20_000)

NUMBER = re.compile(r"[+-]?([0-9]+\.?[0-9]*|\.[0-9]+)([eE][+-]?[0-9]{1,4})?")


@dataclass
class Run:
    """A recording: states q then q̇, and torques, one row per sample."""

    file: str
    sha256: str
    grid: Grid
    states: list
    torques: list
    place: int
    temperatures: list | None = field(default=None)


def read_index(folder):
    """Returns the runs of each suite as (file, place in the order of recording)."""
    path = Path(folder) / "runs.csv"
    header, lines = _table(path)
    for column in ("file", "suite"):
        if column not in header:
            raise BadInput(f"{path}:1: there is no column {column!r}")
    suites = {}
    for number, cells in lines:
        entry = dict(zip(header, cells, strict=True))
        if entry["suite"]:
            suites.setdefault(entry["suite"], []).append((number, entry))
    return {suite: _ordered(path, entries) for suite, entries in suites.items()}


def read_places(folder):
    """Returns the place of each file among the lines of the index, from 0."""
    header, lines = _table(Path(folder) / "runs.csv")
    column = header.index("file")
    return {cells[column]: place for place, (_, cells) in enumerate(lines)}


def _ordered(path, entries):
    """Places of the runs: the column `order`, else `repeat` where it numbers all runs, else the
    order of the lines."""
    files = [entry["file"] for _, entry in entries]
    if any(entry.get("order") for _, entry in entries):
        places = [_place(entry.get("order")) for _, entry in entries]
        if None in places or len(set(places)) < len(places):
            number = entries[0][0]
            raise BadInput(f"{path}:{number}: the orders of this suite are not 1, 2, 3, ...")
        return list(zip(files, places, strict=True))
    places = [_place(entry.get("repeat")) for _, entry in entries]
    if None in places or len(set(places)) < len(places):
        places = range(1, len(files) + 1)
    return list(zip(files, places, strict=True))


def _place(text):
    return int(text) if text and re.fullmatch(r"\+?[0-9]+", text) and int(text) >= 1 else None


def _table(path):
    """Returns the header and the lines, with their numbers, of a CSV file."""
    try:
        with open(path, encoding="utf-8-sig", newline="") as file:
            reader = csv.reader(file)
            lines = [(reader.line_num, [cell.strip() for cell in row]) for row in reader if row]
    except (OSError, ValueError, csv.Error) as error:
        raise BadInput(f"{path}: {error}") from error
    if not lines:
        raise BadInput(f"{path}: the file is empty")
    header = lines[0][1]
    lines = [(number, cells) for number, cells in lines if any(cells)]
    for number, cells in lines[1:]:
        while len(cells) > len(header) and not cells[-1]:
            cells.pop()
        if len(cells) != len(header):
            raise BadInput(f"{path}:{number}: {len(cells)} fields, but {len(header)} in the header")
    return header, lines[1:]


def read_run(folder, file, place, joints, until):
    """Reads one recording; samples later than `until` seconds after the first are left out."""
    path = Path(folder) / file
    header, lines = _table(path)
    names = ["t", *(f"{kind}{j}" for kind in ("q", "qd", "tau") for j in range(1, joints + 1))]
    if header[: len(names)] != names or f"q{joints + 1}" in header:
        raise BadInput(f"{path}:1: the header for {joints} joints would be {','.join(names)}")
    if not lines:
        raise BadInput(f"{path}: there is no sample")
    times, states, torques, temperatures = [], [], [], []
    warm = header.index("temp1") if "temp1" in header else None
    first = None
    for number, cells in lines:
        place_of = f"{path}:{number}"
        now = picoseconds(cells[0], place_of)
        first = now if first is None else first
        values = [_double(cell, place_of) for cell in cells[1 : 1 + 3 * joints]]
        times.append(float(now - first) / 1e12)
        if len(times) > 1 and times[-1] <= times[-2]:
            raise BadInput(f"{place_of}: the time is not later than in the line above")
        states.append(values[: 2 * joints])
        torques.append(values[2 * joints :])
        if warm is not None:
            temperatures.append([_double(x, place_of) for x in cells[warm : warm + joints]])
    # A sample at `until` itself counts, whatever the rounding of its time.
    count = len(times) if until is None else sum(t <= until * (1.0 + 1e-12) for t in times)
    if count == 0:
        raise BadInput(f"{path}: no sample is left before {until} s")
    digest = hashlib.sha256(path.read_bytes()).hexdigest()
    grid = grid_of(times[:count])
    mean = _means(temperatures[:count]) if temperatures else None
    return Run(file, digest, grid, states[:count], torques[:count], place, mean)


def _means(rows):
    return [sum(column) / len(rows) for column in zip(*rows, strict=True)]


def _double(text, place):
    value = float(text) if NUMBER.fullmatch(text) else math.nan
    if not math.isfinite(value):
        raise BadInput(f"{place}: {text!r} is not a finite number")
    return value


def picoseconds(text, place=""):
    """Returns a decimal number of seconds in whole picoseconds, halves away from zero."""
    _double(text, place)
    return int(EXACT.multiply(Decimal(text), PER_SECOND).to_integral_value(ROUND_HALF_UP, EXACT))
