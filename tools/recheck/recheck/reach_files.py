"""The CSV files of `reachtube reach`: each printed bound must be outside the exact one.

Bounds at samples are compared there. Bounds of the tube hold over a whole step and are compared
at both ends of the step; between them nothing is checked.
"""

import csv
from pathlib import Path, PurePosixPath

from .balls import arb, symmetric
from .errors import BadInput
from .hulls import state_name
from .verdict import Tally, of_margin


class ReachFiles:
    """Judges the files of a folder, one for each case."""

    def __init__(self, model, folder, cases):
        self.model = model
        self.files, self.tallies = {}, {}
        for case in cases:
            name, at_samples, tube = read_bounds(model, folder, case)
            self.files[id(case)] = at_samples, tube
            self.tallies[id(case)] = [Tally(f"{name}.csv"), Tally(f"{name}_tube.csv")]

    def start(self, grid):
        """Starts with the samples of a grid."""

    def results(self):
        """Returns the tallies, one for each file."""
        return [tally for pair in self.tallies.values() for tally in pair]

    def visit(self, sample, cases):
        """Judges the bounds at one sample."""
        k = sample.k
        for c, case in enumerate(cases):
            if k >= len(case.grid):
                continue
            at_samples, tube = self.files[id(case)]
            of_samples, of_tube = self.tallies[id(case)]
            for i in range(2 * self.model.joints):
                exact = self._exact(sample, c, i)
                row = at_samples[k]
                self._judge(of_samples, exact, row[3 * i + 1], row[3 * i + 3], f"row {k}", i)
                for step in (k - 1, k):
                    if 0 <= step < len(tube):
                        row = tube[step]
                        place = f"step {step} at sample {k}"
                        self._judge(of_tube, exact, row[2 * i + 2], row[2 * i + 3], place, i)

    def _exact(self, sample, c, i):
        middle = sample.nominal[i, c] + sample.centre[i, 0]
        if sample.doubt is not None:
            middle = middle + symmetric(sample.doubt[i, c])
        return middle - sample.radius[i, 0], middle + sample.radius[i, 0]

    def _judge(self, tally, exact, lower, upper, place, i):
        name = state_name(i, self.model.joints)
        for side, margin in (("lower", exact[0] - arb(lower)), ("upper", arb(upper) - exact[1])):
            tally.add(of_margin(margin), margin, f"{place}, {name}_{side}")


def read_bounds(model, folder, case):
    """Returns the name of a case's files, and their rows: at samples, and of the tube.
    """
    name = _name(case)
    path = Path(folder) / f"{name}.csv"
    columns = [f"{state_name(i, model.joints)}_{kind}"
               for i in range(2 * model.joints) for kind in ("lower", "nominal", "upper")]
    at_samples = _read(path, ["t", *columns], len(case.grid))
    for k, row in enumerate(at_samples):
        if row[0] != case.grid.times[k]:
            raise BadInput(f"{path}:{k + 2}: t is {row[0]}, not {case.grid.times[k]}")
    columns = [name for name in columns if not name.endswith("nominal")]
    path = Path(folder) / f"{name}_tube.csv"
    return name, at_samples, _read(path, ["t_from", "t_to", *columns], len(case.grid) - 1)


def _name(case):
    """The name of a case's files, as `reach` gives it."""
    name = case.suite
    if case.own is not None:
        name += f"_{PurePosixPath(case.own.file).stem}"
    safe = "".join(c if c.isalnum() or c in "-_.+ " else "_" for c in name)
    return "_" + safe[1:] if safe.startswith(".") else safe


def _read(path, header, count):
    try:
        with open(path, encoding="utf-8", newline="") as file:
            rows = list(csv.reader(file))
        if rows[0] != header or any(len(row) != len(header) for row in rows):
            raise BadInput(f"{path}: `reachtube reach` writes other columns")
        values = [[float(x) for x in row] for row in rows[1:]]
    except (OSError, ValueError, IndexError) as error:
        raise BadInput(f"{path}: {error}") from error
    if len(values) != count:
        raise BadInput(f"{path}: it has {len(values)} rows, not {count}")
    return values
