"""Equations of motion in closed form."""

import math

import numpy
import pytest

from recheck.dynamics import Dynamics
from recheck.robot import Robot


def test_two_links_in_a_plane():
    """Links of 1 m, centres of mass at 0.5 m and 0.75 m, a motor and viscous friction."""
    robot = Robot({"joint": [
        {"name": "j1", "dh": {"a": 1.0}, "mass": 2.0, "com": [-0.5, 0.0, 0.0],
         "inertia": [0.0, 0.0, 0.0, 0.0, 0.0, 0.3], "armature": 0.7},
        {"name": "j2", "dh": {"a": 1.0}, "mass": 1.0, "first_moment": [-0.25, 0.0, 0.0],
         "inertia": [0.0, 0.0, 0.0, 0.0, 0.0, 0.1 + 0.25**2], "about": "origin",
         "gear_ratio": 10.0, "rotor_inertia": 0.002,
         "friction": {"viscous": [0.5, 0.1, 0.2]}},
    ]})
    q, (v1, v2), u = [0.4, -1.1], (0.9, -1.7), [2.0, -0.6]
    c, s = math.cos(q[1]), math.sin(q[1])
    second = 0.1 + 0.75**2
    mass = [
        [0.7 + 0.3 + 2.0 * 0.25 + second + 1.0 + 1.5 * c, second + 0.75 * c],
        [second + 0.75 * c, second + 100.0 * 0.002],
    ]
    coriolis = [-0.75 * s * (2.0 * v1 * v2 + v2**2), 0.75 * s * v1**2]
    friction = [0.0, 0.5 * v2 + 0.1 * v2**2 + 0.2 * v2**3]
    rest = [a - b - d for a, b, d in zip(u, coriolis, friction, strict=True)]
    expected = numpy.linalg.solve(mass, rest)
    assert Dynamics(robot).acceleration(q, [v1, v2], u) == pytest.approx(expected, abs=1e-13)


def test_a_slide_on_a_turning_arm():
    """A mass of 2 kg slides along a horizontal arm that turns about the vertical."""
    robot = Robot({"joint": [
        {"name": "turn", "inertia": [0.0, 0.0, 0.0, 0.0, 0.0, 0.4]},
        {"name": "slide", "type": "prismatic", "axis": [1.0, 0.0, 0.0], "mass": 2.0},
    ]})
    reach, turning, sliding, u = 0.8, 1.5, -0.6, [3.0, 1.0]
    expected = [
        (u[0] - 4.0 * reach * turning * sliding) / (0.4 + 2.0 * reach**2),
        u[1] / 2.0 + reach * turning**2,
    ]
    found = Dynamics(robot).acceleration([0.3, reach], [turning, sliding], u)
    assert found == pytest.approx(expected, abs=1e-13)


def test_energy_of_an_arm_in_space_is_kept():
    """Without input and friction, the kinetic energy q' M q' / 2 does not change."""
    inertia = [0.05, 0.01, 0.0, 0.04, -0.01, 0.03]
    joints = [
        {"name": f"j{j}", "dh": {"a": 0.3, "alpha": 1.1 * j - 1.0, "d": 0.2, "theta": 0.4},
         "mass": 1.0 + j, "com": [-0.1, 0.05, 0.02 * j], "inertia": inertia, "armature": 0.1}
        for j in range(3)
    ]
    dynamics = Dynamics(Robot({"convention": "modified", "joint": joints}))

    def rate(x):
        return numpy.concatenate([x[3:], dynamics.acceleration(x[:3], x[3:], [0.0] * 3)])

    def energy(x):
        rest = dynamics.acceleration(x[:3], numpy.zeros(3), numpy.zeros(3))
        assert rest == pytest.approx([0.0] * 3, abs=1e-14)
        columns = [dynamics.acceleration(x[:3], numpy.zeros(3), unit) for unit in numpy.eye(3)]
        return 0.5 * x[3:] @ numpy.linalg.solve(numpy.array(columns).T, x[3:])

    x, h = numpy.array([0.3, -0.7, 1.2, 0.8, -1.1, 0.5]), 0.005
    before = energy(x)
    for _ in range(60):
        a = rate(x)
        b = rate(x + 0.5 * h * a)
        c = rate(x + 0.5 * h * b)
        x = x + h / 6.0 * (a + 2.0 * b + 2.0 * c + rate(x + h * c))
    assert energy(x) == pytest.approx(before, rel=1e-8)
