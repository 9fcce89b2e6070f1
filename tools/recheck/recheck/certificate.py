"""Exact verdicts: whether the recorded points lie in the reachable set itself, by a certificate.

A certificate is a text file with one JSON object per line. The first is a header:

    {"format": "reachtube-certificate", "version": 1, "notion": "exact", "model_sha256": ".."}

For a measurable disturbance, "parts" says into how many parts each step is cut (1 by default).

Each further line is a point: a recorded sample in the states that are listed, with the vector y
that names its factors (membership.py):

    {"suite": "A", "run": "a.csv", "sample": 7, "states": [0, 1], "y": [.., ..],
     "limit": 0.999999999, "held": 1}

"limit" may stand in the header instead, and "held" is 1 where it is missing.

Notion `exact` needs a point in all states for each recording and sample; `phase-plane` needs one
for each joint in (q, qd). Points at sample 0 lie in a box and need no certificate.
"""

import json

from .balls import arb, symmetric
from .errors import BadInput
from .generators import Generators
from .hulls import state_name
from .membership import Projection, Recipe
from .verdict import Tally, Verdict, of_margin


class Certificate:
    """Judges the points of a certificate, and counts the points that it does not have."""

    def __init__(self, model, system, path, every, cases):
        self.model, self.system, self.path, self.every = model, system, path, every
        self.lines, self.notes = {}, []
        self._read_lines(path)
        suites = sorted({case.suite for case in cases})
        self.tallies = {suite: Tally(f"suite {suite}") for suite in suites}
        self.generators = None
        if model.settings["disturbance"] == "measurable":
            self.notes.append("points are judged for disturbances that are held over samples, or "
                              "parts of them, which are some of the measurable ones")

    def _read_lines(self, path):
        """Reads the header, and where the points of each sample are."""
        try:
            with open(path, "rb") as file:
                self._header(json.loads(file.readline()))
                at = file.tell()
                for line in file:
                    point = json.loads(line)
                    key = point["suite"], point["sample"]
                    self.lines.setdefault(key, []).append(at)
                    at += len(line)
        except (OSError, ValueError, KeyError, TypeError, RecursionError) as error:
            raise BadInput(f"{path}: {error!r}; give a file of `conform --certificate`") from error

    def _header(self, header):
        if (header["format"], header["version"]) != ("reachtube-certificate", 1):
            raise BadInput(f"{self.path}:1: it is no certificate of version 1")
        n, notion = self.model.joints, header["notion"]
        self.notion = notion
        if notion == "exact":
            self.projections = [tuple(range(self.model.states))]
        elif notion == "phase-plane":
            self.projections = [(i, n + i) for i in range(n)]
        else:
            raise BadInput(f"{self.path}:1: the notion is {notion!r}, not exact or phase-plane")
        self.limit, self.parts = header.get("limit"), header.get("parts", 1)
        if not (isinstance(self.parts, int) and self.parts >= 1):
            raise BadInput(f"{self.path}:1: parts is {self.parts!r}, not a whole number from 1")
        if self.parts != 1 and self.model.settings["disturbance"] != "measurable":
            raise BadInput(f"{self.path}:1: only a measurable disturbance may change within a step")
        if header["model_sha256"] != self.model.sha256:
            self.notes.append("the certificate was made for another model file")

    def start(self, grid):
        """Starts with the samples of a grid."""
        self.generators = Generators(self.model, self.system, grid, self.parts)

    def results(self):
        """Returns the tallies, one for each suite."""
        return self.tallies.values()

    def visit(self, sample, cases):
        """Judges the points at one sample of the cases on one grid."""
        if sample.k % self.every == 0:
            found = self._box(sample, cases) if sample.k == 0 else self._points(sample, cases)
            for case in cases:
                for run in case.runs:
                    if sample.k < len(run.grid):
                        self._count(sample, case.suite, run, found)
        self.generators.advance(sample)

    def _count(self, sample, suite, run, found):
        for states in self.projections:
            missing = Verdict.UNDECIDED, float("inf")
            verdict, excess = found.get((suite, run.file, states), missing)
            names = ",".join(state_name(i, self.model.joints) for i in states)
            place = f"{run.file}, sample {sample.k} at {run.grid.times[sample.k]:.6g} s, {names}"
            self.tallies[suite].add(verdict, -arb(excess), place)

    def _deviation(self, sample, c, run, i):
        """The recorded value less the centre of the reachable set."""
        value = arb(run.states[sample.k][i]) - sample.nominal[i, c] - sample.centre[i, 0]
        return value + symmetric(sample.doubt[i, c]) if sample.doubt is not None else value

    def _box(self, sample, cases):
        """Judges the points at the first sample, where the set is X0 with V."""
        found = {}
        for c, case in enumerate(cases):
            for run in case.runs:
                for states in self.projections:
                    margins = [
                        sample.radius[i, 0] + arb(self.model.noise_radius[i])
                        - abs(self._deviation(sample, c, run, i))
                        for i in states
                    ]
                    verdicts = [(of_margin(m), float(-m)) for m in margins]
                    found[case.suite, run.file, states] = max(verdicts)
        return found

    def _points(self, sample, cases):
        """Judges the points of the certificate at one sample."""
        runs = {
            (case.suite, run.file): (c, run)
            for c, case in enumerate(cases) for run in case.runs if sample.k < len(run.grid)
        }
        by_states = {}
        with open(self.path, "rb") as file:
            for suite in sorted({suite for suite, _ in runs}):
                for at in self.lines.get((suite, sample.k), []):
                    file.seek(at)
                    self._take(sample, json.loads(file.readline()), runs, by_states)
        found = {}
        for states, points in by_states.items():
            projection = Projection(self.generators, sample, list(states))
            judged = projection.judge([point for _, point in points])
            for (key, _), verdict in zip(points, judged, strict=True):
                found[key] = min(found.get(key, verdict), verdict)
        return found

    def _take(self, sample, point, runs, by_states):
        """Adds a point of these runs to the points with the same states."""
        try:
            suite, file, states = point["suite"], point["run"], tuple(point["states"])
            y, held = [float(x) for x in point["y"]], point.get("held", 1)
            recipe = Recipe(y, float(point.get("limit", self.limit)), held)
            if not (0.0 < recipe.limit <= 1.0 and isinstance(held, int) and held >= 1):
                raise ValueError("limit or held is out of range")
        except (KeyError, TypeError, ValueError, OverflowError) as error:
            raise BadInput(f"{self.path}: a point at sample {sample.k}: {error!r}") from error
        if (suite, file) in runs and states in self.projections and len(y) == len(states):
            c, run = runs[suite, file]
            deviation = [self._deviation(sample, c, run, i) for i in states]
            by_states.setdefault(states, []).append(((suite, file, states), (deviation, recipe)))
