"""The polynomials of a model about a state: linear terms, and bounds of all that is beyond them.

A polynomial in offsets z of the variables is finite about any place: with z + d in place of z each
term splits by the binomial theorem, without a remainder. sin and cos of a position that is off by
e split as

    sin(q + e) = sin q + e cos q + r,   r in -sin q [0, e^2/2] + cos q [-|e|^3, |e|^3]/6
    cos(q + e) = cos q - e sin q + r,   r in -cos q [0, e^2/2] + sin q [-|e|^3, |e|^3]/6

The accelerations are taken in the basis in which the inputs act: P with P B_2 near 1, where B_2 has
the coefficients of u alone. There, friction of one joint is one coordinate, and its bound does not
spread over all joints before it is a generator.
"""

import math
from itertools import product

import numpy

from .balls import arb, arb_mat, column, matrix

HALF, THIRD = arb(1) / 2, arb(1) / 3


class Expansion:
    """The polynomials of a model, ready to be expanded about any state."""

    def __init__(self, polynomials):
        self.joints, self.kinds = polynomials.joints, polynomials.variables
        self.origin = [arb(float(x)) for x in polynomials.origin]
        terms = _merged(polynomials)
        self.basis = matrix(_input_basis(terms, self.kinds, self.joints))
        self.inverse = self.basis.inv()
        self.terms = [
            (monomial, (self.basis * arb_mat(self.joints, 1, vector)).entries())
            for monomial, vector in terms.items()
        ]
        self.parts = [(_parts(monomial), vector) for monomial, vector in self.terms]

    def about(self, x, u):
        """Returns the expansion about a state and an input, lists of balls."""
        return Expanded(self, x, u)


class Expanded:
    """The polynomials about a state x and an input u."""

    def __init__(self, expansion, x, u):
        self.expansion, n = expansion, expansion.joints
        self.sin_cos = [q.sin_cos() for q in x[:n]]
        values = [self._value(kind, j, x, u) for kind, j in expansion.kinds]
        offsets = [v - o for v, o in zip(values, expansion.origin, strict=True)]
        self.coefficients = _shifted(expansion.parts, offsets, n)
        nothing = [arb(0)] * n
        rate = self.coefficients.get((), nothing)
        slopes = [[arb(0)] * (2 * n) for _ in range(n)]
        gains = [[arb(0)] * n for _ in range(n)]
        for variable, (kind, j) in enumerate(expansion.kinds):
            vector = self.coefficients.get(((variable, 1),), nothing)
            for i in range(n):
                if kind == "u":
                    gains[i][j] = gains[i][j] + vector[i]
                elif kind != "one":
                    at = n + j if kind == "qd" else j
                    slopes[i][at] = slopes[i][at] + vector[i] * self._inner_slope(kind, j)
        inverse = expansion.inverse
        rate, slopes = inverse * column(rate), inverse * arb_mat(slopes)
        gains = inverse * arb_mat(gains)
        self.rate = column([*x[n:], *rate.entries()])
        self.slope = _below([[arb(i + n == j) for j in range(2 * n)] for i in range(n)], slopes)
        self.gain = _below([[arb(0)] * n for _ in range(n)], gains)

    def _value(self, kind, j, x, u):
        if kind in "sc":
            return self.sin_cos[j]["sc".index(kind)]
        return {"qd": lambda: x[len(x) // 2 + j], "q": lambda: x[j], "u": lambda: u[j],
                "one": lambda: arb(1)}[kind]()

    def _inner_slope(self, kind, j):
        """The derivative of a variable by its state."""
        sine, cosine = self.sin_cos[j]
        return {"s": cosine, "c": -sine}.get(kind, arb(1))

    def beyond(self, state, push):
        """Encloses the accelerations beyond the linear terms, for deviations of the state and of
        the input by at most these balls. Returns the middle, and the radius in the basis."""
        n, kinds = self.expansion.joints, self.expansion.kinds
        sizes, bends = [], []
        for kind, j in kinds:
            size, bend = self._of_variable(kind, j, state, push)
            sizes.append(size)
            bends.append(bend)
        middle, radius = [arb(0)] * n, [arb(0)] * n
        for monomial, vector in self.coefficients.items():
            if len(monomial) == 1 and monomial[0][1] == 1:
                mid, rad = bends[monomial[0][0]]
                if rad == 0:
                    continue
            elif monomial:
                mid, rad = _range(monomial, sizes)
            else:
                continue
            for i, a in enumerate(vector):
                middle[i] = middle[i] + a * mid
                radius[i] = radius[i] + abs(a) * rad
        return middle, [arb(x.abs_upper()) for x in radius]

    def _of_variable(self, kind, j, state, push):
        """How far a variable may be off, and middle and radius of what its slope misses."""
        n, nothing = self.expansion.joints, (arb(0), arb(0))
        if kind == "one":
            return arb(0), nothing
        if kind == "u":
            return push[j], nothing
        e = state[n + j] if kind == "qd" else state[j]
        if kind not in "sc":
            return e, nothing
        own, other = self.sin_cos[j] if kind == "s" else self.sin_cos[j][::-1]
        quarter, sixth = e * e * HALF * HALF, e * e * e * HALF * THIRD
        radius = abs(own) * quarter + abs(other) * sixth
        return abs(other) * e + abs(own) * quarter + radius, (-own * quarter, radius)


def _merged(polynomials):
    """The terms of all joints: monomial to coefficients, with equal monomials added up. A monomial
    is a tuple of (variable, power)."""
    found, n = {}, polynomials.joints
    for i, (exponents, coefficients) in enumerate(polynomials.terms):
        for powers, coefficient in zip(exponents, coefficients, strict=True):
            key = tuple((int(v), int(p)) for v, p in enumerate(powers) if p)
            vector = found.setdefault(key, [arb(0)] * n)
            vector[i] = vector[i] + arb(float(coefficient))
    return found


def _input_basis(terms, kinds, n):
    """The inverse, in doubles, of the coefficients of u alone; 1 where there is none."""
    gains = numpy.zeros((n, n))
    for variable, (kind, j) in enumerate(kinds):
        if kind == "u" and ((variable, 1),) in terms:
            gains[:, j] = [float(a) for a in terms[((variable, 1),)]]
    try:
        inverse = numpy.linalg.inv(gains)
    except numpy.linalg.LinAlgError:
        return numpy.eye(n).tolist()
    return inverse.tolist() if numpy.isfinite(inverse).all() else numpy.eye(n).tolist()


def _parts(monomial):
    """How (z + d)^monomial splits: for each monomial in d, its factor and the powers of z."""
    found = []
    for powers in product(*(range(p + 1) for _, p in monomial)):
        factor = math.prod(math.comb(p, b) for (_, p), b in zip(monomial, powers, strict=True))
        of_d = tuple((v, b) for (v, _), b in zip(monomial, powers, strict=True) if b)
        of_z = [(v, p - b) for (v, p), b in zip(monomial, powers, strict=True) if p > b]
        found.append((of_d, factor, of_z))
    return found


def _shifted(parts, offsets, n):
    """The coefficients of the monomials in d."""
    found = {}
    for split, vector in parts:
        for of_d, factor, of_z in split:
            for variable, power in of_z:
                factor = factor * offsets[variable] ** power
            old = found.get(of_d)
            new = [a * factor for a in vector]
            found[of_d] = new if old is None else [x + y for x, y in zip(old, new, strict=True)]
    return found


def _range(monomial, sizes):
    """Middle and radius of a monomial over deviations of these sizes."""
    size = arb(1)
    for variable, power in monomial:
        size = size * sizes[variable] ** power
    if all(power % 2 == 0 for _, power in monomial):
        return size * HALF, size * HALF
    return arb(0), size


def _below(upper, lower):
    return arb_mat([*upper, *lower.tolist()])
