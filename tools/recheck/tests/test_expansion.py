"""Expansions against the polynomials themselves, at random places."""

import math

import numpy
import pytest

from recheck.balls import arb
from recheck.errors import BadInput
from recheck.expansion import Expansion
from recheck.polynomials import Polynomials

NAMES = ["qd1", "qd2", "s1", "q2", "c1", "one2", "u1", "u2"]
ORIGIN = [0.1, -0.2, 0.3, 0.0, 0.9, 1.0, 0.0, 0.5]
TERMS = [
    [([1, 0, 0, 0, 0, 0, 1, 0], 0.7), ([2, 1, 0, 0, 0, 0, 0, 0], -1.3),
     ([0, 0, 0, 0, 0, 0, 1, 0], 2.0), ([0, 0, 0, 0, 0, 0, 0, 1], 0.4),
     ([0, 0, 2, 0, 1, 0, 0, 0], 1.1), ([0, 0, 0, 0, 0, 0, 0, 0], 0.6)],
    [([0, 4, 0, 0, 0, 0, 0, 0], -0.5), ([1, 1, 1, 1, 0, 0, 0, 0], 2.2),
     ([0, 0, 0, 0, 0, 0, 0, 1], 1.5), ([0, 0, 1, 0, 2, 1, 0, 0], 0.9),
     ([0, 0, 0, 3, 0, 0, 0, 0], 0.8), ([0, 0, 0, 0, 0, 0, 0, 1], 0.25)],
]


def model():
    """The polynomials with two joints, the second of which slides."""
    content = {"variables": NAMES, "origin": ORIGIN,
               "acceleration": [[list(term) for term in joint] for joint in TERMS]}
    return Polynomials.of_file(content, 2)


def acceleration(x, u):
    """The same in doubles."""
    values = [x[2], x[3], math.sin(x[0]), x[1], math.cos(x[0]), 1.0, *u]
    offsets = numpy.array(values) - ORIGIN
    return [sum(a * math.prod(offsets**numpy.array(powers)) for powers, a in joint)
            for joint in TERMS]


def doubles(matrix):
    return numpy.array([[float(x) for x in row] for row in matrix.tolist()])


@pytest.mark.parametrize("size", [0.0, 0.01, 0.3])
def test_values_nearby_are_within_the_linear_terms_and_the_bound(size):
    random, expansion = numpy.random.default_rng(2), Expansion(model())
    inverse = abs(doubles(expansion.inverse))
    for _ in range(40):
        x, u = random.uniform(-1.0, 1.0, 4), random.uniform(-1.0, 1.0, 2)
        about = expansion.about([arb(float(a)) for a in x], [arb(float(a)) for a in u])
        state, push = size * random.uniform(0.0, 1.0, 4), size * random.uniform(0.0, 1.0, 2)
        middle, radius = about.beyond([arb(float(a)) for a in state],
                                      [arb(float(a)) for a in push])
        middle = doubles(expansion.inverse) @ [float(m) for m in middle]
        radius = inverse @ [float(r) for r in radius]
        for _ in range(20):
            d, e = (part * numpy.sign(random.uniform(-1.0, 1.0, len(part)))
                    * random.uniform(0.0, 1.0) ** 0.2 for part in (state, push))
            linear = doubles(about.rate)[:, 0] + doubles(about.slope) @ d + doubles(about.gain) @ e
            assert linear[:2] == pytest.approx((x + d)[2:], abs=1e-14)
            exact = acceleration(x + d, u + e)
            assert (abs(exact - linear[2:] - middle) <= radius + 1e-13).all()


def test_a_variable_or_a_term_that_does_not_fit_is_refused():
    good = {"variables": ["qd1", "u1"], "origin": [0.0, 0.0], "acceleration": [[[[1, 0], 2.0]]]}
    Polynomials.of_file(good, 1)
    for changes in ({"variables": ["qd1", "u2"]}, {"variables": ["qd1", "w1"]}, {"origin": [0.0]},
                    {"acceleration": [[[[1], 2.0]]]}, {"acceleration": [[[[-1, 0], 2.0]]]},
                    {"acceleration": [[[[1, 0], float("inf")]]]}, {"acceleration": []}):
        with pytest.raises(BadInput):
            Polynomials.of_file(good | changes, 1)
