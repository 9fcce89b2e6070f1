"""Polynomials, and sines and cosines of states, that users write as formulas."""

from __future__ import annotations

from collections.abc import Mapping
from typing import TypeAlias

from .errors import SettingError

Number: TypeAlias = "int | float"

#: A variable: its name, and what of it: itself, its sine or its cosine.
Factor: TypeAlias = tuple[str, str]

#: Factors with their exponents, sorted.
Monomial: TypeAlias = tuple[tuple[Factor, int], ...]


class Polynomial:
    """A polynomial in named variables, and in sines and cosines of them.

    Coefficients are double-precision numbers. Sums and products of them are rounded as Python
    rounds them: the polynomial that results is what is enclosed.

    Parameters
    ----------
    terms
        The coefficient of each monomial, as `Polynomial.terms` returns them; `variables` makes
        polynomials without it.

    Examples
    --------
    >>> import reachtube as rt
    >>> x, y = rt.variables("x y")
    >>> (1 - x**2) * y - x
    Polynomial(y - x^2 y - x)
    """

    __slots__ = ("_terms",)

    def __init__(self, terms: Mapping[Monomial, float]) -> None:
        self._terms = {monomial: value for monomial, value in terms.items() if value != 0.0}

    @property
    def terms(self) -> dict[Monomial, float]:
        """The coefficient of each monomial."""
        return dict(self._terms)

    @staticmethod
    def of(value: Polynomial | Number) -> Polynomial:
        """Return a polynomial; a number is a constant one.

        Parameters
        ----------
        value
            A polynomial or a number.

        Returns
        -------
        Polynomial

        Raises
        ------
        SettingError
            For anything else.
        """
        if isinstance(value, Polynomial):
            return value
        try:
            number = float(value)
        except (TypeError, ValueError):
            raise SettingError(f"{value!r} is no polynomial and no number") from None
        return Polynomial({(): number})

    def __add__(self, other: Polynomial | Number) -> Polynomial:
        terms = dict(self._terms)
        for monomial, value in Polynomial.of(other)._terms.items():
            terms[monomial] = terms.get(monomial, 0.0) + value
        return Polynomial(terms)

    __radd__ = __add__

    def __pos__(self) -> Polynomial:
        return self

    def __neg__(self) -> Polynomial:
        return Polynomial({monomial: -value for monomial, value in self._terms.items()})

    def __sub__(self, other: Polynomial | Number) -> Polynomial:
        return self + -Polynomial.of(other)

    def __rsub__(self, other: Number) -> Polynomial:
        return -self + other

    def __mul__(self, other: Polynomial | Number) -> Polynomial:
        terms: dict[Monomial, float] = {}
        for left, a in self._terms.items():
            for right, b in Polynomial.of(other)._terms.items():
                powers = dict(left)
                for factor, exponent in right:
                    powers[factor] = powers.get(factor, 0) + exponent
                monomial = tuple(sorted(powers.items()))
                terms[monomial] = terms.get(monomial, 0.0) + a * b
        return Polynomial(terms)

    __rmul__ = __mul__

    def __truediv__(self, other: Number) -> Polynomial:
        if isinstance(other, Polynomial):
            return NotImplemented
        return Polynomial({monomial: value / other for monomial, value in self._terms.items()})

    def __pow__(self, exponent: int) -> Polynomial:
        if not isinstance(exponent, (int, float)) or exponent < 0 or exponent % 1 != 0:
            raise SettingError(f"the exponent {exponent!r} is no whole number of 0 or more")
        result = Polynomial.of(1.0)
        for _ in range(int(exponent)):
            result = result * self
        return result

    def __eq__(self, other: object) -> bool:
        if isinstance(other, (int, float)):
            other = Polynomial.of(other)
        return isinstance(other, Polynomial) and other._terms == self._terms

    def __hash__(self) -> int:
        return hash(frozenset(self._terms.items()))

    def __repr__(self) -> str:
        return f"Polynomial({self})"

    def __str__(self) -> str:
        def factor(item: tuple[Factor, int]) -> str:
            (name, kind), exponent = item
            text = name if kind == "x" else f"{kind} {name}"
            return text if exponent == 1 else f"{text}^{exponent}"

        text = ""
        for monomial, value in self._terms.items():
            sign = "-" if value < 0 else "+"
            size = "" if abs(value) == 1 and monomial else f"{abs(value):g}"
            words = " ".join(filter(None, [size, *map(factor, monomial)]))
            text += f" {sign} {words}" if text else (f"-{words}" if value < 0 else words)
        return text or "0"


def variables(names: str) -> tuple[Polynomial, ...]:
    """Return one polynomial for each name.

    Parameters
    ----------
    names
        Names of variables, separated by spaces or commas.

    Returns
    -------
    tuple of Polynomial

    Examples
    --------
    >>> import reachtube as rt
    >>> q, qd, u = rt.variables("q qd u")
    """
    if not isinstance(names, str):
        raise SettingError(f"names is {names!r}; give one text, such as \"x y\"")
    each = names.replace(",", " ").split()
    return tuple(Polynomial({(((name, "x"), 1),): 1.0}) for name in each)


def _angle(polynomial: Polynomial, kind: str) -> Polynomial:
    name = variable_name(Polynomial.of(polynomial))
    if name is None:
        raise SettingError(f"{kind} of {polynomial}: give a single variable")
    return Polynomial({(((name, kind), 1),): 1.0})


def sin(angle: Polynomial) -> Polynomial:
    """Return the sine of a state.

    Parameters
    ----------
    angle
        A single variable, rad.

    Returns
    -------
    Polynomial

    Raises
    ------
    SettingError
        For a polynomial that is not a single variable.
    """
    return _angle(angle, "sin")


def cos(angle: Polynomial) -> Polynomial:
    """Return the cosine of a state.

    Parameters
    ----------
    angle
        A single variable, rad.

    Returns
    -------
    Polynomial

    Raises
    ------
    SettingError
        For a polynomial that is not a single variable.
    """
    return _angle(angle, "cos")


def variable_name(polynomial: Polynomial) -> str | None:
    """Return the name of a polynomial that is one variable."""
    if list(polynomial._terms.values()) != [1.0]:
        return None
    [monomial] = polynomial._terms
    if len(monomial) != 1:
        return None
    [((name, kind), exponent)] = monomial
    return name if (kind, exponent) == ("x", 1) else None
