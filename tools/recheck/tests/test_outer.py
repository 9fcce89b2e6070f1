"""Models that are not linear, against motions that are simulated here."""

import csv
import json
import math

import numpy
import toy

from recheck.cli import main
from recheck.flowpipe import Flowpipe
from recheck.inputs import Inputs
from recheck.model import read_model
from recheck.recordings import read_run

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
    drive = model["drive"]
    drive["variables"], drive["origin"] = NAMES, [0.0] * 8
    drive["acceleration"] = [
        [term(-v, **{f"qd{j + 1}": 1}), term(-BEND * v, **{f"qd{j + 1}": 3}),
         *(term(b, **{f"u{i + 1}": 1}) for i, b in enumerate(toy.TORQUE[j]))]
        for j, v in enumerate(toy.V1)
    ]
    drive["acceleration"][1].append(term(PULL, s1=1))
    return model


def motion(x, inputs):
    """States at samples, by 20 steps of the classical method of Runge and Kutta over each."""
    states, h = [x], STEP / 20

    def rate(x, u):
        return numpy.concatenate([x[2:], acceleration(x, u)])

    for u in inputs[:-1]:
        for _ in range(20):
            k1 = rate(x, u)
            k2 = rate(x + 0.5 * h * k1, u)
            k3 = rate(x + 0.5 * h * k2, u)
            x = x + h / 6.0 * (k1 + 2.0 * k2 + 2.0 * k3 + rate(x + h * k3, u))
        states.append(x)
    return numpy.array(states)


START = numpy.array([0.3, -0.2, 0.1, 0.0])


def boxes(model):
    """Centre and radius of X0 and of U."""
    return [[numpy.array(model[name][key]) for key in ("centre", "radius")]
            for name in ("initial_set", "input_set")]


def write(folder, part):
    """Writes the model, and recordings that are motions whose starts and disturbances reach up to
    `part` of the sets. Returns model and inputs."""
    model, random = content(), numpy.random.default_rng(3)
    inputs, listed = random.uniform(-1.0, 1.0, (SAMPLES, 2)), []
    (folder / "data").mkdir()
    (c_x, r_x), (c_u, r_u) = boxes(model)
    for number in range(3):
        x = START + c_x + part * r_x * random.uniform(-1.0, 1.0, 4)
        pushes = c_u + part * r_u * random.uniform(-1.0, 1.0, (SAMPLES, 2))
        lines = ["t,q1,q2,qd1,qd2,tau1,tau2"]
        for k, state in enumerate(motion(x, inputs + pushes)):
            numbers = [k * STEP, *state, *inputs[k]]
            lines.append(",".join(repr(float(x)) for x in numbers))
        (folder / "data" / f"r{number}.csv").write_text("\n".join(lines) + "\n")
        listed.append({"file": f"r{number}.csv"})
    index = ["file,suite", *(f"{run['file']},S" for run in listed)]
    (folder / "data" / "runs.csv").write_text("\n".join(index) + "\n")
    model["data"]["suites"] = [{"name": "S", "nominal_start": list(START), "runs": listed}]
    toy.relist(folder, model)
    return model, inputs


def hulls(folder):
    """The hulls at all samples, by the flowpipe."""
    model = read_model(folder / "model.json")
    runs = [read_run(folder / "data", "r0.csv", 1, 2, None)]
    (case,) = Inputs(model, None, 0.0).cases("S", runs)
    flowpipe = Flowpipe(model, case)
    found = [flowpipe.hull()]
    for k in range(SAMPLES - 1):
        flowpipe.advance(k, case.grid.span(k))
        found.append(flowpipe.hull())
    return [[numpy.array([float(x) for x in part])
             for part in (hull.centre, hull.outer, hull.inner)] for hull in found]


def write_bounds(folder, lower, nominal, upper):
    """Writes the files of `reachtube reach`."""
    folder.mkdir(exist_ok=True)
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


def test_motions_stay_in_the_hull_and_reach_its_inner_one(tmp_path):
    model, inputs = write(tmp_path, part=0.5)
    found, (x0, u) = hulls(tmp_path), boxes(model)
    random = numpy.random.default_rng(1)

    def states(of_start, of_inputs):
        return motion(START + x0[0] + x0[1] * of_start, inputs + u[0] + u[1] * of_inputs)

    for _ in range(20):
        signs = numpy.sign(random.uniform(-1.0, 1.0, (SAMPLES, 2)))
        for k, x in enumerate(states(numpy.sign(random.uniform(-1.0, 1.0, 4)), signs)):
            centre, outer, _ = found[k]
            assert (abs(x - centre) <= outer).all()
    # The worst motion for each state at the last sample, by the sign of what each factor does.
    k, still = SAMPLES - 1, (numpy.zeros(4), numpy.zeros((SAMPLES, 2)))
    middle, (centre, outer, inner) = states(*still)[k], found[-1]
    effects = [[], []]
    for which, at in [*((0, (j,)) for j in range(4)),
                      *((1, (s, j)) for s in range(SAMPLES) for j in range(2))]:
        factors = [part.copy() for part in still]
        factors[which][at] = 0.5
        effects[which].append(states(*factors)[k] - middle)
    for i in range(4):
        of_start, of_inputs = (numpy.sign([effect[i] for effect in part]) for part in effects)
        x = states(of_start, of_inputs.reshape(SAMPLES, 2))[k]
        assert centre[i] + inner[i] <= x[i] <= centre[i] + outer[i]
        assert 0.99 * outer[i] < inner[i] < outer[i]


def test_motions_within_the_sets_hold_and_smaller_sets_fail(tmp_path, capsys):
    model, _ = write(tmp_path, part=0.5)
    code, found = judged(tmp_path, capsys)
    assert (code, found["rows"][0]["holds"]) == (0, SAMPLES * 4)
    for name in ("initial_set", "input_set"):
        model[name]["radius"] = [0.1 * r for r in model[name]["radius"]]
    (tmp_path / "model.json").write_text(json.dumps(model))
    code, found = judged(tmp_path, capsys)
    assert code == 1 and found["rows"][0]["fails"] > 0


def test_a_value_between_what_is_reached_and_what_is_enclosed_is_undecided(tmp_path, capsys):
    model, _ = write(tmp_path, part=0.5)
    centre, outer, inner = hulls(tmp_path)[-1]
    path = tmp_path / "data" / "r1.csv"
    for part, expected in ((0.0, 0), (0.5, 2), (1.5, 1)):
        lines = path.read_text().splitlines()
        cells = lines[-1].split(",")
        cells[3] = repr(float(centre[2] + inner[2] + part * (outer[2] - inner[2]) - 1e-15))
        path.write_text("\n".join([*lines[:-1], ",".join(cells), ""]))
        toy.relist(tmp_path, model)
        assert judged(tmp_path, capsys)[0] == expected


def test_a_set_that_runs_away_is_lost_and_its_rows_are_undecided(tmp_path, capsys):
    model, _ = write(tmp_path, part=0.5)
    for joint in model["drive"]["acceleration"]:
        joint.append([[3, *[0] * 7], 1e7])
    toy.relist(tmp_path, model)
    code, found = judged(tmp_path, capsys)
    # After the first sample, every row is undecided.
    rows = found["rows"][0]
    assert code == 2 and (rows["undecided"], rows["fails"]) == (4 * (SAMPLES - 1), 0)
    assert any("was enclosed up to" in note for note in found["notes"])


def test_printed_bounds_outside_hold_and_bounds_that_motions_pass_fail(tmp_path, capsys):
    model, _ = write(tmp_path, part=0.5)
    options = ["--reach", str(tmp_path / "reach")]
    assert judged(tmp_path, capsys, *options)[0] == 3
    found = hulls(tmp_path)
    for room, expected in ((1.001, 0), (0.95, 1)):
        centre, outer = (numpy.array([part[at] for part in found]) for at in (0, 1))
        write_bounds(tmp_path / "reach", centre - room * outer, centre, centre + room * outer)
        toy.write_record(tmp_path, model)
        code, answer = judged(tmp_path, capsys, *options)
        assert code == expected
        assert sum(part["fails"] for part in answer["bounds"]) > 0 or expected == 0
    assert judged(tmp_path, capsys, *options, "--any-run")[0] == 3
