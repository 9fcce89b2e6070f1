"""Integrals of |f| over a span, for each entry f of e^{As} C, with proved bounds.

f is its Taylor polynomial of a high order, and a remainder that the norm of A bounds. Where a ball
around f over the span excludes 0, the integral of |f| is |∫ f|. Other spans are halved until
the rest cannot matter.
"""

from flint import arb_poly

from .balls import BITS, arb, arb_mat, between, row_sum_norm, symmetric

# Spans with a smaller bound of the integral are not halved further.
NEGLIGIBLE = arb(2) ** -130
MOST_HALVINGS = 400


def integral_of_magnitudes(system, e, step, span):
    """Returns the integral of |e^{A(t+s)} B| for s from 0 to `span`, where `e` is e^{At}."""
    start = e * system.b
    whole = (e * step.gamma).entries()
    terms, remainder = _series(system.a, start, span)
    found, width = [], system.inputs
    for at, closed_form in enumerate(whole):
        i, j = divmod(at, width)
        f = _Function(arb_poly([term[i, j] for term in terms]), remainder)
        if f.keeps_sign(arb(0), span):
            found.append(abs(closed_form))
        else:
            found.append(f.integral_of_magnitude(arb(0), span, MOST_HALVINGS))
    return arb_mat(system.states, width, found)


def _series(a, start, span):
    """Returns the Taylor coefficients of e^{As} C, and a bound of the remainder over the span.

    With row sums as norm, |A^m C| <= |A|^m |C|, so that the terms from m = M on are at most
    (|A| h)^M / M! e^{|A| h} |C| together.
    """
    growth = row_sum_norm(a) * span
    entries = start.entries()
    size = max((abs(x).upper() for x in entries), default=arb(0))
    enough = arb(2) ** -(BITS + 20)
    terms, term, weight = [start], start, growth
    while not weight < enough:
        term = a * term / len(terms)
        terms.append(term)
        weight = weight * growth / len(terms)
    # Row sums of C are at most its width times its largest entry.
    return terms, (weight * growth.exp() * size * start.ncols()).upper()


class _Function:
    """A polynomial with a remainder."""

    def __init__(self, polynomial, remainder):
        self.polynomial, self.error = polynomial, symmetric(remainder)
        self.antiderivative = polynomial.integral()

    def over(self, low, high):
        """Encloses the values between two places."""
        return self.polynomial(between(low, high)) + self.error

    def keeps_sign(self, low, high):
        """Returns whether the function is proved not to vanish between two places."""
        values = self.over(low, high)
        return bool(values > 0) or bool(values < 0)

    def integral_of_magnitude(self, low, high, halvings):
        """Encloses the integral of |f|."""
        values, width = self.over(low, high), high - low
        if values > 0 or values < 0:
            exact = self.antiderivative(high) - self.antiderivative(low)
            return abs(exact + self.error * width)
        most = abs(values).upper() * width
        if halvings == 0 or most < NEGLIGIBLE:
            return between(0, most.upper())
        middle = ((low + high) / 2).mid()
        halves = ((low, middle), (middle, high))
        return sum((self.integral_of_magnitude(*half, halvings - 1) for half in halves), arb(0))
