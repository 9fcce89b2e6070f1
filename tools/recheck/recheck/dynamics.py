"""The equations of motion of a robot, by Newton and Euler in the base frame, in plain doubles.

Link i turns with w and w', and a point of it has the acceleration s. With its mass m, its first
moment h and its inertia I about the origin p of its frame, the link needs

    F = m p'' + w' x h + w x (w x h)             in total
    N = I w' + w x (I w) + h x p'' + p x F       about the base's origin

Joint i, whose axis a passes through o, bears the sum of the links beyond it: a . (N - o x F) if it
is revolute, a . F if it is prismatic.
"""

import numpy

from .robot import viscous_torque


def _row(values):
    return numpy.array(values, dtype=float)


class Dynamics:
    """The equations (10), M q'' + c(q, q') + viscous friction = u, of a robot."""

    def __init__(self, robot):
        self.robot = robot
        self.links = [_link(joint) for joint in robot.joints]
        self.motors = numpy.array([_motor_inertia(joint) for joint in robot.joints])

    def acceleration(self, q, qd, u):
        """Returns q'' under the input `u`."""
        places = self.robot.places(q)
        n = len(self.links)
        unit, still = numpy.eye(n), numpy.zeros(n)
        mass = [self._torque(places, still, unit[j]) for j in range(n)]
        mass = numpy.array(mass).T + numpy.diag(self.motors)
        friction = [viscous_torque(self.robot.viscous(j), qd[j]) for j in range(n)]
        rest = numpy.array(u) - self._torque(places, qd, still) - numpy.array(friction)
        return numpy.linalg.solve(mass, rest)

    def _torque(self, places, qd, qdd):
        """The joint torques without gravity, motors and friction."""
        turn, turning = numpy.zeros(3), numpy.zeros(3)
        point, moving = numpy.zeros(3), numpy.zeros(3)
        forces, moments = [], []
        for j, (axis, joint_at, rotation, origin) in enumerate(places):
            moving = moving + _relative(turn, turning, joint_at - point)
            point = joint_at
            if self.robot.is_prismatic(j):
                moving = moving + 2.0 * numpy.cross(turn, axis * qd[j]) + axis * qdd[j]
            else:
                turning = turning + numpy.cross(turn, axis * qd[j]) + axis * qdd[j]
                turn = turn + axis * qd[j]
            mass, moment, inertia = self.links[j]
            h, about = rotation @ moment, rotation @ inertia @ rotation.T
            at_origin = moving + _relative(turn, turning, origin - point)
            force = mass * at_origin + _relative(turn, turning, h)
            own = about @ turning + numpy.cross(turn, about @ turn) + numpy.cross(h, at_origin)
            forces.append(force)
            moments.append(own + numpy.cross(origin, force))
        torques, force, about_base = numpy.zeros(len(places)), numpy.zeros(3), numpy.zeros(3)
        for j in reversed(range(len(places))):
            force, about_base = force + forces[j], about_base + moments[j]
            axis, joint_at = places[j][:2]
            is_prismatic = self.robot.is_prismatic(j)
            bears = force if is_prismatic else about_base - numpy.cross(joint_at, force)
            torques[j] = axis @ bears
        return torques


def _relative(turn, turning, arm):
    """The acceleration of the end of an arm of a turning body, relative to its beginning."""
    return numpy.cross(turning, arm) + numpy.cross(turn, numpy.cross(turn, arm))


def _link(joint):
    """Mass, first moment, and inertia about the origin of a link's frame."""
    mass = joint.get("mass", 0.0)
    moment = joint.get("first_moment")
    centre = joint.get("com") or [0.0, 0.0, 0.0]
    moment = _row(moment) if moment else mass * _row(centre)
    xx, xy, xz, yy, yz, zz = joint.get("inertia") or [0.0] * 6
    inertia = numpy.array([[xx, xy, xz], [xy, yy, yz], [xz, yz, zz]])
    if joint.get("about", "com") == "com" and mass != 0.0:
        centre = moment / mass
        inertia = inertia + mass * (centre @ centre * numpy.eye(3) - numpy.outer(centre, centre))
    return mass, moment, inertia


def _motor_inertia(joint):
    """The motor's inertia on the link's side."""
    if joint.get("armature") is not None:
        return joint["armature"]
    return (joint.get("gear_ratio") or 0.0) ** 2 * (joint.get("rotor_inertia") or 0.0)
