"""The linear system x' = A x + B u + d: its motion over a span of time, in balls."""

from dataclasses import dataclass

import numpy

from .balls import arb_mat, block, matrix


@dataclass(frozen=True)
class Step:
    """The exact map of one span h: x(h) = phi x + gamma u + drift for an input that is held."""

    phi: arb_mat
    gamma: arb_mat
    drift: arb_mat

    def rounded(self):
        """The same in doubles, rounded to nearest."""
        parts = (self.phi, self.gamma, self.drift)
        return tuple(numpy.array([[float(x) for x in row] for row in part.tolist()])
                     for part in parts)


class System:
    """A, B and d of a model, with the steps over the spans asked for so far."""

    def __init__(self, model):
        self.states, self.inputs = 2 * model.joints, model.joints
        rows = zip(model.a, model.b, model.drift, strict=True)
        width = self.states + self.inputs + 1
        self.generator = matrix(
            [[*a, *b, d] for a, b, d in rows] + [[0.0] * width] * (self.inputs + 1)
        )
        self.a = block(self.generator, range(self.states), range(self.states))
        self.b = block(
            self.generator, range(self.states), range(self.states, width - 1)
        )
        self._steps = {}

    def step(self, span):
        """Returns the step over a span h: parts of the exponential of [[A, B, d], 0] h."""
        key = span.repr()
        if key not in self._steps:
            exponential = (self.generator * span).exp()
            n, m = self.states, self.inputs
            self._steps[key] = Step(
                block(exponential, range(n), range(n)),
                block(exponential, range(n), range(n, n + m)),
                block(exponential, range(n), range(n + m, n + m + 1)),
            )
        return self._steps[key]
