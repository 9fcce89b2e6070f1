"""Reading of the polynomials of a model that is not linear."""

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
