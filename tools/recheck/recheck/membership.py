"""Whether a point is a combination of generators with factors in [-1, 1].

A certificate names factors alpha_j = clip(g_j' y, -limit, limit) by a vector y, so that d = G alpha
+ e with a small rest e, for the point d less the centre of the set. Steps of the disturbance may
share their factors: `held` steps, counted back from the sample, whose generators are then added up
in g_j. The proof takes all generators one by one in any case. For any W with G W near 1,
e = G delta with delta = W (G W)^-1 e. The point is in the set if |alpha_j + delta_j| <= 1 for every
generator j.

All this is in doubles with bounds of their rounding: a product of p terms is off by at most
p u / (1 - p u) times the product of the magnitudes, in any order of summation, with u = 2^-53.
Where such bounds do not settle a point, its rest is computed again without rounding, and put where
the factors have room.
"""

from dataclasses import dataclass

import numpy

from .balls import arb
from .generators import BITS, QUANTUM
from .verdict import Verdict

# Twice the unit of rounding, so that the bounds of rounding are rounded up with room to spare.
UNIT = 2.0**-52
# Bound of what the entries of generators are off besides their rounding to doubles.
TINY = 2.0 ** (1 - QUANTUM)
# How often factors are corrected in doubles.
CORRECTIONS = 6


@dataclass(frozen=True)
class Recipe:
    """What a certificate says about the factors of a point."""

    y: list
    limit: float
    held: int = 1


class Projection:
    """The generators of one sample in some states, with what all points share."""

    def __init__(self, generators, sample, states):
        self.parts, self.states = generators.at(sample), states
        self.is_whole = generators.is_whole
        of_parts = [part.rounded(states) for part in self.parts]
        self.start, self.ages = of_parts[0].shape[1], generators.ages()
        self.g = numpy.concatenate(of_parts, axis=1)
        self.sizes = numpy.abs(self.g)
        sums = self.sizes.sum(axis=1)
        self.scale = numpy.where(sums > 0.0, 1.0 / numpy.where(sums > 0.0, sums, 1.0), 0.0)
        self.uniform = _Inverse(self.g, self.scale, numpy.ones(self.g.shape[1]))

    def judge(self, points):
        """Judges points: each is d in balls, with its recipe. Returns verdicts, and what is
        missing, in parts of a factor."""
        alpha = numpy.empty((self.g.shape[1], len(points)))
        for held in {recipe.held for _, recipe in points}:
            alike = [p for p, (_, recipe) in enumerate(points) if recipe.held == held]
            alpha[:, alike] = self._factors([points[p][1] for p in alike], held)
        middle = numpy.array([[float(x) for x in d] for d, _ in points]).T
        radius = numpy.array([[_up(x - float(x)) for x in d] for d, _ in points]).T
        rest = middle - self.g @ alpha
        terms = self.g.shape[1] + 8
        error = terms * UNIT * (self.sizes @ numpy.abs(alpha)) + 4.0 * UNIT * numpy.abs(middle)
        error = 1.01 * (error + radius) + TINY * self.g.shape[1]
        slack = numpy.array([1.0 - recipe.limit for _, recipe in points])
        missing = self.uniform.factors(rest, error).max(axis=0) - slack
        judged = []
        for p, (d, recipe) in enumerate(points):
            short = float(missing[p])
            if not short <= 0.0:
                short = self._closely(d, alpha[:, p], recipe.limit)
            if short <= 0.0:
                judged.append((Verdict.HOLDS, 0.0))
            elif self.is_whole and self._is_outside(d, numpy.array(recipe.y), rest[:, p]):
                judged.append((Verdict.FAILS, short))
            else:
                judged.append((Verdict.UNDECIDED, short))
        return judged

    def _factors(self, recipes, held):
        """Returns the factors that recipes name, with `held` steps that share theirs."""
        ys = numpy.array([recipe.y for recipe in recipes], dtype=float)
        limits = numpy.array([recipe.limit for recipe in recipes])
        products = self.g.T @ ys.T
        groups = self.ages // held
        if held > 1:
            of_inputs = products[self.start : self.start + groups.size]
            sums = numpy.zeros((groups.max(initial=0) + 1, groups.shape[1], len(recipes)))
            shaped = of_inputs.reshape(*groups.shape, -1)
            numpy.add.at(sums, groups[:, 0], shaped)
            of_inputs[:] = sums[groups[:, 0]].reshape(of_inputs.shape)
        return _clip(products, limits)

    def _closely(self, d, alpha, limit):
        """Judges one point with rests that are known without rounding, and corrects factors in
        between."""
        missing = numpy.inf
        for _ in range(CORRECTIONS):
            alpha = numpy.round(alpha * 2.0**BITS) / 2.0**BITS
            rest = [x - y for x, y in zip(d, self._product(alpha), strict=True)]
            missing = min(missing, self._absorb(rest, 1.0 - numpy.abs(alpha)))
            if missing <= 0.0:
                break
            alpha = _clip(alpha + self._correction(rest, alpha, limit), limit)
        return missing

    def _product(self, alpha):
        """Returns G alpha in balls, for factors that are multiples of 2^-BITS."""
        total, first = [arb(0)] * len(self.states), 0
        for part in self.parts:
            own = part.combination(self.states, alpha[first : first + part.count])
            first += part.count
            total = [x + y for x, y in zip(total, own, strict=True)]
        return total

    def _correction(self, rest, alpha, limit):
        """Returns changes of least norm that give the rest, of the factors that are not at the
        limit or would leave it inward. This is a search, and proves nothing."""
        scaled, found = self.g * self.scale[:, None], numpy.zeros(len(alpha))
        wanted = numpy.array([float(x) for x in rest]) * self.scale
        if not (numpy.isfinite(wanted).all() and numpy.isfinite(self.uniform.w).all()):
            return found
        inward = alpha * (self.uniform.w @ wanted) < 0.0
        is_free = inward | (numpy.abs(alpha) < limit)
        if is_free.any():
            found[is_free] = numpy.linalg.lstsq(scaled[:, is_free], wanted, rcond=None)[0]
        return found

    def _absorb(self, rest, room):
        """Returns what is missing for a rest, in balls, to go where the factors have this room."""
        middle = numpy.array([[float(x)] for x in rest])
        error = numpy.array([[_up(x - float(x))] for x in rest])
        missing = numpy.inf
        for power in (0, 1, 2):
            weighted = _Inverse(self.g, self.scale, room**power) if power else self.uniform
            delta = weighted.factors(middle, error)
            missing = min(missing, float((delta[:, 0] - room).max()))
            if missing <= 0.0:
                break
        return missing

    def _is_outside(self, d, y, rest):
        """Returns whether a direction l is known in which the point is proved to be beyond the set:
        l'd > sum of |g_j' l|. That sum is l'G s for the signs s of G'l, but for products so small
        that rounding decides their signs."""
        along = rest * self.scale**2
        axes = [numpy.where(numpy.arange(len(along)) == i, along, 0.0) for i in range(len(along))]
        terms = len(self.states) + 4
        for l in (y, along, *axes):
            if not (numpy.isfinite(l).all() and l.any()):
                continue
            extreme = self._product(numpy.where(self.g.T @ l >= 0.0, 1.0, -1.0))
            doubtful = 4.0 * terms * UNIT * (self.sizes.sum(axis=1) @ numpy.abs(l))
            gap = sum((arb(x) * (p - v) for x, p, v in zip(l, d, extreme, strict=True)), arb(0))
            if gap > arb(doubtful):
                return True
        return False


class _Inverse:
    """W = D G' (G D G')^-1 for weights D of the generators, with rows scaled to sums of 1."""

    def __init__(self, g, scale, weights):
        scaled = g * scale[:, None]
        self.scale = scale
        weighted = scaled * (weights / max(weights.max(), 1e-300))
        try:
            self.w = weighted.T @ numpy.linalg.inv(scaled @ weighted.T)
        except numpy.linalg.LinAlgError:
            self.w = numpy.full(g.T.shape, numpy.nan)
        self.sizes = numpy.abs(self.w)
        # G is known to a last digit, is scaled, and the product has as many terms as there are
        # generators.
        terms = g.shape[1] + 8
        off = numpy.abs(scaled @ self.w - numpy.eye(len(g)))
        off += terms * UNIT * (numpy.abs(scaled) @ self.sizes)
        off += TINY * scale[:, None] * self.sizes.sum(axis=0)
        self.defect = 1.01 * off.sum(axis=1).max()

    def factors(self, rest, error):
        """Returns upper bounds of |delta| for rests that are known up to an error, each a column
        with one entry for each state."""
        if not self.defect < 0.5:
            return numpy.full((len(self.w), rest.shape[1]), numpy.inf)
        rest, error = rest * self.scale[:, None], 1.01 * error * self.scale[:, None]
        # The inverse of G W changes a rest by at most defect / (1 - defect) of its largest entry.
        largest = (numpy.abs(rest) + error).max(axis=0)
        error = error + 1.01 * (2.0 * self.defect + 4.0 * UNIT) * largest
        terms = len(self.scale) + 4
        delta = numpy.abs(self.w @ rest) + terms * UNIT * (self.sizes @ numpy.abs(rest))
        return (delta + self.sizes @ error) * (1.0 + 64.0 * UNIT)


def _clip(factors, limit):
    clipped = numpy.clip(factors, -limit, limit)
    return numpy.where(numpy.isfinite(clipped), clipped, 0.0)


def _up(x):
    return numpy.nextafter(float(abs(x).upper()), numpy.inf)
