"""A model of two joints and recordings that it can have made, with closed forms where possible."""

import copy
import hashlib
import json
import math

import numpy

from recheck.model import read_model

V1 = (3.0, 0.5)
TORQUE = ((2.0, -0.4), (-0.4, 1.5))
ROBOT = {
    "schema_version": 1,
    "name": "toy",
    "gravity": [0.0, -10.0, 0.0],
    "joint": [
        {"name": "j1", "dh": {"a": 1.0}, "mass": 2.0, "com": [-0.5, 0.0, 0.0],
         "friction": {"coulomb": [2.0, 0.1, -2.0, 0.1, -2.0, 0.0, 2.0, 0.0]}},
        {"name": "j2", "dh": {"a": 1.0}, "mass": 1.0, "com": [-0.25, 0.0, 0.0]},
    ],
}
CONTENT = {
    "format": "reachtube-model",
    "version": 4,
    "a": [[0, 0, 1, 0], [0, 0, 0, 1], [0, 0, -V1[0], 0], [0, 0, 0, -V1[1]]],
    "b": [[0, 0], [0, 0], list(TORQUE[0]), list(TORQUE[1])],
    "drift": [0.0, 0.0, 0.0, 0.0],
    "initial_set": {"centre": [0.01, 0.0, 0.0, -0.02], "radius": [0.02, 0.01, 0.05, 0.04]},
    "input_set": {"centre": [0.1, 0.0], "radius": [0.5, 0.3]},
    "settings": {
        "disturbance": "sample", "states": "all", "nominal": "mean", "centre": "free",
    },
    "drive": {
        "robot": ROBOT,
        "settings": {
            "torque": "compensated", "expansion_point": {"q": [0.0, 0.0], "qd": [0.0, 0.0]},
        },
    },
    "data": {"suites": []},
    "sha256": "",
}


def content(**changes):
    """Returns the content of the model file with some settings changed."""
    found = copy.deepcopy(CONTENT)
    for key, value in changes.items():
        owner = found["drive"] if key in found["drive"]["settings"] else found
        owner["settings"][key] = value
    return found


def exact_step(h):
    """Returns e^{Ah} and Gamma(h) of the toy in closed form."""
    phi, gamma = numpy.eye(4), numpy.zeros((4, 2))
    for j, v in enumerate(V1):
        decay = -math.expm1(-v * h)
        phi[j, 2 + j], phi[2 + j, 2 + j] = decay / v, 1.0 - decay
        for i in range(2):
            gamma[j, i] = TORQUE[j][i] * (h - decay / v) / v
            gamma[2 + j, i] = TORQUE[j][i] * decay / v
    return phi, gamma


def write(folder, model, runs=4, samples=20, h=0.01, part=0.9, seed=1, jitter=0.0):
    """Writes the model file and recordings of one suite, whose starts and disturbances reach up to
    `part` of the sets. Returns the path of the model."""
    random = numpy.random.default_rng(seed)
    sets = [(numpy.array(model[name]["centre"]), numpy.array(model[name]["radius"]))
            for name in ("initial_set", "input_set")]
    start = numpy.array([0.3, -0.2, 0.1, 0.0])
    inputs = random.uniform(-1.0, 1.0, (samples, 2))
    times = numpy.arange(samples) * h + numpy.round(
        random.uniform(-jitter, jitter, samples) * h, 9
    )
    (folder / "data").mkdir(exist_ok=True)
    listed, index = [], ["file,suite"]
    for run in range(runs):
        (c_x, r_x), (c_u, r_u) = sets
        x = start + c_x + part * r_x * random.uniform(-1.0, 1.0, 4)
        lines = ["t,q1,q2,qd1,qd2,tau1,tau2"]
        for k in range(samples):
            numbers = [times[k], *x, *inputs[k]]
            lines.append(",".join(repr(float(value)) for value in numbers))
            if k + 1 < samples:
                phi, gamma = exact_step(times[k + 1] - times[k])
                disturbance = c_u + part * r_u * random.uniform(-1.0, 1.0, 2)
                x = phi @ x + gamma @ (inputs[k] + disturbance)
        text = "\n".join(lines) + "\n"
        (folder / "data" / f"r{run}.csv").write_text(text)
        digest = hashlib.sha256(text.encode()).hexdigest()
        listed.append({"file": f"r{run}.csv", "sha256": digest, "samples": samples,
                       "duration": 0.0})
        index.append(f"r{run}.csv,S")
    (folder / "data" / "runs.csv").write_text("\n".join(index) + "\n")
    suite = {"name": "S", "nominal_start": list(start), "runs": listed}
    model["data"]["suites"] = [suite]
    path = folder / "model.json"
    path.write_text(json.dumps(model))
    return path


def relist(folder, model):
    """Writes the model file with the digests of the recordings as they are now."""
    for suite in model["data"]["suites"]:
        for run in suite["runs"]:
            content = (folder / "data" / run["file"]).read_bytes()
            run["sha256"] = hashlib.sha256(content).hexdigest()
    (folder / "model.json").write_text(json.dumps(model))


def write_record(folder, model):
    """Writes the record of `reachtube reach` for the CSV files of a folder beside the model."""
    files = [{"file": path.name, "sha256": hashlib.sha256(path.read_bytes()).hexdigest()}
             for path in sorted((folder / "reach").glob("*.csv"))]
    digest = read_model(folder / "model.json").digest
    record = {"format": "reachtube-reach", "version": 1, "model_sha256": digest,
              "data": model["data"], "files": files}
    (folder / "reach" / "reach.json").write_text(json.dumps(record))
