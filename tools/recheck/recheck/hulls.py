"""Rows: whether every recorded value lies in the interval hull of the reachable set, with V."""

from .balls import arb, symmetric
from .verdict import Tally, Verdict, of_margin


def state_name(i, joints):
    """Returns the column of a recording that holds state `i`."""
    return f"q{i + 1}" if i < joints else f"qd{i - joints + 1}"


class HullRows:
    """Judges the rows of a model. A row is a suite at one sample of one grid in one state, both
    sides; it is as good as the worst of its recordings."""

    def __init__(self, model, cases):
        self.model = model
        self.extremes = {id(case): extremes(case) for case in cases}
        self.tallies = {}

    def start(self, grid):
        """Starts with the samples of a grid."""

    def results(self):
        """Returns the tallies, one for each suite."""
        return self.tallies.values()

    def visit(self, sample, cases):
        """Judges the rows at one sample of the cases on one grid."""
        rows = {}
        for c, case in enumerate(cases):
            if sample.k < len(case.grid):
                for i in range(self.model.states):
                    found = self._row(sample, c, case, i)
                    key = (case.suite, i)
                    rows[key] = max(rows.get(key, found), found, key=lambda row: row[0])
        for (suite, _), (verdict, margin, place) in rows.items():
            tally = self.tallies.setdefault(suite, Tally(f"suite {suite}"))
            tally.add(verdict, margin, place)

    def _row(self, sample, c, case, i):
        """Judges both sides of one case in one state."""
        k = sample.k
        (low, low_run), (high, high_run) = self.extremes[id(case)][k][i]
        middle = sample.nominal[i, c] + sample.centre[i, 0]
        if sample.doubt is not None:
            middle = middle + symmetric(sample.doubt[i, c])
        reach = sample.radius[i, 0] + arb(self.model.noise_radius[i])
        sides = (
            (middle + reach - arb(high), "above", high_run),
            (arb(low) - (middle - reach), "below", low_run),
        )
        judged = [(of_margin(margin), margin, side, run) for margin, side, run in sides]
        verdict, margin, side, run = max(judged, key=lambda found: found[0])
        if verdict is Verdict.HOLDS:
            return verdict, None, ""
        name = state_name(i, self.model.joints)
        return verdict, margin, f"{run}, sample {k} at {case.grid.times[k]:.6g} s, {name} {side}"


def extremes(case):
    """Returns the lowest and highest value of a case's runs, with their files, by sample and
    state."""
    longest = len(case.grid)
    found = [[] for _ in range(longest)]
    for k in range(longest):
        alive = [(run.states[k], run.file) for run in case.runs if k < len(run.grid)]
        for i in range(len(alive[0][0])):
            values = [(states[i], file) for states, file in alive]
            found[k].append((min(values), max(values)))
    return found
