"""Reachable sets of a linear model at the samples of one grid, in balls."""

from dataclasses import dataclass

from .balls import arb, arb_mat, column, identity, magnitudes, zeros
from .gains import gains


@dataclass(frozen=True)
class Sample:
    """What is known at one sample.

    Case c is in the interval hull [x - r, x + r] with x = nominal[i, c] + centre[i] and
    r = radius[i]; with a doubtful input, x lies within doubt[i, c] of that.
    """

    k: int
    e: arb_mat
    gamma: arb_mat
    nominal: arb_mat
    centre: arb_mat
    # The gains kappa of the disturbance.
    gain: arb_mat
    radius: arb_mat
    doubt: arb_mat | None


def samples(model, system, grid, cases):
    """Yields the sample after sample of the cases, whose grids are the beginning of `grid`.

    With phi and gamma of a span h, e^{A(t+h)} = phi e^{At}, Gamma(t+h) = phi Gamma(t) + gamma,
    and the nominal motion goes on as x <- phi x + gamma u + drift.
    """
    e, gamma = identity(system.states), zeros(system.states, system.inputs)
    kappa = gains(model.settings["disturbance"], system, grid)
    is_doubtful = any(max(case.doubt) > 0.0 for case in cases)
    held = kappa
    if is_doubtful and model.settings["disturbance"] == "constant":
        held = gains("sample", system, grid)
    doubts = _columns([case.doubt for case in cases])
    nominal = _columns([case.start for case in cases])
    (c_x, r_x), (c_u, r_u) = (
        (column(box.centre), column(box.radius)) for box in (model.initial_set, model.input_set)
    )
    for k in range(len(grid)):
        gain = kappa.value(gamma)
        yield Sample(
            k, e, gamma, nominal,
            centre=e * c_x + gamma * c_u,
            gain=gain,
            radius=magnitudes(e) * r_x + gain * r_u,
            doubt=held.value(gamma) * doubts if is_doubtful else None,
        )
        if k + 1 == len(grid):
            return
        span = grid.span(k)
        step = system.step(span)
        for one in {id(kappa): kappa, id(held): held}.values():
            one.advance(e, step, span)
        inputs = _columns([_input(case, k, system.inputs) for case in cases])
        drifts = step.drift * arb_mat(1, len(cases), [1] * len(cases))
        nominal = step.phi * nominal + step.gamma * inputs + drifts
        e, gamma = step.phi * e, step.phi * gamma + step.gamma


def _columns(vectors):
    """Returns the matrix with these columns of doubles."""
    return arb_mat([[arb(vector[i]) for vector in vectors] for i in range(len(vectors[0]))])


def _input(case, k, joints):
    """The input of a case that acts after sample k; 0 after its end."""
    return case.inputs[k] if k + 1 < len(case.grid) else [0.0] * joints
