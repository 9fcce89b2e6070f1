"""Reading of the polynomials of a model that is not linear."""

import re
from dataclasses import dataclass

import numpy

from .errors import BadInput


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
            if exponents.shape != (len(joint), len(names)) or (exponents < 0).any() or (
                not numpy.isfinite(coefficients).all()
            ):
                raise BadInput("acceleration has a term that does not fit its variables")
            terms.append((exponents, coefficients))
        variables = []
        for name in names:
            known = re.fullmatch(r"(qd|q|s|c|u|one)([0-9]+)", name)
            if not known or not 1 <= int(known[2]) <= joints:
                raise BadInput(f"variables has {name!r}, which is unknown")
            variables.append((known[1], int(known[2]) - 1))
        origin = numpy.array(content["origin"], dtype=float)
        if len(terms) != joints or origin.shape != (len(names),):
            raise BadInput("acceleration or origin does not fit the joints and the variables")
        return cls(joints, origin, terms, variables)
