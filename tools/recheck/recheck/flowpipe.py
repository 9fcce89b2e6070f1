"""Reachable sets of a model that is not linear, from outside and from inside, by conservative
linearisation (docs/method.md, section 7, derives the same bounds).

Over one step x' = f(x*) + A (x - x*) + B (u - u*) + l, where l is all beyond the linear terms. A
guess G of where the motions are over the step is proved if what starts in the set and moves with a
derivative of the range of f over G stays in G. l is bounded over G.

The set at a sample is c + start a + (first + second) b + rest z, all factors in [-1, 1]. `start`
has the columns of X0. `first` and `second` have one column each for each input and step: an input
that is held over the step moves the state by (first + second) b, any other one by first b + second
b' with b and b' of their own. The numbers z are what l, rounding and doubtful inputs do, and depend
on the motion. Hence every motion is within the sum of all magnitudes of c. Since all a and b may be
chosen, one motion gets at least as far as the magnitudes of `start` and `first + second` add up to,
less what `rest` can take back.

Generators are doubles. Each product with a matrix rounds by at most p u times the product of the
magnitudes for p terms, and that goes into `rest`.
"""

from dataclasses import dataclass

import numpy

from .balls import arb, arb_mat, block, column, magnitudes
from .expansion import Expansion

# Twice the unit of rounding of doubles, which leaves room for what rounds in bounds.
UNIT = 2.0**-52
# Bound of what underflow takes from a sum.
TINY = 1e-290
# How often a guess is widened before the set is lost.
GUESSES = 40


class Lost(Exception):
    """The set cannot be enclosed any further."""


@dataclass(frozen=True)
class Hull:
    """The interval hull at a sample: all motions are within `outer` of the centre, and motions get
    as far as `inner` from it, on both sides, where it is not negative."""

    centre: list
    outer: list
    inner: list


class Flowpipe:
    """The reachable set of one case, step by step."""

    def __init__(self, model, case, expansion=None):
        self.n, self.case = model.joints, case
        self.expansion = expansion or Expansion(model.polynomials)
        x0, u = model.initial_set, model.input_set
        centre = column([arb(a) + arb(c) for a, c in zip(case.start, x0.centre, strict=True)])
        self.push, self.input_centre = [arb(r) for r in u.radius], u.centre
        self.doubt = [arb(d) for d in case.doubt]
        self.start = numpy.diag(numpy.array(x0.radius))
        self.first = self.second = self.rest = numpy.zeros((2 * self.n, 0))
        self.guess = None
        self._set_centre(centre, numpy.zeros(2 * self.n))

    def hull(self):
        """Returns the hull at the present sample."""
        start, rest = _sizes(self.start), _sizes(self.rest)
        held, free = _sizes(self.first + self.second), _sizes(self.first) + _sizes(self.second)
        # Sums in doubles are off by as many roundings as they have terms.
        terms = self.start.shape[1] + 2 * self.first.shape[1] + self.rest.shape[1] + 4
        up, down = 1 + arb(terms * UNIT), 1 - arb(terms * UNIT)
        rest = [arb(float(z)) * up for z in rest]
        outer = [(arb(float(a)) + arb(float(b))) * up + z
                 for a, b, z in zip(start, free, rest, strict=True)]
        inner = [(arb(float(a)) + arb(float(b))) * down - z
                 for a, b, z in zip(start, held, rest, strict=True)]
        return Hull([arb(float(c)) for c in self.centre], outer, inner)

    def advance(self, k, span):
        """Goes on from sample k by a span, in balls, to the next one."""
        n, centre = self.n, [arb(float(c)) for c in self.centre]
        u = [arb(a) + arb(c) for a, c in zip(self.case.inputs[k], self.input_centre, strict=True)]
        # Expand about the middle of the step, as an exact point.
        rate = self.expansion.about(centre, u).rate.entries()
        place = [(c + r * span / 2).mid() for c, r in zip(centre, rate, strict=True)]
        middle_input = [x.mid() for x in u]
        push = [r + d + abs(x - m)
                for r, d, x, m in zip(self.push, self.doubt, u, middle_input, strict=True)]
        about = self.expansion.about(place, middle_input)
        middle, radius = self._prove_guess(about, place, push, span)
        # One step of the linear system.
        of_input = about.gain * column([x - m for x, m in zip(u, middle_input, strict=True)])
        bend = column([*[arb(0)] * n, *(self.expansion.inverse * column(middle)).entries()])
        phi, drift = _exponential(about.slope, about.rate + bend + of_input, span)
        off = column(centre) - column(place)
        moved = column(place) + phi * off + drift
        own = about.gain * _diagonal(self.push)
        doubtful = about.gain * _diagonal(self.doubt)
        accelerations = self.expansion.inverse * _diagonal(radius)
        bent = arb_mat([*[[arb(0)] * n] * n, *accelerations.tolist()])
        self._propagate(phi, [own, doubtful, bent], span, about.slope)
        self._set_centre(moved, self.box)

    def _prove_guess(self, about, place, push, span):
        """Finds a box that the motions are proved not to leave over the step, and returns what
        bounds the terms beyond the linear ones there."""
        hull = self.hull()
        # With the rate at the place alone, the centre moves along a straight line.
        lines = [(c - p, c - p + span * about.rate[i, 0])
                 for i, (c, p) in enumerate(zip(hull.centre, place, strict=True))]
        apart = [max(abs(a).upper(), abs(b).upper()) + r
                 for (a, b), r in zip(lines, hull.outer, strict=True)]
        guess = self.guess or [2 * a for a in apart]
        slope, gain = magnitudes(about.slope), magnitudes(about.gain)
        for _ in range(GUESSES):
            middle, radius = about.beyond(guess, push)
            rest = magnitudes(self.expansion.inverse) * column(
                [abs(m) + r for m, r in zip(middle, radius, strict=True)])
            most = slope * column(guess) + gain * column(push)
            speeds = [most[i, 0] + (rest[i - self.n, 0] if i >= self.n else 0)
                      for i in range(2 * self.n)]
            found = [arb((a + span * s).abs_upper()) for a, s in zip(apart, speeds, strict=True)]
            if not all(f.is_finite() for f in found):
                break
            is_proved = all(f <= g for f, g in zip(found, guess, strict=True))
            # A little more than was found is the next guess, here or at the next step.
            self.guess = [f * arb(1.02) + arb(1e-12) for f in found]
            if is_proved:
                return middle, radius
            guess = self.guess
        raise Lost

    def _propagate(self, phi, pushes, span, slope):
        """Moves all generators on by one step, and appends the step's own."""
        half = span / 2
        rounded, error = _rounded(phi)
        self.box = numpy.zeros(2 * self.n)
        parts = [self._moved(part, rounded, error)
                 for part in (self.start, self.first, self.second, self.rest)]
        # An input b e(s) with |e| <= 1 moves by (h/2) b e1 + (h/2) e^{Ah} b e2, but for a bound.
        columns = [(half * push, half * (phi * push)) for push in pushes]
        sizes = sum((magnitudes(push) for push in pushes[1:]), magnitudes(pushes[0]))
        total = sizes * column([arb(1)] * self.n)
        a = magnitudes(slope)
        off = a * (a * ((a * span).exp() * total)) * (span**3 / 12)
        self.box += numpy.array([_double_up(x) for x in off.entries()])
        doubles = [[self._double(m) for m in pair] for pair in columns]
        (first, second), *others = doubles
        self.start = parts[0]
        self.first = numpy.concatenate([parts[1], first], axis=1)
        self.second = numpy.concatenate([parts[2], second], axis=1)
        new = [m[:, numpy.abs(m).any(axis=0)] for pair in others for m in pair]
        self.rest = numpy.concatenate([parts[3], *new], axis=1)

    def _moved(self, part, rounded, error):
        size = _sizes(part) * (1.0 + 1e-9)
        self.box += 1.01 * (error + 16.0 * UNIT * numpy.abs(rounded)) @ size + TINY
        return rounded @ part

    def _double(self, m):
        """The matrix in doubles; what that rounds goes into the box."""
        rounded, error = _rounded(m)
        self.box += error.sum(axis=1) * (1.0 + 1e-9)
        return rounded

    def _set_centre(self, centre, box):
        """Rounds the centre, and appends the box with what that rounds."""
        self.centre = numpy.array([float(x) for x in centre.entries()])
        off = [_double_up(abs(x - arb(float(c))))
               for x, c in zip(centre.entries(), self.centre, strict=True)]
        box = (box + numpy.array(off)) * (1.0 + 4.0 * UNIT)
        self.rest = numpy.concatenate([self.rest, numpy.diag(box)], axis=1)


def _exponential(slope, rate, span):
    """e^{Ah}, and the integral of e^{As} over the span times a rate."""
    size = slope.nrows()
    rows = [[*slope.tolist()[i], rate[i, 0]] for i in range(size)]
    whole = (arb_mat([*rows, [arb(0)] * (size + 1)]) * span).exp()
    return block(whole, range(size), range(size)), block(whole, range(size), [size])


def _diagonal(values):
    size = len(values)
    return arb_mat(size, size, [
        values[i] if i == j else arb(0) for i in range(size) for j in range(size)
    ])


def _rounded(m):
    """A matrix of balls in doubles, and bounds of what that changes."""
    rows = m.tolist()
    rounded = numpy.array([[float(x) for x in row] for row in rows])
    error = numpy.array([[_double_up(abs(x - arb(float(x)))) for x in row] for row in rows])
    return rounded, error


def _double_up(x):
    return float(numpy.nextafter(float(x.abs_upper()), numpy.inf))


def _sizes(part):
    """The sums of magnitudes of the rows in doubles."""
    return numpy.abs(part).sum(axis=1) if part.shape[1] else numpy.zeros(len(part))
