"""Robots and their dynamics."""

from __future__ import annotations

import json
from collections.abc import Mapping
from os import PathLike, fspath
from pathlib import Path
from typing import Any

import numpy as np
import numpy.typing as npt

from . import _reachtube
from ._arrays import Array, batch, real
from ._files import write_new
from .errors import SettingError


def native_of(robot: Robot) -> _reachtube.Robot:
    """Return the native part of a robot."""
    if not isinstance(robot, Robot):
        kind = type(robot).__name__
        raise SettingError(f"the robot is of type {kind}; give a Robot, such as Robot.load(PATH)")
    return robot._native


def _locks(lock: Mapping[str, float] | None) -> list[str]:
    """Return locked joints as the command takes them."""
    if not isinstance(lock or {}, Mapping):
        raise SettingError(f"lock is {lock!r}; give the positions of joints by their names")
    return [f"{joint}={real(joint, position)!r}" for joint, position in (lock or {}).items()]


class Robot:
    """A robot: geometry, inertia and friction of its joints.

    Angles are in rad, prismatic joints in m; torques are in N m, forces in N. Arguments of the
    dynamics have the shape ``(..., n)`` and are broadcast against each other, so that one call
    computes many states, on all cores.

    Examples
    --------
    >>> import reachtube as rt
    >>> robot = rt.Robot.lwa4p()
    >>> robot.joints, robot.rnea([0.1] * 6, [0.0] * 6, [0.0] * 6).shape
    (6, (6,))
    """

    __slots__ = ("_description", "_native", "_source")

    def __init__(self, native: _reachtube.Robot) -> None:
        if not isinstance(native, _reachtube.Robot):
            raise SettingError(
                "Robot.load(PATH) reads a robot file, a URDF or an embedded robot, and "
                f"Robot.from_dict a description; Robot was given {native!r:.100}"
            )
        self._native = native
        # What a file of choices says of the robot.
        self._source: dict[str, Any] = {}
        self._description: dict[str, Any] = json.loads(native.description())

    @classmethod
    def lwa4p(cls) -> Robot:
        """Return the Schunk LWA 4P of Liu and Althoff (IROS 2018)."""
        return cls.load("lwa4p")

    @classmethod
    def load(
        cls, path: str | PathLike[str], *, lock: Mapping[str, float] | None = None
    ) -> Robot:
        """Load an embedded robot by its name, or a TOML or URDF file by its path.

        Parameters
        ----------
        path
            ``"lwa4p"``, or the path of a file.
        lock
            Joints that are held at a position, in rad or m.

        Returns
        -------
        Robot

        Raises
        ------
        ReachtubeError
            With file, line, joint and remedy.
        """
        locks = _locks(lock)
        robot = cls(_reachtube.Robot.load(fspath(path), None, None, locks))
        robot._source = {"robot": fspath(path), "lock": locks}
        return robot

    @classmethod
    def from_urdf(
        cls,
        path: str | PathLike[str],
        *,
        base: str | None = None,
        tip: str | None = None,
        lock: Mapping[str, float] | None = None,
    ) -> Robot:
        """Load a URDF, and the TOML file of the same name beside it if there is one.

        Parameters
        ----------
        path
            A file whose name ends with ``.urdf``.
        base
            First link of the chain, if the URDF has several chains.
        tip
            Last link of the chain, likewise.
        lock
            Joints that are held at a position, in rad or m.

        Returns
        -------
        Robot

        Raises
        ------
        SettingError
            For a file whose name does not end with ``.urdf``.
        ReachtubeError
            With file, line, element and remedy.
        """
        if not fspath(path).lower().endswith((".urdf", ".xacro")):
            raise SettingError(
                f"{fspath(path)}: the name of a URDF ends with .urdf; Robot.load reads robot files "
                "in TOML and embedded robots"
            )
        locks = _locks(lock)
        robot = cls(_reachtube.Robot.load(fspath(path), base, tip, locks))
        if base is None and tip is None:
            robot._source = {"robot": fspath(path), "lock": locks}
        return robot

    @classmethod
    def from_toml(cls, text: str, origin: str = "text") -> Robot:
        """Read the text of a robot file.

        Parameters
        ----------
        text
            The text, in TOML.
        origin
            The name of the text in errors.

        Returns
        -------
        Robot

        Raises
        ------
        ReachtubeError
            With origin, line, joint and remedy.
        """
        return cls(_reachtube.Robot.from_toml(text, origin))

    @classmethod
    def from_dict(cls, description: Mapping[str, Any]) -> Robot:
        """Make a robot of its description.

        Parameters
        ----------
        description
            The description, as `to_dict` returns it.

        Returns
        -------
        Robot

        Raises
        ------
        SettingError
            For a description that has no form of a robot.
        ReachtubeError
            For values that no robot has, with joint and remedy.
        """
        if not isinstance(description, Mapping):
            raise SettingError(f"the description is of type {type(description).__name__}")
        try:
            text = json.dumps(dict(description), allow_nan=False)
        except (TypeError, ValueError) as error:
            raise SettingError(f"the description: {error}") from None
        return cls(_reachtube.Robot.from_description(text))

    def to_toml(self) -> str:
        """Return the text of a robot file."""
        return self._native.to_toml()

    def to_dict(self) -> dict[str, Any]:
        """Return the description as a new dictionary."""
        description: dict[str, Any] = json.loads(self._native.description())
        return description

    def save(self, path: str | PathLike[str], *, force: bool = False) -> None:
        """Write a robot file, whole or not at all.

        Parameters
        ----------
        path
            The file, in TOML; its folder is made if it does not exist.
        force
            Whether a file that exists is replaced.

        Raises
        ------
        ReachtubeError
            If the file exists and ``force`` is false, or cannot be written.
        """
        write_new(Path(path), self.to_toml(), force=force)

    @property
    def name(self) -> str:
        """The robot's name."""
        return str(self._description["name"])

    @property
    def joints(self) -> int:
        """The number of joints n."""
        return len(self._description["joint"])

    @property
    def joint_names(self) -> list[str]:
        """The names of the joints, n."""
        return [str(joint["name"]) for joint in self._description["joint"]]

    def rnea(self, q: npt.ArrayLike, qd: npt.ArrayLike, qdd: npt.ArrayLike) -> Array:
        """Return the link-side torque of a motion, by recursive Newton-Euler.

        Parameters
        ----------
        q : array of shape (..., n)
            Positions, rad.
        qd : array of shape (..., n)
            Velocities, rad/s.
        qdd : array of shape (..., n)
            Accelerations, rad/s².

        Returns
        -------
        array of shape (..., n)
            M(q) q̈ + c(q, q̇) + g(q), motor inertia included, without friction.
        """
        shape, [q, qd, qdd] = batch(self.joints, q=q, qd=qd, qdd=qdd)
        return self._native.rnea(q, qd, qdd).reshape((*shape, self.joints))

    def aba(self, q: npt.ArrayLike, qd: npt.ArrayLike, tau: npt.ArrayLike) -> Array:
        """Return the acceleration under a link-side torque, by articulated bodies.

        Parameters
        ----------
        q : array of shape (..., n)
            Positions, rad.
        qd : array of shape (..., n)
            Velocities, rad/s.
        tau : array of shape (..., n)
            Link-side torques, N m.

        Returns
        -------
        array of shape (..., n)
            The inverse of `rnea`.
        """
        shape, [q, qd, tau] = batch(self.joints, q=q, qd=qd, tau=tau)
        return self._native.aba(q, qd, tau).reshape((*shape, self.joints))

    def crba(self, q: npt.ArrayLike) -> Array:
        """Return the mass matrix with motor inertia, by composite rigid bodies.

        Parameters
        ----------
        q : array of shape (..., n)
            Positions, rad.

        Returns
        -------
        array of shape (..., n, n)
            Inertia, kg m² (kg for prismatic joints).
        """
        n = self.joints
        shape, [q] = batch(n, q=q)
        return self._native.mass_matrix(q).reshape((*shape, n, n))

    def gravity(self, q: npt.ArrayLike) -> Array:
        """Return the torque of gravity.

        Parameters
        ----------
        q : array of shape (..., n)
            Positions, rad.

        Returns
        -------
        array of shape (..., n)
            Torques, N m.
        """
        shape, [q] = batch(self.joints, q=q)
        return self._native.gravity(q).reshape((*shape, self.joints))

    def coriolis(self, q: npt.ArrayLike, qd: npt.ArrayLike) -> Array:
        """Return the torque of Coriolis and centrifugal forces c(q, q̇).

        Parameters
        ----------
        q : array of shape (..., n)
            Positions, rad.
        qd : array of shape (..., n)
            Velocities, rad/s.

        Returns
        -------
        array of shape (..., n)
            Torques, N m.
        """
        shape, [q, qd] = batch(self.joints, q=q, qd=qd)
        return self._native.coriolis(q, qd).reshape((*shape, self.joints))

    def viscous_friction(self, qd: npt.ArrayLike) -> Array:
        """Return the torque of viscous friction.

        Parameters
        ----------
        qd : array of shape (..., n)
            Velocities, rad/s.

        Returns
        -------
        array of shape (..., n)
            Torques, N m.
        """
        shape, [qd] = batch(self.joints, qd=qd)
        viscous, _ = self._native.friction(np.zeros_like(qd), qd)
        return viscous.reshape((*shape, self.joints))

    def coulomb_friction(self, q: npt.ArrayLike, qd: npt.ArrayLike) -> Array:
        """Return the torque of dry friction under the load of gravity.

        Parameters
        ----------
        q : array of shape (..., n)
            Positions, rad.
        qd : array of shape (..., n)
            Velocities, rad/s.

        Returns
        -------
        array of shape (..., n)
            Torques, N m.
        """
        shape, [q, qd] = batch(self.joints, q=q, qd=qd)
        _, coulomb = self._native.friction(q, qd)
        return coulomb.reshape((*shape, self.joints))

    def regressor(self, q: npt.ArrayLike, qd: npt.ArrayLike, qdd: npt.ArrayLike) -> Array:
        """Return the matrix Y of ``rnea(q, qd, qdd) = Y @ parameter_values``.

        Parameters
        ----------
        q : array of shape (..., n)
            Positions, rad.
        qd : array of shape (..., n)
            Velocities, rad/s.
        qdd : array of shape (..., n)
            Accelerations, rad/s².

        Returns
        -------
        array of shape (..., n, p)
            One column for each of `parameter_names`.
        """
        shape, [q, qd, qdd] = batch(self.joints, q=q, qd=qd, qdd=qdd)
        found = self._native.regressor(q, qd, qdd)
        return found.reshape((*shape, *found.shape[1:]))

    @property
    def parameter_names(self) -> list[str]:
        """The names of the regressor's columns: inertia of links and motors."""
        return self._native.parameters()[0]

    @property
    def parameter_values(self) -> Array:
        """The values of these parameters in the description, p, in SI units."""
        return np.array(self._native.parameters()[1])

    def __eq__(self, other: object) -> bool:
        return isinstance(other, Robot) and other._description == self._description

    def __hash__(self) -> int:
        return hash(self._native.description())

    def __repr__(self) -> str:
        return f"<Robot {self.name}: {self.joints} joints, {', '.join(self.joint_names)}>"

    def __reduce__(self) -> tuple[Any, ...]:
        return Robot.from_dict, (self._description,)
