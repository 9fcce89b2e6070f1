"""Gravity and friction in closed form."""

import math

import pytest
import toy

from recheck.robot import Robot, coulomb_torque, quadrant, softened_coulomb_torque


def test_gravity_of_two_links_in_a_plane():
    """Links of 1 m, centres of mass at 0.5 m and 0.75 m, gravity along -y."""
    robot, (q1, q2) = Robot(toy.ROBOT), (0.4, -1.1)
    second = 1.0 * 10.0 * 0.75 * math.cos(q1 + q2)
    first = 10.0 * (2.0 * 0.5 + 1.0) * math.cos(q1) + second
    assert robot.gravity_torque([q1, q2]) == pytest.approx([first, second], abs=1e-13)
    tip = [10.0 * (math.cos(q1) + math.cos(q1 + q2)), 10.0 * math.cos(q1 + q2)]
    assert robot.payload_torque([q1, q2]) == pytest.approx(tip, abs=1e-13)


def test_a_slide_carries_its_link_and_a_hinge_with_an_axis():
    """A vertical slide, then a hinge about y with a mass at (1, 0, 0)."""
    robot = Robot({"joint": [
        {"name": "z", "type": "prismatic", "mass": 3.0,
         "placement": {"rpy": [0.0, 0.0, 1.0], "translation": [0.1, 0.2, 0.3]}},
        {"name": "y", "axis": [0.0, 2.0, 0.0], "mass": 2.0, "first_moment": [2.0, 0.0, 0.0]},
    ]})
    found = robot.gravity_torque([0.7, 0.3])
    # A positive turn about y lowers a mass on the x axis.
    assert found == pytest.approx([9.81 * 5.0, -9.81 * 2.0 * math.cos(0.3)], abs=1e-13)


def test_both_conventions_describe_the_same_arm():
    """Standard and modified parameters of a twisted link, with the mass at the joint's side."""
    standard = Robot({"joint": [
        {"name": "a", "dh": {"alpha": math.pi / 2, "d": 0.4}},
        {"name": "b", "dh": {"a": 0.5}, "mass": 1.0},
    ]})
    modified = Robot({"convention": "modified", "joint": [
        {"name": "a", "dh": {"d": 0.4}},
        {"name": "b", "dh": {"alpha": math.pi / 2}, "mass": 1.0, "com": [0.5, 0.0, 0.0]},
    ]})
    q = [0.3, 0.8]
    expected = [0.0, 9.81 * 0.5 * math.cos(0.8)]
    assert standard.gravity_torque(q) == pytest.approx(expected, abs=1e-13)
    assert modified.gravity_torque(q) == pytest.approx(expected, abs=1e-13)


def test_friction_has_four_quadrants_and_none_at_rest():
    a = [1.0, 0.1, -2.0, 0.2, -3.0, 0.3, 4.0, 0.4]
    places = [quadrant(load, speed) for load, speed in [(5, 1), (-5, -1), (5, -1), (-5, 1)]]
    assert places == [0, 1, 2, 3]
    assert coulomb_torque(a, 5.0, 1.0) == 1.5
    assert coulomb_torque(a, -5.0, 1.0) == 2.0
    assert coulomb_torque(a, 0.0, 1.0) == 4.0 and coulomb_torque(a, 0.0, -1.0) == -3.0
    assert coulomb_torque(a, 5.0, 0.0) == 0.0


def test_softened_friction_meets_the_quadrants_and_has_no_steps():
    # The mean friction at no load is 2.5, so that braking passes to driving within 1.25.
    a = [1.0, 0.1, -2.0, 0.2, -3.0, 0.3, 4.0, 0.4]
    for load in (-5.0, -1.25, 1.25, 5.0):
        for speed in (-0.3, -0.02, 0.02, 0.3):
            assert softened_coulomb_torque(a, load, speed) == coulomb_torque(a, load, speed)
    assert softened_coulomb_torque(a, 0.0, 0.3) == 2.5
    assert softened_coulomb_torque(a, 0.625, 0.3) == 0.75 * 1.0625 + 0.25 * 4.25
    assert softened_coulomb_torque(a, 5.0, 0.01) == 0.75
    assert softened_coulomb_torque(a, 5.0, 0.3, (0.5, 0.0, 0.0, 0.0)) == 0.75
