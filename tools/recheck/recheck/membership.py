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
# Bound of what the entries of generators are off besides their rounding to doubles.
TINY = 2.0 ** (1 - QUANTUM)


class Projection:
    """The generators of one sample in some states, with what all points share."""

    def __init__(self, parts, states, directions, is_whole=True):
        # Where these are not all generators, no point can be proved to be outside.
        self.parts, self.states, self.is_whole = parts, states, is_whole
        self.g = numpy.concatenate([part.rounded(states) for part in parts], axis=1)
        self.directions = numpy.array(directions, dtype=float).reshape(-1, len(states))
        self.signs, self.vertices = self._vertices(self.directions)
        sizes = numpy.abs(self.g).sum(axis=1)
        self.scale = numpy.where(sizes > 0.0, 1.0 / numpy.where(sizes > 0.0, sizes, 1.0), 0.0)
        self.uniform = _Inverse(self.g, self.scale, numpy.ones(self.g.shape[1]))

    def _vertices(self, directions):
        """Returns sign(G' l) for each direction l, and G sign(G' l) in balls."""
        signs = numpy.where(self.g.T @ directions.T >= 0.0, 1.0, -1.0)
        sums, first = None, 0
        for part in self.parts:
            own = part.sums(self.states, signs[first : first + part.count])
            first += part.count
            sums = own if sums is None else [
                [x + y for x, y in zip(a, b, strict=True)] for a, b in zip(sums, own, strict=True)
            ]
        return signs, sums

    def judge(self, points):
        """Judges points, each the deviation from the centre of the set in balls with its weights.
        Returns verdicts and what may be missing, in parts of a factor."""
        points = list(points)
        rests = [self._rest(point, weights) for point, weights in points]
        judged = []
        for beta, (point, weights), rest in zip(
            self.uniform.factors([rest for rest, _ in rests]), points, rests, strict=True
        ):
            missing = _missing(beta.max(), rest[1])
            if missing > 0.0:
                missing = min(missing, self._one_by_one(weights, rest))
            if missing <= 0.0:
                judged.append((Verdict.HOLDS, 0.0))
            elif self.is_whole and self._is_outside(point, rest[0]):
                judged.append((Verdict.FAILS, missing))
            else:
                judged.append((Verdict.UNDECIDED, missing))
        return judged

    def _rest(self, point, weights):
        """Returns the rest e of a point, and a lower bound of 1 - sum of weights; None where the
        weights are not allowed."""
        if len(weights) != len(self.directions) or not all(w >= 0.0 for w in weights):
            return point, None
        exact = [arb(w) for w in weights]
        rest = list(point)
        for w, vertex in zip(exact, self.vertices, strict=True):
            if not w.is_zero():
                rest = [x - w * v for x, v in zip(rest, vertex, strict=True)]
        slack = (1 - sum(exact, arb(0))).lower()
        return rest, slack if slack >= 0 else None

    def _one_by_one(self, weights, rest):
        """Judges each factor by itself, with the rest put where the factors have room."""
        e, slack = rest
        if slack is None:
            return numpy.inf
        alpha = self.signs @ numpy.array(weights)
        room = 1.0 - numpy.abs(alpha) - (len(weights) + 4) * UNIT
        room = numpy.maximum(room, _down(slack))
        beta = _Inverse(self.g, self.scale, room).factors([e])[0]
        return float((beta - room).max())

    def _is_outside(self, point, rest):
        """Returns whether a direction is known in which the point is proved to be beyond the set:
        l'd > sum of |g_j' l|. That sum is l'G sign(G'l), but for signs of products so small that
        rounding decides them."""
        found = numpy.array([float(x) for x in rest]) * self.scale
        candidates = [*self.directions, found * self.scale, *_along_axes(found * self.scale)]
        candidates = numpy.array([l for l in candidates if numpy.abs(l).max() > 0.0])
        if candidates.size == 0:
            return False
        _, vertices = self._vertices(candidates)
        terms = len(self.states) + 4
        for l, vertex in zip(candidates, vertices, strict=True):
            doubtful = 4.0 * terms * UNIT * (numpy.abs(self.g).sum(axis=1) @ numpy.abs(l))
            gap = sum(
                (arb(x) * (p - v) for x, p, v in zip(l, point, vertex, strict=True)), arb(0)
            )
            if gap > arb(doubtful):
                return True
        return False


class _Inverse:
    """W = D G' (G D G')^-1 for weights D of the generators, with rows scaled to sums of 1."""

    def __init__(self, g, scale, room):
        scaled = g * scale[:, None]
        self.scale = scale
        weighted = scaled * (room / max(room.max(), 1e-300)) ** 2
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


def _missing(beta, slack):
    return numpy.inf if slack is None else float(beta) - _down(slack)


def _up(x):
    return numpy.nextafter(float(abs(x).upper()), numpy.inf)


def _down(x):
    return max(numpy.nextafter(float(x), -numpy.inf), 0.0)
