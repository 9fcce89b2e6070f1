"""Sample times.

The definition is in docs/method.md, section 3: times count since the first sample, to a
picosecond. Where all of them fit k h to a picosecond, t_k is exactly k h for the double h: the
reciprocal of a whole number of hertz, or a number of 12 significant digits. Otherwise t_k is the
double nearest to the recorded time.
"""

import math
from dataclasses import dataclass
from fractions import Fraction
from itertools import pairwise

from .balls import arb
from .errors import BadInput

PICOSECOND = 1e-12
EPSILON = 2.0**-52


@dataclass(frozen=True)
class Grid:
    """Sample times in s; `step` is h of a uniform grid, and None of any other."""

    times: tuple
    step: float | None

    def __len__(self):
        return len(self.times)

    def span(self, k):
        """Returns the exact time from sample k to the next one."""
        if self.step is not None:
            return arb(self.step)
        return arb(self.times[k + 1]) - arb(self.times[k])

    def is_prefix_of(self, longer):
        """Returns whether the samples are exactly the first ones of `longer`."""
        if len(self) > len(longer):
            return False
        if self.step is not None and longer.step is not None and len(self) > 1:
            return self.step == longer.step
        if (self.step is None) != (longer.step is None) and len(self) > 2:
            return False
        return longer.times[: len(self)] == self.times


def _round(x):
    """Rounds a double that is not negative to a whole number, halves up."""
    whole = math.floor(x)
    return float(whole + (x - whole >= 0.5))


def grid_of(recorded):
    """Returns the grid of times since the first sample, in s."""
    times = [_round((t - recorded[0]) * 1e12) / 1e12 for t in recorded]
    for k in range(1, len(times)):
        if not times[k] > times[k - 1]:
            raise BadInput(f"sample {k} is not a picosecond later than the one before")
    step = _uniform_step(times)
    if step is None:
        return Grid(tuple(times), None)
    return Grid(tuple(k * step for k in range(len(times))), step)


def _uniform_step(times):
    intervals = len(times) - 1
    if intervals < 1:
        return None
    mean = times[-1] / intervals
    rate = _round(1.0 / mean)
    steps = ([1.0 / rate] if rate > 0.0 else []) + [float(f"{mean:.11e}")]
    for step in steps:
        fits = (
            abs(t - k * step) <= PICOSECOND + 2.0 * EPSILON * t for k, t in enumerate(times)
        )
        if step > 0.0 and all(fits):
            return step
    return None


def distinct(grids):
    """Returns the grids that are no beginning of another one, the longest first."""
    found = []
    for grid in sorted(grids, key=lambda grid: (-len(grid), -grid.times[-1])):
        if not any(grid.is_prefix_of(longer) for longer in found):
            found.append(grid)
    return found


def counted(grids):
    """Returns how much each sample counts if the samples at one time together count 1."""
    def place(t):
        return round(t * 1e9)

    counts = {}
    for grid in grids:
        for t in grid.times:
            counts[place(t)] = counts.get(place(t), 0) + 1
    return [[arb(1) / counts[place(t)] for t in grid.times] for grid in grids]


def stood_for(grids):
    """Returns the time that each sample stands for, s.

    A sample stands for the time until halfway to its neighbours; the first and the last for as much
    on their outer side. Grids share the times at which there are several of them. Times are counted
    in half picoseconds.
    """
    lists = [[round(t * 1e12) for t in grid.times] for grid in grids]
    only = min((t[1] - t[0] for t in lists if len(t) > 1), default=10**12)
    cells = [_cells(times, only) for times in lists]
    changes = sorted({edge for edges in cells for edge in (edges[0], edges[-1])})
    counts = [sum(edges[0] <= at < edges[-1] for edges in cells) for at in changes]
    found = []
    for edges in cells:
        times = []
        for begin, end in pairwise(edges):
            parts = (Fraction(min(end, to) - max(begin, at), count)
                     for (at, to), count in zip(pairwise(changes), counts, strict=False)
                     if count and at < end and to > begin)
            time = sum(parts, Fraction(0)) / (2 * 10**12)
            times.append(arb(time.numerator) / time.denominator)
        found.append(times)
    return found


def _cells(times, only):
    """Returns where the cells of samples begin and end, in half picoseconds."""
    gaps = [b - a for a, b in pairwise(times)] or [only]
    between = [a + b for a, b in pairwise(times)]
    return [2 * times[0] - gaps[0], *between, 2 * times[-1] + gaps[-1]]
