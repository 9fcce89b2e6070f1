"""Gravity and friction of a robot, from its description in the model file, in plain doubles.

Gravity is the derivative of the potential energy: a link with mass m and first moment h (about the
origin of its frame) pulls at joint i, whose axis a passes through o, with

    g_i = -gravity . (a x (p - m o))      revolute, with p = m origin + R h in the base
    g_i = -gravity . (a m)                prismatic
"""

import math

import numpy

# Coulomb friction of a correction has no steps: below this speed (rad/s or m/s) it is in proportion
# to the speed, and at loads below this part of the friction at no load it passes from braking to
# driving.
SLOW = 0.02
SMALL_LOAD = 0.5


def _product(a, b):
    b0, b1, b2 = b
    return [
        [x * p + y * q + z * r for p, q, r in zip(b0, b1, b2, strict=True)] for x, y, z in a
    ]


def _apply(a, x):
    x0, x1, x2 = x
    return [p * x0 + q * x1 + r * x2 for p, q, r in a]


def _plus(x, y):
    return [x[0] + y[0], x[1] + y[1], x[2] + y[2]]


def _dot(x, y):
    return x[0] * y[0] + x[1] * y[1] + x[2] * y[2]


def _cross(x, y):
    return [
        x[1] * y[2] - x[2] * y[1],
        x[2] * y[0] - x[0] * y[2],
        x[0] * y[1] - x[1] * y[0],
    ]


IDENTITY = [[1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]]


def _sin_cos(angle):
    """Angles within 1e-12 of a multiple of pi/2 are exactly that multiple (docs/robot.md)."""
    quarters = round(angle / (math.pi / 2))
    if abs(angle - quarters * (math.pi / 2)) <= 1e-12:
        return [(0.0, 1.0), (1.0, 0.0), (0.0, -1.0), (-1.0, 0.0)][quarters % 4]
    return math.sin(angle), math.cos(angle)


def _about_z(sine, cosine):
    return [[cosine, -sine, 0.0], [sine, cosine, 0.0], [0.0, 0.0, 1.0]]


def _about_x(sine, cosine):
    return [[1.0, 0.0, 0.0], [0.0, cosine, -sine], [0.0, sine, cosine]]


def _about_axis(axis, angle):
    """Rodrigues' rotation about a unit axis."""
    x, y, z = axis
    sine, cosine = math.sin(angle), math.cos(angle)
    rest = 1.0 - cosine
    return [
        [cosine + x * x * rest, x * y * rest - z * sine, x * z * rest + y * sine],
        [y * x * rest + z * sine, cosine + y * y * rest, y * z * rest - x * sine],
        [z * x * rest - y * sine, z * y * rest + x * sine, cosine + z * z * rest],
    ]


def _then(first, second):
    """The placement `second` within the placement `first`."""
    (rotation, origin), (turn, shift) = first, second
    return _product(rotation, turn), _plus(origin, _apply(rotation, shift))


def _geometry(joint, convention):
    """Placements before and after the joint's motion, and its axis."""
    if "dh" in joint:
        dh = {"a": 0.0, "alpha": 0.0, "theta": 0.0, "d": 0.0, **joint["dh"]}
        turn = (_about_z(*_sin_cos(dh["theta"])), [0.0, 0.0, 0.0])
        twist = (_about_x(*_sin_cos(dh["alpha"])), [0.0, 0.0, 0.0])
        if convention == "modified":
            before = _then(twist, (IDENTITY, [dh["a"], 0.0, 0.0]))
            after = _then(turn, (IDENTITY, [0.0, 0.0, dh["d"]]))
        else:
            before = (IDENTITY, [0.0, 0.0, 0.0])
            after = _then(_then(turn, (IDENTITY, [dh["a"], 0.0, dh["d"]])), twist)
        return before, [0.0, 0.0, 1.0], after
    placement = joint.get("placement", {})
    rotation = placement.get("rotation") or _of_rpy(placement.get("rpy") or [0.0, 0.0, 0.0])
    before = (rotation, placement.get("translation", [0.0, 0.0, 0.0]))
    axis = joint.get("axis") or [0.0, 0.0, 1.0]
    length = math.sqrt(_dot(axis, axis))
    return before, [x / length for x in axis], (IDENTITY, [0.0, 0.0, 0.0])


def _of_rpy(rpy):
    roll, pitch, yaw = rpy
    about_y = _about_axis([0.0, 1.0, 0.0], pitch)
    about_x = _about_x(math.sin(roll), math.cos(roll))
    return _product(_about_z(math.sin(yaw), math.cos(yaw)), _product(about_y, about_x))


class Robot:
    """A robot: gravity torques, and friction of each joint."""

    def __init__(self, description):
        convention = description.get("convention", "standard")
        self.gravity = description.get("gravity", [0.0, 0.0, -9.81])
        self.joints = description["joint"]
        self.geometry = [_geometry(joint, convention) for joint in self.joints]
        self.moments = [self._moment(joint) for joint in self.joints]
        self.payload = [(0.0, [0.0, 0.0, 0.0]) for _ in self.joints]
        self.payload[-1] = (1.0, [0.0, 0.0, 0.0])

    @staticmethod
    def _moment(joint):
        """Mass and first moment that gravity acts on."""
        if joint.get("gravity_moments"):
            return joint["gravity_moments"]["mass"], joint["gravity_moments"]["first_moment"]
        mass = joint.get("mass", 0.0)
        if joint.get("first_moment"):
            return mass, joint["first_moment"]
        return mass, [mass * x for x in joint.get("com") or [0.0, 0.0, 0.0]]

    def is_prismatic(self, j):
        """Returns whether joint `j` slides."""
        return self.joints[j].get("type") == "prismatic"

    def gravity_torque(self, q):
        """Gravity torques (N m) at the positions `q`."""
        return self._torque(q, self.moments)

    def payload_torque(self, q):
        """Gravity torques of 1 kg at the origin of the last link's frame."""
        return self._torque(q, self.payload)

    def places(self, q):
        """Axis and origin of each joint, then rotation and origin of its link, in the base."""
        return [tuple(numpy.array(x) for x in place) for place in self._places(q)]

    def _places(self, q):
        place, places = (IDENTITY, [0.0, 0.0, 0.0]), []
        for j, (before, axis, after) in enumerate(self.geometry):
            place = _then(place, before)
            joint = (_apply(place[0], axis), place[1])
            if self.is_prismatic(j):
                motion = (IDENTITY, [q[j] * x for x in axis])
            else:
                motion = (_about_axis(axis, q[j]), [0.0, 0.0, 0.0])
            place = _then(_then(place, motion), after)
            places.append((*joint, *place))
        return places

    def _torque(self, q, moments):
        places = self._places(q)
        torques, mass, moment = [0.0] * len(q), 0.0, [0.0, 0.0, 0.0]
        for j in reversed(range(len(q))):
            axis, origin, rotation, link_at = places[j]
            own, first = moments[j]
            mass = mass + own
            moment = _plus(moment, _plus([own * x for x in link_at], _apply(rotation, first)))
            if self.is_prismatic(j):
                pull = [mass * x for x in axis]
            else:
                pull = _cross(axis, _plus(moment, [-mass * x for x in origin]))
            torques[j] = -_dot(self.gravity, pull)
        return torques

    def coulomb(self, j):
        """The coefficients a1 to a8 of joint `j`."""
        return self.joints[j].get("friction", {}).get("coulomb", [0.0] * 8)

    def viscous(self, j):
        """The coefficients v1 to v3 of joint `j`."""
        return self.joints[j].get("friction", {}).get("viscous", [0.0] * 3)

    def stribeck(self, j, velocity):
        """The Stribeck effect of joint `j` (N m)."""
        law = self.joints[j].get("friction", {}).get("stribeck")
        if not law or velocity == 0.0:
            return 0.0
        return math.copysign(law["excess"] * math.exp(-((velocity / law["speed"]) ** 2)), velocity)

    def warming(self, j):
        """The law by which friction of joint `j` changes, or None."""
        return self.joints[j].get("friction", {}).get("warming")


def quadrant(load, velocity):
    """Index of the quadrant: driving forward, driving backward, braking backward, forward."""
    if velocity > 0.0:
        return 0 if load > 0.0 else 3
    return 1 if load < 0.0 else 2


def coulomb_torque(coefficients, load, velocity):
    """Coulomb friction (N m); 0 at standstill."""
    if velocity == 0.0:
        return 0.0
    at = quadrant(load, velocity)
    offset, slope = coefficients[2 * at : 2 * at + 2]
    return offset + slope * load


def softened_coulomb_torque(coefficients, load, velocity, parts=(1.0, 1.0, 1.0, 1.0)):
    """Coulomb friction (N m) without steps, with each quadrant in these parts: in proportion to
    the velocity near standstill, and from braking to driving in proportion to a small load."""
    lines = [
        part * (coefficients[2 * at] + coefficients[2 * at + 1] * load)
        for at, part in enumerate(parts)
    ]
    driving, braking = (lines[0], lines[3]) if velocity > 0.0 else (lines[1], lines[2])
    small = SMALL_LOAD * sum(abs(offset) for offset in coefficients[::2]) / 4.0
    along = load if velocity > 0.0 else -load
    if abs(along) < small:
        share = 0.5 + 0.5 * along / small
    else:
        share = 1.0 if along > 0.0 else 0.0
    return min(abs(velocity) / SLOW, 1.0) * (share * driving + (1.0 - share) * braking)


def viscous_torque(coefficients, velocity):
    """Viscous friction v1 x + v2 x^2 + v3 x^3 (N m)."""
    v1, v2, v3 = coefficients
    return ((v3 * velocity + v2) * velocity + v1) * velocity
