"""Sample times.

The definition is in docs/method.md, section 3: times count since the first sample, to a
picosecond. Where all of them fit k h to a picosecond, t_k is exactly k h for the double h: the
reciprocal of a whole number of hertz, or a number of 12 significant digits. Otherwise t_k is the
double nearest to the recorded time.
"""

import math
from dataclasses import dataclass

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
