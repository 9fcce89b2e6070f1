"""The files of `reachtube reach`: each printed bound must be outside the exact one.

`reach.json` names the model, the settings, the recordings and the CSV files by digest. Files of
another model, of other recordings or with a changed byte are refused.

Bounds at samples are compared there. Bounds of the tube hold over a whole step and are compared
at both ends of the step; between them nothing is checked.
"""

import csv
import hashlib
import json
import math
from pathlib import Path, PurePosixPath

from .balls import arb, symmetric
from .errors import BadInput
from .hulls import state_name
from .verdict import Tally, Verdict, of_margin


class PrintedBounds:
    """The bounds that were printed for a case, with their tallies: at samples, and of the tube."""

    def __init__(self, model, folder, case):
        self.model = model
        name, self.at_samples, self.tube = read_bounds(model, folder, case)
        self.tallies = [Tally(f"{name}.csv"), Tally(f"{name}_tube.csv")]

    def rows(self, k):
        """Yields what was printed for the states at sample k: tally, place, and all bounds."""
        yield self.tallies[0], f"row {k}", list(
            zip(self.at_samples[k][1::3], self.at_samples[k][3::3], strict=True))
        for step in (k - 1, k):
            if 0 <= step < len(self.tube):
                row = self.tube[step]
                yield self.tallies[1], f"step {step} at sample {k}", list(
                    zip(row[2::2], row[3::2], strict=True))

    def visit(self, k, hull):
        """Judges the bounds at one sample by a hull from outside and inside (flowpipe.py): a bound
        fails if a motion is beyond it, and holds if no motion is."""
        for tally, place, bounds in self.rows(k):
            for i, (lower, upper) in enumerate(bounds):
                for side, value, sign in (("lower", lower, -1), ("upper", upper, 1)):
                    where = f"{place}, {state_name(i, self.model.joints)}_{side}"
                    if hull is None:
                        tally.add(Verdict.UNDECIDED, None, where)
                        continue
                    room = sign * (arb(value) - hull.centre[i])
                    margin, inside = room - hull.outer[i], room - hull.inner[i]
                    if margin >= 0:
                        tally.add(Verdict.HOLDS)
                    elif inside < 0:
                        tally.add(Verdict.FAILS, inside, where)
                    else:
                        tally.add(Verdict.UNDECIDED, margin, where)


class ReachFiles:
    """Judges the files of a folder, one for each case of a linear model."""

    def __init__(self, model, folder, cases):
        self.model = model
        self.printed = {id(case): PrintedBounds(model, folder, case) for case in cases}

    def start(self, grid):
        """Starts with the samples of a grid."""

    def results(self):
        """Returns the tallies, one for each file."""
        return [tally for printed in self.printed.values() for tally in printed.tallies]

    def visit(self, sample, cases):
        """Judges the bounds at one sample."""
        for c, case in enumerate(cases):
            if sample.k >= len(case.grid):
                continue
            exact = [self._exact(sample, c, i) for i in range(2 * self.model.joints)]
            for tally, place, bounds in self.printed[id(case)].rows(sample.k):
                for i, ((lower, upper), (low, high)) in enumerate(zip(bounds, exact, strict=True)):
                    name = state_name(i, self.model.joints)
                    for side, margin in (("lower", low - arb(lower)), ("upper", arb(upper) - high)):
                        tally.add(of_margin(margin), margin, f"{place}, {name}_{side}")

    def _exact(self, sample, c, i):
        middle = sample.nominal[i, c] + sample.centre[i, 0]
        if sample.doubt is not None:
            middle = middle + symmetric(sample.doubt[i, c])
        return middle - sample.radius[i, 0], middle + sample.radius[i, 0]


def check_record(model, folder, cases):
    """Refuses a folder whose `reach.json` names another model or other recordings."""
    path = Path(folder) / "reach.json"
    try:
        record = json.loads(path.read_text(encoding="utf-8"))
        if (record["format"], record["version"]) != ("reachtube-reach", 1):
            raise BadInput(f"{path}: it is no record of version 1; run `reachtube reach` again")
        suites = record["data"]["suites"]
        listed = {(suite["name"], run["file"]): run["sha256"]
                  for suite in suites for run in suite.get("runs", [])}
        counted = {suite["name"] for suite in suites if "run_count" in suite}
        is_own = record["model_sha256"] == model.digest
    except (OSError, ValueError, KeyError, TypeError, AttributeError, RecursionError) as error:
        raise BadInput(
            f"{path}: {error!r}; run `reachtube reach` again, which writes this record"
        ) from error
    if not is_own:
        raise BadInput(f"{path}: the files are of another model; run `reachtube reach` again")
    for case in cases:
        for run in case.runs:
            known = listed.get((case.suite, run.file))
            if known != run.sha256 and case.suite not in counted:
                raise BadInput(
                    f"{path}: the files are of other recordings: {run.file} of suite {case.suite} "
                    f"differs or is missing; run `reachtube reach` again"
                )


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


def _check_digest(path, content):
    """Refuses a file whose digest differs from that in the record beside it."""
    record = json.loads((path.parent / "reach.json").read_text(encoding="utf-8"))
    known = {entry["file"]: entry["sha256"] for entry in record["files"]}
    if known.get(path.name) != hashlib.sha256(content).hexdigest():
        raise BadInput(f"{path}: the file differs from the one that reach.json names")


def _read(path, header, count):
    try:
        content = path.read_bytes()
        _check_digest(path, content)
        rows = list(csv.reader(content.decode("utf-8").splitlines()))
        if rows[0] != header or any(len(row) != len(header) for row in rows):
            raise BadInput(f"{path}: `reachtube reach` writes other columns")
        values = [[float(x) for x in row] for row in rows[1:]]
    except (OSError, ValueError, IndexError, KeyError, TypeError) as error:
        raise BadInput(f"{path}: {error}") from error
    if len(values) != count:
        raise BadInput(f"{path}: it has {len(values)} rows, not {count}")
    if not all(math.isfinite(x) for row in values for x in row):
        raise BadInput(f"{path}: it has a number that is not finite")
    return values
