"""Exact verdicts: whether the recorded points lie in the reachable set itself, by a certificate.

A certificate is a text file with one JSON object per line. The first is a header:

    {"format": "reachtube-certificate", "version": 1, "notion": "exact", "model_digest": ".."}

Each further line is a group of points at one sample of a suite, in the states that are listed:

    {"suite": "A", "sample": 7, "states": [0, 1], "directions": [[..], ..],
     "points": [{"file": "a.csv", "weights": [..]}, ..]}

Notion `exact` needs a point in all states for each recording and sample; `phase-plane` needs one
for each joint in (q, qd). Points at sample 0 lie in a box and need no certificate.
"""

import json

from .balls import arb, symmetric
from .errors import BadInput
from .generators import Generators
from .hulls import state_name
from .membership import Projection
from .verdict import Tally, Verdict, of_margin


class Certificate:
    """Judges the points of a certificate, and misses those that it does not have."""

    def __init__(self, model, system, path, every, cases):
        self.model, self.system, self.path, self.every = model, system, path, every
        self.groups, self.notes = {}, []
        self._read_lines(path)
        suites = sorted({case.suite for case in cases})
        self.tallies = {suite: Tally(f"suite {suite}") for suite in suites}
        self.generators = None
        # A measurable disturbance reaches more than one that is held over samples.
        self.is_whole = model.settings["disturbance"] != "measurable"
        if not self.is_whole:
            self.notes.append("points are judged for disturbances that are held over samples, "
                              "which are some of the measurable ones")

    def _read_lines(self, path):
        """Reads the header, and where the groups of each sample start."""
        try:
            with open(path, "rb") as file:
                self._header(json.loads(file.readline()))
                at = file.tell()
                for line in file:
                    group = json.loads(line)
                    key = group["suite"], group["sample"]
                    self.groups.setdefault(key, []).append(at)
                    at += len(line)
        except (OSError, ValueError, KeyError, TypeError) as error:
            raise BadInput(f"{path}: {error!r}; give a file of `conform --certificate`") from error

    def _header(self, header):
        if (header["format"], header["version"]) != ("reachtube-certificate", 1):
            raise BadInput(f"{self.path}:1: it is no certificate of version 1")
        n, notion = self.model.joints, header["notion"]
        if notion == "exact":
            self.projections = [tuple(range(self.model.states))]
        elif notion == "phase-plane":
            self.projections = [(i, n + i) for i in range(n)]
        else:
            raise BadInput(f"{self.path}:1: the notion is {notion!r}, not exact or phase-plane")
        if header["model_digest"] != self.model.sha256:
            self.notes.append("the certificate was made for another model file")

    def start(self, grid):
        """Starts with the samples of a grid."""
        self.generators = Generators(self.model, self.system, grid)

    def results(self):
        """Returns the tallies, one for each suite."""
        return self.tallies.values()

    def visit(self, sample, cases):
        """Judges the points at one sample of the cases on one grid."""
        if sample.k % self.every == 0:
            found = self._box(sample, cases) if sample.k == 0 else self._groups(sample, cases)
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

    def _groups(self, sample, cases):
        """Judges the points of the groups at one sample."""
        runs = {
            (case.suite, run.file): (c, run)
            for c, case in enumerate(cases) for run in case.runs if sample.k < len(run.grid)
        }
        places = {at for suite, _ in runs for at in self.groups.get((suite, sample.k), [])}
        if not places:
            return {}
        found, parts = {}, self.generators.at(sample)
        with open(self.path, "rb") as file:
            for at in sorted(places):
                file.seek(at)
                self._group(sample, json.loads(file.readline()), runs, parts, found)
        return found

    def _group(self, sample, group, runs, parts, found):
        try:
            states = tuple(group["states"])
            points = [
                (point["file"], point["weights"]) for point in group["points"]
                if (group["suite"], point["file"]) in runs
            ]
            if states not in self.projections or not points:
                return
            projection = Projection(parts, list(states), group["directions"], self.is_whole)
            deviations = []
            for file, weights in points:
                c, run = runs[group["suite"], file]
                deviation = [self._deviation(sample, c, run, i) for i in states]
                deviations.append((deviation, weights))
            judged = projection.judge(deviations)
        except (KeyError, TypeError, ValueError) as error:
            place = f"{self.path}: sample {sample.k} of suite {group.get('suite')}"
            raise BadInput(f"{place}: {error!r}") from error
        for (file, _), verdict in zip(points, judged, strict=True):
            key = group["suite"], file, states
            found[key] = min(found.get(key, verdict), verdict)
