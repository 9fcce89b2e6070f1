"""Settings of a conformance, as the native part takes them."""

from __future__ import annotations

import json
from collections.abc import Iterable, Mapping
from os import PathLike
from typing import Any, Literal, TypeAlias

import numpy as np
import numpy.typing as npt

from ._abstraction import Abstraction
from ._arrays import above_zero, finite, json_of, names, numbers, whole
from ._recordings import Recordings, Run
from ._robot import Robot, native_of
from .errors import SettingError

Torque: TypeAlias = Literal["compensated", "motor", "link"]
Notion: TypeAlias = Literal["hull", "phase-plane", "exact"]
Group: TypeAlias = Literal["inertia", "viscous", "cubic", "coulomb", "warm-up", "payload"]

#: Recordings: a data set, runs, or the path of a folder with its index.
Data: TypeAlias = "Recordings | Run | Iterable[Run] | str | PathLike[str]"


def _radii(name: str, values: npt.ArrayLike, joints: int) -> list[float]:
    """Return 2n numbers; two stand for all positions and all velocities."""
    given = numbers(name, values).ravel()
    if not np.isfinite(given).all() or (given < 0).any():
        raise SettingError(f"{name} is {given.tolist()}; give finite numbers of 0 or more")
    if given.size == 2:
        return [float(given[0])] * joints + [float(given[1])] * joints
    if given.size != 2 * joints:
        raise SettingError(f"{name} has {given.size} numbers; give 2 or {2 * joints}")
    return [float(value) for value in given]


def refuse_gap_of_logs(max_gap: float | None) -> None:
    """Raise an error if a limit of gaps is given for logs, of which none is filled."""
    if max_gap is not None:
        raise SettingError(
            "max_gap is for runs whose inputs are held over a gap: no window of a log crosses one; "
            "leave it out"
        )


def _limits(until: float | None, max_gap: float | None) -> dict[str, float]:
    """Return the limits of time that are given."""
    limits = {"until": until, "max_gap": max_gap}
    return {name: above_zero(name, value) for name, value in limits.items() if value is not None}


def differing(notion: Notion | None, until: float | None, max_gap: float | None) -> str:
    """Return the settings that differ from a model's."""
    settings: dict[str, Any] = dict(_limits(until, max_gap))
    if notion is not None:
        settings["notion"] = notion
    return json.dumps(settings)


#: Arguments of `conform` that are not settings.
_OTHERS = frozenset("robot data suites fit pull horizon resume progress".split())


def among(arguments: Mapping[str, Any]) -> dict[str, Any]:
    """Return the settings among the arguments of `conform`, by name."""
    return {name: value for name, value in arguments.items() if name not in _OTHERS}


def of_conformance(robot: Robot | Abstraction, *, torque: Torque, **given: Any) -> str:
    """Return settings of `conform`, whose signature has their types and defaults."""
    if not isinstance(robot, (Robot, Abstraction)):
        native_of(robot)
    limits = _limits(given.pop("until", None), given.pop("max_gap", None))
    kind, order = given.pop("paper_model", 1), given.pop("order", 1)
    expansion = given.pop("expansion", None)
    settings: dict[str, Any] = {"torque": torque, **given}
    if isinstance(robot, Abstraction):
        if (kind, order, expansion) != (1, 1, None):
            raise SettingError("the abstraction has its own model, order and expansion")
    else:
        kind = whole("paper_model", kind, 1, 3)
        settings["abstraction"] = {"model": kind, "order": whole("order", order, 1, 255)}
        if expansion is not None:
            settings["expansion"] = finite("expansion", expansion)
    settings["calibrate"] = names(given.get("calibrate", ()))
    for name, key in [("weights", "given"), ("noise", "fixed")]:
        if not isinstance(given.get(name, ""), str):
            settings[name] = {key: _radii(name, given[name], robot.joints)}
    if given.get("sensor_noise") is not None:
        settings["sensor_noise"] = _radii("sensor_noise", given["sensor_noise"], robot.joints)
    if given.get("input_doubling") is not None:
        settings["input_doubling"] = finite("input_doubling", given["input_doubling"])
    settings.update(limits)
    return json_of("settings", settings)
