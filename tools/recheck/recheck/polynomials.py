"""The polynomials of a model that is not linear, and its motions, in doubles."""

from dataclasses import dataclass

import numpy


@dataclass(frozen=True)
class Polynomials:
    """The accelerations of a model: sums of terms in offsets of the variables from `origin`."""

    joints: int
    origin: numpy.ndarray
    # For each joint: exponents, terms x variables, and coefficients.
    terms: list
    # For each variable what it is: ("qd", joint), ("s", joint), ("u", joint) and so on.
    variables: list

    @classmethod
    def of_file(cls, content, joints):
        """Reads the polynomials of a model file."""
        names = content["variables"]
        terms = []
        for joint in content["acceleration"]:
            exponents = numpy.array([term[0] for term in joint], dtype=int)
            coefficients = numpy.array([float(term[1]) for term in joint])
            terms.append((exponents.reshape(len(joint), len(names)), coefficients))
        variables = []
        for name in names:
            kind = name.rstrip("0123456789")
            variables.append((kind, int(name[len(kind):]) - 1))
        return cls(joints, numpy.array(content["origin"], dtype=float), terms, variables)

    def derivative(self, x, u):
        """Returns the derivative of states (2n x motions) under inputs (n x motions)."""
        n = self.joints
        of = {
            "qd": lambda j: x[n + j], "u": lambda j: u[j], "q": lambda j: x[j],
            "s": lambda j: numpy.sin(x[j]), "c": lambda j: numpy.cos(x[j]),
            "one": lambda j: numpy.ones_like(x[j]),
        }
        values = numpy.stack([of[kind](j) for kind, j in self.variables])
        values -= self.origin[:, None]
        highest = max((int(e.max(initial=0)) for e, _ in self.terms), default=0)
        powers = values[None] ** numpy.arange(highest + 1)[:, None, None]
        accelerations = []
        for exponents, coefficients in self.terms:
            product = numpy.repeat(coefficients[:, None], x.shape[1], axis=1)
            for i in range(len(self.variables)):
                used = exponents[:, i] > 0
                product[used] *= powers[exponents[used, i], i]
            accelerations.append(product.sum(axis=0))
        return numpy.concatenate([x[n:], numpy.stack(accelerations)])

    def advance(self, x, u, span, steps):
        """Integrates over a span by the classical method of Runge and Kutta of order 4."""
        h = span / steps
        for _ in range(steps):
            k1 = self.derivative(x, u)
            k2 = self.derivative(x + 0.5 * h * k1, u)
            k3 = self.derivative(x + 0.5 * h * k2, u)
            k4 = self.derivative(x + h * k3, u)
            x = x + h / 6.0 * (k1 + 2.0 * k2 + 2.0 * k3 + k4)
        return x
