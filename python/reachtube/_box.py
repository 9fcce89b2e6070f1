"""Boxes: the uncertainty sets."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

from ._arrays import Array, array_of, numbers
from ._values import Values


@dataclass(frozen=True, eq=False)
class Box(Values):
    """A box: all points between ``centre - radius`` and ``centre + radius``.

    Attributes
    ----------
    centre : array of shape (n,)
        The centre, rad and rad/s for states, q then q̇; N m for inputs. It cannot be written to.
    radius : array of shape (n,)
        The radius, in the same units. It cannot be written to.
    """

    centre: Array
    radius: Array

    def __post_init__(self) -> None:
        for name in ("centre", "radius"):
            # A list becomes an array.
            object.__setattr__(self, name, numbers(name, getattr(self, name)))
        super().__post_init__()

    @property
    def lower(self) -> Array:
        """Lower bounds, to rounding: the box is defined by centre and radius."""
        return self.centre - self.radius

    @property
    def upper(self) -> Array:
        """Upper bounds, to rounding: the box is defined by centre and radius."""
        return self.centre + self.radius

    @classmethod
    def _of(cls, record: dict[str, Any]) -> Box:
        return cls(array_of(record["centre"]), array_of(record["radius"]))
