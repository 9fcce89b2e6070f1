"""Models 1, 2 and 3 of a robot's forward dynamics."""

from __future__ import annotations

import json
from os import PathLike, fspath
from pathlib import Path
from typing import Any, Literal

import numpy.typing as npt

from . import _reachtube
from ._arrays import Array, batch, finite, numbers, whole
from ._files import read_text, write_new
from ._progress import Progress, shown
from ._robot import Robot, native_of
from .errors import SettingError


#: Exponents are bytes.
MOST_ORDER = 255


class Abstraction:
    """A polynomial model of a robot's forward dynamics ẋ = f(x, u)."""

    __slots__ = ("_content", "_native")

    def __init__(self, native: _reachtube.Abstraction) -> None:
        if not isinstance(native, _reachtube.Abstraction):
            raise SettingError(
                "abstract(robot) makes an abstraction, and Abstraction.load(PATH) reads its file; "
                f"Abstraction was given {native!r:.100}"
            )
        self._native = native
        self._content: dict[str, Any] = json.loads(native.to_json())

    @classmethod
    def load(cls, path: str | PathLike[str]) -> Abstraction:
        """Read a file that `save` or ``reachtube abstract --out`` wrote.

        Parameters
        ----------
        path
            The file.

        Returns
        -------
        Abstraction

        Raises
        ------
        ModelFileError
            For another file, one of another version, or one that was changed.
        """
        text = read_text(path, "abstract")
        return cls(_reachtube.Abstraction.parse(text, fspath(path)))

    def save(self, path: str | PathLike[str], *, force: bool = False) -> None:
        """Write the model's file, whole or not at all.

        Parameters
        ----------
        path
            The file, in JSON; its folder is made if it does not exist.
        force
            Whether a file that exists is replaced.

        Raises
        ------
        ReachtubeError
            If the file exists and ``force`` is false, or cannot be written.
        """
        write_new(Path(path), self._native.to_json(), force=force)

    @property
    def model(self) -> int:
        """Model 1, 2 or 3 of the paper."""
        return int(self._content["model"])

    @property
    def order(self) -> int:
        """The order of its Taylor polynomials."""
        return int(self._content["order"])

    @property
    def joints(self) -> int:
        """The number of joints n."""
        return len(self._content["robot"]["joint"])

    @property
    def variables(self) -> list[str]:
        """The names of the polynomials' variables."""
        return [str(name) for name in self._content["variables"]]

    @property
    def robot(self) -> Robot:
        """The robot."""
        return Robot.from_dict(self._content["robot"])

    def formulas(self) -> str:
        """Return the model as formulas, one for each joint."""
        return self._native.formulas()

    def state(self, q: npt.ArrayLike, qd: npt.ArrayLike) -> Array:
        """Return the model's state at positions and velocities.

        Parameters
        ----------
        q : array of shape (..., n)
            Positions, rad (m for prismatic joints).
        qd : array of shape (..., n)
            Velocities, rad/s (m/s for prismatic joints).

        Returns
        -------
        array of shape (..., N)
            N is 2n, or 4n if the model has sines and cosines among its states.
        """
        shape, [q, qd] = batch(self.joints, q=q, qd=qd)
        found = self._native.states(q, qd)
        return found.reshape((*shape, found.shape[1]))

    def rate(self, x: npt.ArrayLike, u: npt.ArrayLike) -> Array:
        """Return ẋ = f(x, u).

        Parameters
        ----------
        x : array of shape (..., N)
            States, as `state` returns them.
        u : array of shape (..., n)
            Inputs, N m (N for prismatic joints), with the same leading axes as the states.

        Returns
        -------
        array of shape (..., N)
            In the units of the states per second.
        """
        states, inputs = numbers("x", x), numbers("u", u)
        if states.ndim == 0 or states.shape[:-1] != inputs.shape[:-1]:
            raise SettingError(
                f"x has the shape {states.shape} and u {inputs.shape}; all axes but the last must "
                "be the same"
            )
        flat = states.reshape(-1, states.shape[-1])
        found = self._native.rate(flat, inputs.reshape(len(flat), inputs.shape[-1]))
        return found.reshape(states.shape)

    def __eq__(self, other: object) -> bool:
        return isinstance(other, Abstraction) and other._content == self._content

    def __hash__(self) -> int:
        return hash(self._native.to_json())

    def __repr__(self) -> str:
        name = self._content["robot"]["name"]
        terms = sum(len(terms) for terms in self._content["acceleration"])
        return f"<Abstraction of {name}: model {self.model}, order {self.order}, {terms} terms>"

    def __reduce__(self) -> tuple[Any, ...]:
        return _parsed, (self._native.to_json(),)


def _parsed(text: str) -> Abstraction:
    return Abstraction(_reachtube.Abstraction.parse(text, "bytes"))


def abstract(
    robot: Robot,
    *,
    paper_model: Literal[1, 2, 3] = 1,
    order: int = 1,
    expansion: npt.ArrayLike | None = None,
    progress: Progress = None,
) -> Abstraction:
    """Make model 1, 2 or 3 of a robot's forward dynamics, of any order.

    Parameters
    ----------
    robot
        The robot.
    paper_model
        Which of the paper's models.
    order
        The order of its Taylor polynomials.
    expansion
        Where the model is expanded: n positions, or 2n positions and velocities, rad and rad/s; 0
        by default.
    progress
        As for `conform`.

    Returns
    -------
    Abstraction

    Raises
    ------
    SettingError
        An argument that is not possible.
    ReachtubeError
        Where the mass matrix is singular, or polynomials of this order do not fit.
    """
    given = [] if expansion is None else finite("expansion", expansion)
    kind = whole("paper_model", paper_model, 1, 3)
    power = whole("order", order, 1, MOST_ORDER)
    with shown(progress, "abstract") as tell:
        return Abstraction(_reachtube.Abstraction(native_of(robot), kind, power, given, tell))
