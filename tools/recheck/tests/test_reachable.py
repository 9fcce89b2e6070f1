"""Reachable sets against closed forms."""

import math
from types import SimpleNamespace

import numpy
import pytest
import toy

from recheck.balls import arb
from recheck.grid import Grid
from recheck.model import Box
from recheck.reachable import samples
from recheck.system import System


def model_of(a, b, disturbance, r_u=1.0):
    """Returns a model with X0 = 0 and U of this radius."""
    joints = len(b[0])
    return SimpleNamespace(
        joints=joints, a=a, b=b, drift=[0.0] * (2 * joints),
        initial_set=Box((0.0,) * (2 * joints), (0.0,) * (2 * joints)),
        input_set=Box((0.0,) * joints, (r_u,) * joints),
        settings={"disturbance": disturbance},
    )


def last(model, grid):
    """Returns the last sample of the model without an input."""
    joints = model.joints
    case = SimpleNamespace(grid=grid, start=[0.0] * (2 * joints), doubt=[0.0] * joints,
                           inputs=[[0.0] * joints] * len(grid))
    *_, found = samples(model, System(model), grid, [case])
    return found


@pytest.mark.parametrize(("disturbance", "position", "velocity"), [
    ("constant", 0.0, 0.0), ("measurable", 4.0, 4.0),
])
def test_a_turn_of_the_oscillator(disturbance, position, velocity):
    """q'' = u - q has the kernels sin and cos: over a turn kappa is 4, and |Gamma| is 0."""
    model = model_of([[0.0, 1.0], [-1.0, 0.0]], [[0.0], [1.0]], disturbance)
    found = last(model, Grid(tuple(2 * math.pi * k / 7 for k in range(8)), None))
    assert abs(found.radius[0, 0] - position) < 1e-14
    assert abs(found.radius[1, 0] - velocity) < 1e-14
    # The bounds are proved, and narrow: all digits of a double are known.
    assert found.radius[1, 0].rad() < 1e-30


@pytest.mark.parametrize("step", [None, 0.125])
def test_the_damped_joints_in_closed_form(step):
    model = model_of(toy.CONTENT["a"], toy.CONTENT["b"], "sample")
    times = tuple(k * 0.125 for k in range(9))
    found = last(model, Grid(times, step))
    phi, gamma = toy.exact_step(1.0)
    as_numbers = [numpy.array([[float(x) for x in row] for row in m.tolist()])
                  for m in (found.e, found.gamma)]
    assert numpy.abs(as_numbers[0] - phi).max() < 1e-14
    assert numpy.abs(as_numbers[1] - gamma).max() < 1e-14
    # The kernels keep their signs, so that kappa is |Gamma| in every class.
    radius = numpy.array([float(x) for x in found.radius.entries()])
    assert numpy.abs(radius - numpy.abs(gamma).sum(axis=1)).max() < 1e-14


def test_a_drift_moves_the_nominal_solution():
    """q'' = d - v q' from rest: q' = d (1 - e^{-vt}) / v."""
    model = model_of([[0.0, 1.0], [0.0, -2.0]], [[0.0], [1.0]], "sample")
    model.drift = [0.0, 3.0]
    found = last(model, Grid(tuple(k * 0.25 for k in range(5)), 0.25))
    speed = 1.5 * -math.expm1(-2.0)
    assert float(found.nominal[1, 0]) == pytest.approx(speed, abs=1e-15)
    assert float(found.nominal[0, 0]) == pytest.approx(1.5 - speed / 2.0, abs=1e-15)


def test_even_and_uneven_grids_agree():
    """The running sum of a uniform grid and the increments of any other are two ways to kappa."""
    model = model_of([[0.0, 1.0], [-9.0, -0.2]], [[0.0], [1.0]], "sample")
    times = tuple(k * 0.125 for k in range(30))
    even, uneven = (last(model, Grid(times, step)) for step in (0.125, None))
    for i in range(2):
        assert even.radius[i, 0].overlaps(uneven.radius[i, 0])
        assert even.radius[i, 0].rad() < 1e-40


def test_the_classes_grow_in_their_order():
    a, b = [[0.0, 1.0], [-9.0, -0.2]], [[0.0], [1.0]]
    grid = Grid(tuple(k * 0.25 for k in range(20)), 0.25)
    constant, sample, measurable = (
        last(model_of(a, b, name), grid).radius for name in ("constant", "sample", "measurable")
    )
    for i in range(2):
        assert constant[i, 0] < sample[i, 0] < measurable[i, 0]


def test_a_double_root_is_integrated():
    """q'' = u with u switching late: the kernel of the position is t, the kernel of q' is 1."""
    model = model_of([[0.0, 1.0], [0.0, 0.0]], [[0.0], [1.0]], "measurable", r_u=3.0)
    found = last(model, Grid((0.0, 0.5, 2.0), None))
    assert abs(found.radius[0, 0] - 6) < arb(2) ** -100
    assert abs(found.radius[1, 0] - 6) < arb(2) ** -100
