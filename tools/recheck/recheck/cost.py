"""What the model file says of its sets: their cost, and that no sets cost less.

The cost is the width of the reachable set with V, weighted, summed over states and integrated over
time: each sample counts the time that it stands for (docs/method.md, section 5). The paper's sum
counts each distinct sample time as 1. Both are computed again here. A file without
`cost_of_samples` is of an older version: all of its costs are such sums.

That no sets cost less is proved by weak duality. The program is: least w r, for centres c, radii
r >= 0 and rows E c + R r >= b. Multipliers y >= 0 of the rows are searched in doubles, among the
rows that touch (search.py); nothing rests on how they were found. In balls then, for any sets that
satisfy the rows and cost at most C,

    w r >= b y - |E' y| |c| - max(0, R' y - w) r,   r <= C / w

and |c| <= |F^-1| (R r + |d|) for any rows F of E that can be inverted: deviations d on both sides
keep F c within R r of them.
"""

from dataclasses import dataclass

import numpy

from .balls import arb, arb_mat, column, down, magnitudes, symmetric
from .grid import counted, distinct, stood_for
from .hulls import extremes, state_name
from .search import independent_rows, multipliers
from .verdict import Tally, Verdict

# Rows that come this close to the reachable set, in parts of its radius, may have a multiplier.
NEAR = 1e-6
# Costs that differ by this part of themselves are equal: the solver's sums are doubles.
EQUAL = 1e-9
# Radii that cost less than this part of the whole count as 0 in the search for multipliers.
NEGLIGIBLE = 1e-9


@dataclass(frozen=True)
class Row:
    """A row of the program: entries of the centres, of the radii, and the right-hand side."""

    of_centre: list
    of_radius: list
    bound: arb


class Costs:
    """Sums what the sets cost, and keeps the rows that decide."""

    def __init__(self, model, cases):
        self.model, n = model, model.joints
        self.extremes = {id(case): extremes(case) for case in cases}
        grids = distinct([case.grid for case in cases])
        self.is_by_time = model.stated["cost_of_samples"] is not None
        self.shares = {id(grid): share for grid, share in zip(grids, counted(grids), strict=True)}
        self.times = self.shares
        if self.is_by_time:
            self.times = {id(grid): t for grid, t in zip(grids, stood_for(grids), strict=True)}
        self.grid = None
        self.sums, self.sums_of_samples = arb_mat(2 * n, 3 * n), arb_mat(2 * n, 3 * n)
        self.samples, self.count = arb(0), arb(0)
        self.largest = [0.0] * (2 * n)
        self.is_free = model.settings.get("noise", "none") == "fitted"
        self.rows, self.anchors, self.starts = [], [], [0.0] * (2 * n)
        self.facts = []

    def start(self, grid):
        """Starts with the samples of a grid."""
        self.grid = grid

    def results(self):
        """Returns the tally of what the file says."""
        return [self._judged()] if self.model.stated["cost"] is not None else []

    def visit(self, sample, cases):
        """Adds the widths at one sample, and the rows that touch."""
        time, share = (of[id(self.grid)][sample.k] for of in (self.times, self.shares))
        n, e = self.model.joints, sample.e
        gains = arb_mat([[*map(abs, a), *k] for a, k in
                         zip(e.tolist(), sample.gain.tolist(), strict=True)])
        self.sums = self.sums + gains * (2 * time)
        self.samples = self.samples + time
        self.sums_of_samples = self.sums_of_samples + gains * (2 * share)
        self.count = self.count + share
        radii = column([*self.model.initial_set.radius, *self.model.input_set.radius])
        reach = gains * radii
        is_anchor = sample.k in {0, *(len(self.grid) * part // 4 for part in (1, 2, 3)),
                                 len(self.grid) - 1}
        for c, case in enumerate(cases):
            if sample.k < len(case.grid):
                for i in range(2 * n):
                    self._add(sample, c, case, i, (gains, reach), is_anchor)

    def _add(self, sample, c, case, i, reached, is_anchor):
        """Adds both sides of a row of a case in one state."""
        (gains, reach), n = reached, self.model.joints
        (low, _), (high, _) = self.extremes[id(case)][sample.k][i]
        doubt = symmetric(sample.doubt[i, c]) if sample.doubt is not None else arb(0)
        nominal = sample.nominal[i, c] + doubt
        upper, lower = arb(high) - nominal, arb(low) - nominal
        self.largest[i] = max(self.largest[i], float(upper), -float(lower))
        if sample.k == 0:
            self.starts[i] = max(self.starts[i], abs(float(upper)), abs(float(lower)))
        if i >= self.model.states:
            return
        noise = arb(self.model.noise_radius[i])
        whole = reach[i, 0] + noise
        for sign, bound in ((1, upper), (-1, -lower)):
            slack = sign * sample.centre[i, 0] + whole - bound
            is_near = slack < NEAR * whole + arb(2) ** -60
            if not (is_near or is_anchor):
                continue
            centre = [sign * x for x in (*_row(sample.e, i), *_row(sample.gamma, i))]
            radius = _row(gains, i)
            radius += [arb(int(i == j)) for j in range(2 * n)] if self.is_free else []
            row = Row(centre, radius, bound if self.is_free else bound - noise)
            (self.rows if is_near else self.anchors).append(row)

    def _judged(self):
        """Judges the cost, the bound and the gap that the file states."""
        tally, stated = Tally("stated cost"), self.model.stated
        weights, per_radius = self._weights()
        cost = sum((w * arb(r) for w, r in zip(per_radius, self._radii(), strict=True)), arb(0))
        if not self.is_free:
            cost = cost + self._noise_cost(weights)
        room = EQUAL * cost + EQUAL * self.samples * sum(weights)
        off = abs(cost - arb(stated["cost"]))
        tally.add(*_closer(room - off), f"cost {stated['cost']:.10g}, and {float(cost):.10g} here")
        self.facts.append(f"the sets cost {float(cost):.10g}")
        if self.is_by_time:
            self._judge_sum(tally, weights)
        lower, gap = stated["cost_lower_bound"], stated["optimality_gap"]
        if lower is None or stated["calibration"]:
            return tally
        if self.model.settings.get("notion", "hull") != "hull":
            self.facts.append("the lower bound of the cost is judged for the notion hull only")
            return tally
        proved = self._lower_bound(weights, per_radius, cost)
        self.facts.append(f"no sets that enclose the recordings cost less than {down(proved):.10g}")
        place = f"lower bound {lower:.10g}, and {down(proved):.10g} is proved here"
        missing = proved + room - arb(lower)
        if missing >= 0:
            tally.add(Verdict.HOLDS)
        else:
            verdict = Verdict.FAILS if cost + room < arb(lower) else Verdict.UNDECIDED
            tally.add(verdict, missing, place)
        if gap is not None:
            apart = (abs(cost - arb(lower)) - room) / arb(max(abs(lower), 1e-300))
            tally.add(*_closer(arb(gap) + EQUAL - apart), f"gap {gap:.3g}")
        return tally

    def _judge_sum(self, tally, weights):
        """Judges the paper's sum that the file states."""
        stated = self.model.stated["cost_of_samples"]
        radii = [*self.model.initial_set.radius, *self.model.input_set.radius]
        per_radius = (arb_mat(1, len(weights), weights) * self.sums_of_samples).entries()
        found = sum((w * arb(r) for w, r in zip(per_radius, radii, strict=True)), arb(0))
        found += sum((2 * self.count * w * arb(r)
                      for w, r in zip(weights, self.model.noise_radius, strict=True)), arb(0))
        room = EQUAL * found + EQUAL * self.count * sum(weights)
        place = f"sum over samples {stated:.10g}, and {float(found):.10g} here"
        tally.add(*_closer(room - abs(found - arb(stated))), place)
        self.facts.append(f"summed over samples, as in the paper, {float(found):.10g}")

    def _weights(self):
        """The weight of each state, and the cost of each radius."""
        kind, n = self.model.settings.get("weights", "unit"), self.model.joints
        if kind == "unit":
            weights = [arb(1)] * (2 * n)
        else:
            weights = [arb(float(x)) for x in kind["given"]]
        of_sets = arb_mat(1, 2 * n, weights) * self.sums
        noise = [2 * self.samples * w for w in weights] if self.is_free else []
        return weights, [*of_sets.entries(), *noise]

    def _radii(self):
        noise = self.model.noise_radius if self.is_free else ()
        return [*self.model.initial_set.radius, *self.model.input_set.radius, *noise]

    def _noise_cost(self, weights):
        radii = zip(weights, self.model.noise_radius, strict=True)
        return sum((2 * self.samples * w * arb(r) for w, r in radii), arb(0))

    def _limits(self):
        """The rows that limit centres and radii besides the recordings."""
        settings, n, stated = self.model.settings, self.model.joints, self.model.stated
        width, found = len(self._radii()), []
        sensor = (stated["sensor_noise"] or {}).get("radius")

        def unit(j, size, value):
            return [arb(value) if j == i else arb(0) for i in range(size)]

        if settings["centre"] == "origin":
            found += [Row(unit(j, 3 * n, s), unit(j, width, 1), arb(0))
                      for j in range(3 * n) for s in (1, -1)]
        limited = {"positions": n, "states": 2 * n}.get(settings.get("initial_limit"), 0)
        starts = [x * (1.0 + 1e-6) + 1e-9 for x in self.starts[:limited]]
        if settings["nominal"] == "own":
            starts = [max(x, 1e-9) for x in sensor or []]
        found += [Row(unit(j, 3 * n, s), unit(j, width, -1), -arb(limit))
                  for j, limit in enumerate(starts) for s in (1, -1)]
        if self.is_free:
            found += [Row([arb(0)] * (3 * n), unit(3 * n + i, width, -1), -arb(max(limit, 1e-9)))
                      for i, limit in enumerate(sensor or [])]
        return found

    def _lower_bound(self, weights, per_radius, cost):
        """Returns a proved lower bound of the cost, by weak duality."""
        rows = self.rows + self._limits()
        if not rows:
            return arb(0)
        has_centres = self.model.settings["centre"] != "zero"
        of_centre, of_radius = (
            numpy.array([[float(x) for x in getattr(row, name)] for row in rows])
            for name in ("of_centre", "of_radius")
        )
        prices, radii = numpy.array([float(w) for w in per_radius]), numpy.array(self._radii())
        unused = prices * radii <= NEGLIGIBLE * float(cost)
        y = multipliers(of_centre if has_centres else of_centre[:, :0], of_radius, prices, unused)
        used = [(arb(float(a)), row) for a, row in zip(y, rows, strict=True) if a > 0.0]
        fixed = arb(0) if self.is_free else self._noise_cost(weights)
        total = sum((a * row.bound for a, row in used), arb(0))
        most = [cost / w for w in per_radius]
        for j, (price, limit) in enumerate(zip(per_radius, most, strict=True)):
            spare = price - sum((a * row.of_radius[j] for a, row in used), arb(0))
            if not spare >= 0:
                total = total - arb(spare.abs_upper()) * limit
        if has_centres:
            furthest = self._furthest_centres(most)
            for j, far in enumerate(furthest):
                rest = sum((a * row.of_centre[j] for a, row in used), arb(0))
                total = total - abs(rest) * far
        return max((total + fixed).lower(), arb(0)) if total.is_finite() else arb(0)

    def _furthest_centres(self, most):
        """Bounds |c| of all sets that cost at most as much as these."""
        rows = [*self.anchors, *self.rows]
        picked = independent_rows([[float(x) for x in row.of_centre] for row in rows])
        width = len(rows[0].of_centre)
        if len(picked) < width:
            return [arb("inf")] * width
        rows = [rows[at] for at in picked]
        deviations = self._largest_deviation()
        far = [sum((abs(a) * m for a, m in zip(row.of_radius, most, strict=True)), deviations)
               for row in rows]
        inverse = arb_mat([row.of_centre for row in rows]).inv()
        return (magnitudes(inverse) * column(far)).entries()

    def _largest_deviation(self):
        noise = max(self.model.noise_radius, default=0.0)
        return arb(max(self.largest)) * (1 + arb(EQUAL)) + arb(noise)


def _closer(margin):
    """The verdict on a comparison of rounded numbers, with its margin."""
    return (Verdict.HOLDS if margin >= 0 else Verdict.FAILS), margin


def _row(m, i):
    width, entries = m.ncols(), m.entries()
    return entries[i * width : (i + 1) * width]
