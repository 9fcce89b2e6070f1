"""Reachable sets of polynomial systems."""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import Any, Literal

import numpy as np
import numpy.typing as npt

from . import _reachtube
from ._arrays import Array, check_choice, frozen, mapping, numbers, whole
from ._polynomial import Number, Polynomial, variable_name
from ._values import Values
from .errors import SettingError


#: Largest number of variables whose vertices are tried, all 2^v, and of pieces.
MOST_VERTEX_VARIABLES, MOST_PIECES = 24, 1_000_000

#: Exponents are bytes, and so is the order of Taylor models.
MOST_EXPONENT = 255

#: The order of Taylor models if none is given.
DEFAULT_ORDER = 4


@dataclass(frozen=True, eq=False, repr=False)
class Flowpipe(Values):
    """The reachable set of a polynomial system: a box at each sample and over each step.

    Outer, with directed rounding: every solution from a state in the initial set, under any input
    in the input set, is within the bounds, at samples and between them.

    Attributes
    ----------
    states
        Names of the states, N.
    t : array of shape (K,)
        Times since the first sample, s; they end early where ``ended`` says so.
    lower : array of shape (K, N)
        Lower bounds at samples.
    upper : array of shape (K, N)
        Upper bounds at samples.
    step_lower : array of shape (K - 1, N)
        Lower bounds over the steps from one sample to the next.
    step_upper : array of shape (K - 1, N)
        Upper bounds over the steps.
    ended
        The time, and the state whose bounds grew the most, if no enclosure could be verified
        further; ``None`` if the flowpipe reached the last sample.
    method
        ``"linearisation"`` or ``"taylor"``, chosen or given; ``None`` if older bytes lack it.
    taylor_order
        The order of the Taylor models.
    parts
        Number of equal parts of each step over which the sets were propagated.
    pieces
        Number of pieces of the initial set along each state; empty for one piece.
    """

    states: tuple[str, ...]
    t: Array
    lower: Array
    upper: Array
    step_lower: Array
    step_upper: Array
    ended: tuple[float, str] | None
    method: str | None = None
    taylor_order: int | None = None
    parts: int = 1
    pieces: tuple[int, ...] = ()

    @property
    def choice(self) -> str:
        """What method, parts of each step and pieces gave the sets, in words."""
        taylor = f"Taylor models of order {self.taylor_order}"
        chosen = [taylor if self.method == "taylor" else self.method or "unknown method"]
        if self.parts > 1:
            chosen.append(f"{self.parts} parts of each step")
        cut = zip(self.pieces, self.states, strict=False)
        chosen += [f"{count} pieces of {name}" for count, name in cut if count > 1]
        return ", ".join(chosen)

    @property
    def is_reached(self) -> bool:
        """Whether the flowpipe reached the last sample."""
        return self.ended is None

    def to_pandas(self) -> Any:
        """Return a pandas DataFrame: t, then lower and upper bound of each state at samples."""
        import pandas

        columns = {"t": self.t}
        for i, name in enumerate(self.states):
            columns[f"{name}_lower"] = self.lower[:, i]
            columns[f"{name}_upper"] = self.upper[:, i]
        return pandas.DataFrame(columns)

    def __repr__(self) -> str:
        end = "" if self.ended is None else f", ended at {self.ended[0]:g} s"
        return f"<Flowpipe of {', '.join(self.states)}: {len(self.t)} samples{end}; {self.choice}>"


def _terms(
    rates: Mapping[str, Polynomial | Number], inputs: Sequence[str]
) -> tuple[list[int], list[list[tuple[list[int], float]]]]:
    """Return the states that have sines or cosines, and the terms of each rate."""
    states = list(rates)
    polynomials = [Polynomial.of(rate) for rate in rates.values()]
    factors = {
        factor for rate in polynomials for monomial in rate.terms for factor, _ in monomial
    }
    known = {*states, *inputs}
    if unknown := sorted({name for name, _ in factors} - known):
        raise SettingError(
            f"{', '.join(unknown)}: neither a state ({', '.join(states)}) nor an input; give its "
            "rate, or its set in inputs"
        )
    turning = {name for name, kind in factors if kind != "x"}
    if wrong := sorted(turning - set(states)):
        raise SettingError(f"{', '.join(wrong)}: only states have sines and cosines")
    angles = [states.index(name) for name in states if name in turning]
    order = [(name, "x") for name in (*states, *inputs)]
    order += [(states[i], kind) for kind in ("sin", "cos") for i in angles]
    place = {factor: k for k, factor in enumerate(order)}

    for name, rate in zip(states, polynomials, strict=True):
        if not all(map(math.isfinite, rate.terms.values())):
            raise SettingError(f"the rate of {name} is {rate}; coefficients must be finite")

    def exponents(monomial: Any) -> list[int]:
        powers = [0] * len(order)
        for factor, exponent in monomial:
            if exponent > MOST_EXPONENT:
                name = f"{factor[0]}" if factor[1] == "x" else f"{factor[1]} {factor[0]}"
                raise SettingError(
                    f"{name}^{exponent}: exponents are {MOST_EXPONENT} at most; substitute a "
                    "variable for a power"
                )
            powers[place[factor]] = exponent
        return powers

    terms = [
        [(exponents(monomial), value) for monomial, value in rate.terms.items()]
        for rate in polynomials
    ]
    return angles, terms


def _names(argument: str, given: Mapping[Any, Any]) -> dict[str, Any]:
    """Return a mapping whose keys are names of variables."""
    named = {}
    for key, value in mapping(argument, given).items():
        name = key if isinstance(key, str) else variable_name(Polynomial.of(key))
        if name is None:
            raise SettingError(f"{key} is no variable")
        named[name] = value
    return named


def _sides(sets: Mapping[str, Any], names: Sequence[str]) -> tuple[list[float], list[float]]:
    """Return middles and radii whose boxes hold the intervals, given as numbers or pairs."""
    centres, radii = [], []
    for name in names:
        if name not in sets:
            raise SettingError(f"{name} has no initial value; give a number or an interval")
        given = numbers(name, sets[name]).ravel()
        if given.size > 2 or not np.isfinite(given).all():
            raise SettingError(f"{name} is {given.tolist()}; give a finite number or an interval")
        low, high = np.broadcast_to(given, 2)
        if not low <= high:
            raise SettingError(f"{name} is in [{low}, {high}]; the lower bound comes first")
        centre = float(low + (high - low) / 2)
        radius = max(float(high) - centre, centre - float(low))
        # Differences are rounded to nearest: the next number is an upper bound of each.
        centres.append(centre)
        radii.append(0.0 if low == high else float(np.nextafter(radius, np.inf)))
    return centres, radii


def flowpipe(
    rates: Mapping[Any, Polynomial | Number],
    initial: Mapping[Any, npt.ArrayLike],
    t: npt.ArrayLike,
    *,
    inputs: Mapping[Any, npt.ArrayLike] | None = None,
    measured: Mapping[Any, npt.ArrayLike] | None = None,
    method: Literal["linearisation", "taylor"] | None = None,
    taylor_order: int | None = None,
    vertex_variables: int | None = None,
    order: int | None = None,
    pieces: Mapping[Any, int] | None = None,
) -> Flowpipe:
    """Compute the reachable set of a polynomial system ẋ = f(x, u).

    Parameters
    ----------
    rates
        The rate of each state, as a polynomial in states and inputs, and in sines and cosines of
        states.
    initial
        The initial set: an interval ``(low, high)`` or a number for each state.
    t : array of shape (K,)
        Sample times, s, which increase.
    inputs
        The set of each input: any measurable function with values in it.
    measured
        Measured inputs, arrays of shape (K,), held from sample to sample, about which the sets are;
        0 by default.
    method
        Conservative linearisation of zonotopes, for large inputs, or Taylor models in the initial
        state, for large initial sets. If neither it nor one of the last three settings is given,
        method, order, parts of each step and pieces are found by trial; the result names them.
    taylor_order
        The order of the Taylor models, for ``method="taylor"`` only; 4 if it is not given.
    vertex_variables
        Number of variables over whose vertices linearisation errors are bounded; not for Taylor
        models.
    order
        The most generators of a zonotope, in multiples of the states.
    pieces
        Number of pieces of the initial set along a state; 1 by default.

    Returns
    -------
    Flowpipe
        If no enclosure could be verified to the end, it ends early, as reported in ``ended``.

    Examples
    --------
    The Van der Pol oscillator:

    >>> import numpy as np, reachtube as rt
    >>> x, y = rt.variables("x y")
    >>> pipe = rt.flowpipe(
    ...     {x: y, y: (1 - x**2) * y - x},
    ...     {x: (1.39, 1.41), y: 2.4},
    ...     np.linspace(0.0, 1.0, 101),
    ... )
    >>> pipe.is_reached, pipe.choice
    (True, 'linearisation')
    """
    named, sets = _names("rates", rates), _names("inputs", inputs or {})
    starts = _names("initial", initial)
    if unknown := sorted(set(starts) - set(named)):
        raise SettingError(f"initial: {', '.join(unknown)} is no state ({', '.join(named)})")
    if both := sorted(set(sets) & set(named)):
        raise SettingError(f"inputs: {', '.join(both)} is a state, which has a rate")
    angles, terms = _terms(named, list(sets))
    times = numbers("t", t)
    if times.ndim != 1 or len(times) == 0:
        raise SettingError(f"t has the shape {times.shape}; give one axis of times")
    centre, radius = _sides(starts, list(named))
    input_centre, input_radius = _sides(sets, list(sets))
    along = _names("measured", measured or {})
    if unknown := sorted(set(along) - set(sets)):
        raise SettingError(f"measured: {', '.join(unknown)} is no input; give its set in inputs")
    columns = [
        np.broadcast_to(numbers(f"measured {name}", along.get(name, 0.0)), times.shape)
        for name in sets
    ]
    rows = np.array(columns, dtype=np.float64).T.reshape(len(times), len(sets))
    automatic = method is None and vertex_variables is None and order is None and not pieces
    if method is not None:
        check_choice("method", method, ("linearisation", "taylor"))
    if taylor_order is not None and method != "taylor":
        raise SettingError("taylor_order is of Taylor models; give method='taylor' too")
    if vertex_variables is not None and method == "taylor":
        raise SettingError("vertex_variables is of linearisation; give method='linearisation'")
    taylor = None
    if method == "taylor":
        given = DEFAULT_ORDER if taylor_order is None else taylor_order
        taylor = whole("taylor_order", given, 1, MOST_EXPONENT)
    parts = _names("pieces", pieces or {})
    if unknown := sorted(set(parts) - set(named)):
        raise SettingError(f"pieces: {', '.join(unknown)} is no state ({', '.join(named)})")
    cut = [whole(f"pieces of {name}", parts.get(name, 1), 1) for name in named] if parts else []
    if math.prod(cut) > MOST_PIECES:
        raise SettingError(f"pieces makes {math.prod(cut)} pieces; give {MOST_PIECES} at most")
    vertices = vertex_variables
    if vertices is not None:
        vertices = whole("vertex_variables", vertices, 0, MOST_VERTEX_VARIABLES)
    samples, steps, ended, (chosen, fine, along_states) = _reachtube.flowpipe(
        len(sets),
        angles,
        terms,
        times.tolist(),
        centre,
        radius,
        np.ascontiguousarray(rows),
        input_centre,
        input_radius,
        automatic,
        taylor,
        vertices,
        None if order is None else whole("order", order, 1),
        cut,
    )
    states, count = tuple(named), len(samples[0])
    return Flowpipe(
        states,
        frozen(times[:count] - times[0]),
        frozen(samples[0]),
        frozen(samples[1]),
        frozen(steps[0]),
        frozen(steps[1]),
        None if ended is None else (ended[0], states[ended[1]]),
        "linearisation" if chosen is None else "taylor",
        chosen,
        fine,
        tuple(along_states),
    )
