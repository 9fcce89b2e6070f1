"""Models that are not linear, whose bounds were made from motions of a program of its own."""

import csv
import json
import math

import numpy
import toy
from recheck.cli import main

STEP, SAMPLES = 0.01, 20
# Friction that bends: the acceleration of joint j is -v (qd + 0.2 qd^3) + the row of TORQUE times
# u; sin q1 pulls at joint 2.
NAMES = ["qd1", "qd2", "s1", "s2", "c1", "c2", "u1", "u2"]
BEND, PULL = 0.2, 0.7


def acceleration(x, u):
    """The same as the terms of the model file."""
    pull = numpy.array([0.0, PULL * math.sin(x[0])])
    friction = numpy.array([v * (w + BEND * w**3) for v, w in zip(toy.V1, x[2:], strict=True)])
    return numpy.array(toy.TORQUE) @ u + pull - friction


def content():
    """A model file with the polynomials of `acceleration`."""
    def term(coefficient, **exponents):
        return [[exponents.get(name, 0) for name in NAMES], coefficient]

    model = toy.content()
    for key in ("a", "b", "drift"):
        del model[key]
    model["variables"], model["origin"] = NAMES, [0.0] * 8
    model["acceleration"] = [
        [term(-v, **{f"qd{j + 1}": 1}), term(-BEND * v, **{f"qd{j + 1}": 3}),
         *(term(b, **{f"u{i + 1}": 1}) for i, b in enumerate(toy.TORQUE[j]))]
        for j, v in enumerate(toy.V1)
    ]
    model["acceleration"][1].append(term(PULL, s1=1))
    return model


def motion(x, inputs):
    """States at samples, by 200 steps of Heun's method over each."""
    states = [x]
    for u in inputs[:-1]:
        h = STEP / 200
        for _ in range(200):
            slope = numpy.concatenate([x[2:], acceleration(x, u)])
            ahead = x + h * slope
            x = x + 0.5 * h * (slope + numpy.concatenate([ahead[2:], acceleration(ahead, u)]))
        states.append(x)
    return numpy.array(states)


def write(folder, room):
    """Writes model, recordings and bounds, which leave `room` times the spread of 60 motions about
    their middle; half of the motions have disturbances that do not change."""
    model, random = content(), numpy.random.default_rng(3)
    start, inputs = numpy.array([0.3, -0.2, 0.1, 0.0]), random.uniform(-1.0, 1.0, (SAMPLES, 2))
    boxes = [[numpy.array(model[name][key]) for key in ("centre", "radius")]
             for name in ("initial_set", "input_set")]
    found = []
    for number in range(60):
        (c_x, r_x), (c_u, r_u) = boxes
        parts = random.uniform(-1.0, 1.0, (SAMPLES, 2))
        signs = numpy.sign(parts if number % 2 else numpy.repeat(parts[:1], SAMPLES, axis=0))
        x = start + c_x + r_x * numpy.sign(random.uniform(-1.0, 1.0, 4))
        found.append(motion(x, inputs + c_u + r_u * signs))
    (folder / "data").mkdir()
    lines = ["t,q1,q2,qd1,qd2,tau1,tau2"]
    for k in range(SAMPLES):
        numbers = [k * STEP, *found[0][k], *inputs[k]]
        lines.append(",".join(repr(float(x)) for x in numbers))
    (folder / "data" / "r.csv").write_text("\n".join(lines) + "\n")
    (folder / "data" / "runs.csv").write_text("file,suite\nr.csv,S\n")
    model["data"]["suites"] = [{"name": "S", "nominal_start": list(start), "runs": []}]
    (folder / "model.json").write_text(json.dumps(model))
    low, high = numpy.min(found, axis=0), numpy.max(found, axis=0)
    middle, radius = 0.5 * (low + high), 0.5 * room * (high - low)
    write_bounds(folder / "reach", middle - radius, middle, middle + radius)


def write_bounds(folder, lower, nominal, upper):
    """Writes the files of `reachtube reach`."""
    folder.mkdir()
    states = ["q1", "q2", "qd1", "qd2"]
    with open(folder / "S.csv", "w", encoding="utf-8", newline="") as file:
        out = csv.writer(file)
        out.writerow(["t"] + [f"{s}_{kind}" for s in states
                              for kind in ("lower", "nominal", "upper")])
        for k in range(SAMPLES):
            columns = zip(lower[k], nominal[k], upper[k], strict=True)
            out.writerow([k * STEP, *(float(x) for state in columns for x in state)])
    with open(folder / "S_tube.csv", "w", encoding="utf-8", newline="") as file:
        out = csv.writer(file)
        out.writerow(["t_from", "t_to"] + [f"{s}_{kind}" for s in states
                                           for kind in ("lower", "upper")])
        for k in range(SAMPLES - 1):
            bounds = zip(numpy.minimum(lower[k], lower[k + 1]),
                         numpy.maximum(upper[k], upper[k + 1]), strict=True)
            out.writerow([k * STEP, (k + 1) * STEP, *(float(x) for b in bounds for x in b)])


def judged(folder, capsys, *options):
    """Returns exit code and JSON of the command."""
    code = main([str(folder / "model.json"), "--data", str(folder / "data"), "--json", *options])
    output = capsys.readouterr()
    return code, json.loads(output.out) if code != 3 else output.err


def test_recordings_and_motions_within_the_bounds_hold(tmp_path, capsys):
    write(tmp_path, room=1.6)
    code, found = judged(tmp_path, capsys, "--reach", str(tmp_path / "reach"))
    assert code == 0 and any("proves nothing" in note for note in found["notes"])
    assert found["rows"][0]["holds"] == SAMPLES * 4
    assert found["motions"][0]["holds"] == 48


def test_bounds_that_are_too_narrow_fail(tmp_path, capsys):
    write(tmp_path, room=0.7)
    code, found = judged(tmp_path, capsys, "--reach", str(tmp_path / "reach"))
    assert code == 1 and found["rows"][0]["fails"] > 0 and found["motions"][0]["fails"] > 0
    assert found["motions"][0]["findings"][0]["place"].startswith("motion ")


def test_a_model_that_is_not_linear_needs_its_bounds(tmp_path, capsys):
    write(tmp_path, room=1.6)
    code, words = judged(tmp_path, capsys)
    assert code == 3 and "--reach" in words
    code, words = judged(tmp_path, capsys, "--reach", str(tmp_path / "reach"), "--any-run")
    assert code == 3
