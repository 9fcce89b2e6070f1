"""Reading of a model file. Its numbers are the doubles nearest to what is written."""

import hashlib
import json
import math
import re
from dataclasses import dataclass, replace

from .errors import BadInput
from .polynomials import Polynomials

CHANGED = "the SHA-256 in the model file differs from its content's: the file was changed"


@dataclass(frozen=True)
class Box:
    """A box: centre and radius of each entry."""

    centre: tuple
    radius: tuple


@dataclass(frozen=True)
class Model:
    """A model with its uncertainty sets: x' = A x + B (u + du) + d where it is linear, polynomials
    of the accelerations where it is not."""

    joints: int
    a: list | None
    b: list | None
    drift: list | None
    polynomials: Polynomials | None
    initial_set: Box
    input_set: Box
    noise_radius: tuple
    settings: dict
    correction: dict | None
    robot: dict
    suites: list
    # The root over the recordings' entries, where the file does not list them.
    root: str | None
    sha256: str
    # The SHA-256 that the file's content has, which a change makes another one.
    digest: str
    notes: tuple
    # What the file says of its sets: cost, lower bound and gap, where it has them.
    stated: dict
    # The one condition for friction, whatever a run's own condition is: its place in the order
    # of a suite, and temperatures. None where each run has its own.
    condition: dict | None = None

    def nominal_start(self, suite):
        """Returns the nominal start that the file has for a suite, or None."""
        found = (s.get("nominal_start") for s in self.suites if s["name"] == suite)
        return next(found, None)

    @property
    def states(self):
        """Number of the states that are rows."""
        return self.joints if self.settings["states"] == "positions" else 2 * self.joints


def read_model(path, any_run=False):
    """Reads the model file at `path`; with `any_run`, the sets that need no knowledge of the run
    take the place of the others."""
    try:
        with open(path, encoding="utf-8") as file:
            text = file.read()
        content = json.loads(text, parse_constant=_refuse_constant)
    except (OSError, ValueError, RecursionError) as error:
        raise BadInput(f"{path}: {error}; give a file that `conform --out` wrote") from error
    try:
        model = _model(content, text)
        return _of_any_run(model, content.get("any_run")) if any_run else model
    except (KeyError, TypeError, AttributeError, ValueError, IndexError) as error:
        raise BadInput(f"{path}: {error!r} is missing or has the wrong form") from error
    except BadInput as error:
        raise BadInput(f"{path}: {error}") from error


def _refuse_constant(name):
    raise ValueError(f"{name} is not a number")


def _model(content, text):
    if content["format"] != "reachtube-model" or content["version"] != 4:
        raise BadInput("it is no model file of version 4; run `reachtube conform` again")
    drive = content["drive"]
    is_linear = "a" in content and not drive.get("acceleration")
    n = len(drive["robot"]["joint"])
    noise, digest = content.get("noise_set"), _digest(content, text)
    model = Model(
        joints=n,
        a=_rows(content["a"], 2 * n, 2 * n, "a") if is_linear else None,
        b=_rows(content["b"], 2 * n, n, "b") if is_linear else None,
        drift=_numbers(content["drift"], 2 * n, "drift") if is_linear else None,
        polynomials=None if is_linear else Polynomials.of_file(drive, n),
        initial_set=_box(content["initial_set"], 2 * n, "initial_set"),
        input_set=_box(content["input_set"], n, "input_set"),
        noise_radius=_noise(noise, n),
        settings={**content["settings"], **drive["settings"]},
        correction=drive.get("correction"),
        robot=drive["robot"],
        suites=content["data"]["suites"],
        root=content["data"].get("root"),
        sha256=content["sha256"],
        digest=digest,
        notes=() if digest == content["sha256"] else (CHANGED,),
        stated={key: content.get(key) for key in
                ("cost", "cost_of_samples", "cost_lower_bound", "optimality_gap", "calibration",
                 "sensor_noise")},
    )
    _check_settings(model.settings)
    return model


def _of_any_run(model, record):
    if record is None:
        raise BadInput("it has no any_run: its friction does not depend on the run")
    n, sets = model.joints, record["sets"]
    return replace(
        model,
        initial_set=_box(sets["initial_set"], 2 * n, "any_run.sets.initial_set"),
        input_set=_box(sets["input_set"], n, "any_run.sets.input_set"),
        noise_radius=_noise(sets.get("noise_set"), n),
        condition=record["condition"],
    )


def _check_settings(settings):
    if settings.get("input_doubling") is not None:
        raise BadInput("its U grows with the nominal motion, which is not judged here")
    if settings.get("nominal") == "past":
        raise BadInput("its motions start where earlier samples tell, which is not judged here")
    choices = {
        "torque": ("compensated", "motor", "link"),
        "disturbance": ("constant", "sample", "measurable"),
        "states": ("all", "positions"),
        "nominal": ("mean", "own"),
    }
    for key, known in choices.items():
        if settings[key] not in known:
            raise BadInput(f"settings.{key} is {settings[key]!r}, not one of {', '.join(known)}")


def _numbers(values, count, name):
    numbers = [float(x) for x in values]
    if len(numbers) != count or not all(map(math.isfinite, numbers)):
        raise BadInput(f"{name} has not {count} finite numbers")
    return numbers


def _rows(rows, count, columns, name):
    if len(rows) != count:
        raise BadInput(f"{name} has not {count} rows")
    return [_numbers(row, columns, name) for row in rows]


def _box(value, count, name):
    centre = _numbers(value["centre"], count, f"{name}.centre")
    radius = _numbers(value["radius"], count, f"{name}.radius")
    if any(r < 0.0 for r in radius):
        raise BadInput(f"{name} has a negative radius")
    return Box(tuple(centre), tuple(radius))


def _noise(value, joints):
    if value is None:
        return (0.0,) * (2 * joints)
    box = _box(value, 2 * joints, "noise_set")
    if any(box.centre):
        raise BadInput("the centre of noise_set is not 0")
    return box.radius


def _digest(content, text):
    """Returns the SHA-256 of the content: of the JSON without spaces and with an empty last
    entry."""
    compact = re.sub(r'("(?:[^"\\]|\\.)*")|\s+', lambda match: match.group(1) or "", text)
    ending = f'"sha256":"{content["sha256"]}"}}'
    unsealed = compact.removesuffix(ending) + '"sha256":""}'
    return hashlib.sha256(unsealed.encode()).hexdigest()
