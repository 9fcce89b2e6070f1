"""Whether a point is a combination of generators with factors in [-1, 1].

The claim of a certificate is d = G alpha + e with alpha = sum of w_v sign(G' l_v), all w_v >= 0,
and a small e. With any W for which G W is near 1, e = G beta for beta = W (G W)^-1 e. The point is
in the set if |alpha_j + beta_j| <= 1 for every generator j.

G alpha is computed exactly to 2^-100, and e in balls. W, G W - 1 and beta are computed in doubles
with bounds of their rounding: a product of p terms is off by at most p u / (1 - p u) times the
product of the magnitudes, in any order of summation, with u = 2^-53.
"""

import numpy

from .balls import arb
from .generators import QUANTUM
from .verdict import Verdict

# Twice the unit of rounding, so that the bounds of rounding are rounded up with room to spare.
UNIT = 2.0**-52
# Generators with g'l below this part of |g|'|l| count as orthogonal to l.
ORTHOGONAL = 1e-10
# Digits of moved factors, and the most steps of the search for them.
BITS, MOST_STEPS = 24, 30
# Bound of what the entries of generators are off besides their rounding to doubles.
TINY = 2.0 ** (1 - QUANTUM)


class Projection:
    """The generators of one sample in some states, with what all points share."""

    def __init__(self, parts, states, directions, is_whole=True):
        # Where these are not all generators, no point can be proved to be outside.
        self.parts, self.states, self.is_whole = parts, states, is_whole
        self.g = numpy.concatenate([part.rounded(states) for part in parts], axis=1)
        self.directions = numpy.array(directions, dtype=float).reshape(-1, len(states))
        sizes = numpy.abs(self.g).sum(axis=1)
        self.scale = numpy.where(sizes > 0.0, 1.0 / numpy.where(sizes > 0.0, sizes, 1.0), 0.0)
        self.uniform = _Inverse(self.g, self.scale, numpy.ones(self.g.shape[1]))
        self.strict = self._recipes(self.directions, 0.0)
        self._loose = None

    def _recipes(self, directions, least):
        """Returns the signs of G' l for each direction l, and G times them in balls. Products
        that are at most `least` of the product of the magnitudes have the sign 0."""
        products = self.g.T @ directions.T
        signs = numpy.where(products >= 0.0, 1.0, -1.0)
        sizes = numpy.abs(self.g).T @ numpy.abs(directions).T
        signs[numpy.abs(products) < least * sizes] = 0.0
        sums, first = None, 0
        for part in self.parts:
            own = part.sums(self.states, signs[first : first + part.count])
            first += part.count
            sums = own if sums is None else [
                [x + y for x, y in zip(a, b, strict=True)] for a, b in zip(sums, own, strict=True)
            ]
        return signs, sums

    @property
    def loose(self):
        """The recipes in which generators next to orthogonal to a direction have no part: rounding
        decides their signs, and the rest may need them."""
        if self._loose is None:
            self._loose = self._recipes(self.directions, ORTHOGONAL)
        return self._loose

    def judge(self, points):
        """Judges points, each the deviation from the centre of the set in balls with its weights.
        Returns verdicts and what may be missing, in parts of a factor."""
        points = list(points)
        slacks = [self._slack(weights) for _, weights in points]
        rests = [
            point if slack is None else _rest(point, weights, self.strict[1])
            for (point, weights), slack in zip(points, slacks, strict=True)
        ]
        judged = []
        for beta, (point, weights), rest, slack in zip(
            self.uniform.factors(rests), points, rests, slacks, strict=True
        ):
            missing = numpy.inf if slack is None else float(beta.max() - slack)
            if missing > 0.0 and slack is not None:
                missing = min(missing, self._one_by_one(point, weights, slack))
            if missing <= 0.0:
                judged.append((Verdict.HOLDS, 0.0))
            elif self.is_whole and self._is_outside(point, rest):
                judged.append((Verdict.FAILS, missing))
            else:
                judged.append((Verdict.UNDECIDED, missing))
        return judged

    def _slack(self, weights):
        """Returns a lower bound of 1 - sum of weights; None where weights are not allowed."""
        if len(weights) != len(self.directions) or not all(w >= 0.0 for w in weights):
            return None
        slack = (1 - sum(map(arb, weights), arb(0))).lower()
        return max(numpy.nextafter(float(slack), -numpy.inf), 0.0) if slack >= 0 else None

    def _one_by_one(self, point, weights, slack):
        """Judges each factor by itself, with the rest put where the factors have room. Returns
        what is missing in the best of some ways to do so."""
        missing = numpy.inf
        for recipes in (lambda: self.strict, lambda: self.loose):
            signs, vertices = recipes()
            rest = _rest(point, weights, vertices)
            alpha = signs @ numpy.array(weights)
            room = 1.0 - numpy.abs(alpha) - (len(weights) + 4) * UNIT
            missing = min(missing, self._absorb(rest, numpy.maximum(room, slack)))
            if missing <= 0.0:
                return missing
        moved = self._moved(alpha, rest)
        first = 0
        for part in self.parts:
            own = part.combination(self.states, moved[first : first + part.count], BITS)
            first += part.count
            rest = [x - y for x, y in zip(rest, own, strict=True)]
        room = 1.0 - numpy.abs(alpha + moved / 2.0**BITS) - (len(weights) + 8) * UNIT
        return min(missing, self._absorb(rest, numpy.where(moved == 0.0, numpy.maximum(
            room, slack), numpy.maximum(room, 0.0))))

    def _absorb(self, rest, room):
        """Returns what is missing for the rest to go where the factors have this room."""
        missing = numpy.inf
        for power in (2, 1):
            beta = _Inverse(self.g, self.scale, room**power).factors([rest])[0]
            missing = min(missing, float((beta - room).max()))
            if missing <= 0.0:
                break
        return missing

    def _moved(self, alpha, rest):
        """Returns by how much to move factors, in parts of 2^BITS, so that a large rest becomes
        small: steps to the nearest bound, along least norms weighted by the room that is left.
        This is a search, and proves nothing."""
        e = numpy.array([float(x) for x in rest]) * self.scale
        scaled = self.g * self.scale[:, None]
        start, room = alpha.copy(), numpy.ones(len(alpha))
        for _ in range(MOST_STEPS):
            w = _Inverse(self.g, self.scale, room).w
            beta = w @ e
            if not numpy.isfinite(beta).all():
                break
            room = numpy.maximum(1.0 - numpy.sign(beta) * alpha, 0.0)
            step = 0.99 * (room / numpy.maximum(numpy.abs(beta), 1e-300)).min()
            if step >= 1.0:
                alpha = alpha + beta
                break
            alpha = alpha + step * beta
            e = e - scaled @ (step * beta)
        moved = numpy.round((alpha - start) * 2.0**BITS)
        return numpy.where(numpy.abs(moved) < 2.0 ** (BITS - 20), 0.0, moved)

    def _is_outside(self, point, rest):
        """Returns whether a direction is known in which the point is proved to be beyond the set:
        l'd > sum of |g_j' l|. That sum is l'G sign(G'l), but for signs of products so small that
        rounding decides them."""
        found = numpy.array([float(x) for x in rest]) * self.scale**2
        candidates = [*self.directions, found, *_along_axes(found)]
        candidates = numpy.array([l for l in candidates if numpy.abs(l).max() > 0.0])
        if candidates.size == 0:
            return False
        _, vertices = self._recipes(candidates, 0.0)
        terms = len(self.states) + 4
        for l, vertex in zip(candidates, vertices, strict=True):
            doubtful = 4.0 * terms * UNIT * (numpy.abs(self.g).sum(axis=1) @ numpy.abs(l))
            gap = sum(
                (arb(x) * (p - v) for x, p, v in zip(l, point, vertex, strict=True)), arb(0)
            )
            if gap > arb(doubtful):
                return True
        return False


def _rest(point, weights, vertices):
    """Returns the point less the sum of vertices with these weights."""
    rest = list(point)
    for w, vertex in zip(weights, vertices, strict=True):
        if w != 0.0:
            rest = [x - arb(w) * v for x, v in zip(rest, vertex, strict=True)]
    return rest


class _Inverse:
    """W = D G' (G D G')^-1 for weights D of the generators, with rows scaled to sums of 1."""

    def __init__(self, g, scale, room):
        scaled = g * scale[:, None]
        self.scale = scale
        weighted = scaled * (room / max(room.max(), 1e-300))
        try:
            gram = numpy.linalg.inv(scaled @ weighted.T)
            self.w = weighted.T @ gram
        except numpy.linalg.LinAlgError:
            self.w = numpy.full(g.T.shape, numpy.nan)
        self.sizes = numpy.abs(self.w)
        # G is known to half a unit, is scaled with another, and the product has as many terms as
        # there are generators.
        terms = g.shape[1] + 8
        off = numpy.abs(scaled @ self.w - numpy.eye(len(g)))
        off += terms * UNIT * (numpy.abs(scaled) @ self.sizes)
        off += TINY * scale[:, None] * self.sizes.sum(axis=0)
        self.defect = 1.01 * off.sum(axis=1).max()

    def factors(self, rests):
        """Returns upper bounds of |beta| for each rest, in balls."""
        if not self.defect < 0.5 or not rests:
            return [numpy.full(len(self.w), numpy.inf) for _ in rests]
        # The inverse of G W changes a rest by at most defect / (1 - defect) of its largest entry.
        rounded = numpy.array([[float(x) for x in rest] for rest in rests]) * self.scale
        radii = numpy.array([[_up(x - float(x)) for x in rest] for rest in rests]) * self.scale
        largest = 1.01 * (numpy.abs(rounded) + radii).max(axis=1)
        spread = 1.01 * (2.0 * self.defect + 4.0 * UNIT) * largest + 1.01 * radii.max(axis=1)
        terms = len(self.scale) + 4
        beta = numpy.abs(self.w @ rounded.T)
        beta += terms * UNIT * (self.sizes @ numpy.abs(rounded).T)
        beta += self.sizes.sum(axis=1)[:, None] * spread[None, :]
        return list((beta * (1.0 + 64.0 * UNIT)).T)


def _along_axes(l):
    """Returns the direction along each axis, with the sign that it has in `l`."""
    return [numpy.where(numpy.arange(len(l)) == i, l, 0.0) for i in range(len(l))]


def _up(x):
    return numpy.nextafter(float(abs(x).upper()), numpy.inf)
