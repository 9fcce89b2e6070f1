"""The command on recordings that its model can have made, and on altered ones."""

import csv
import hashlib
import json
import math
from types import SimpleNamespace

import numpy
import pytest
import toy

from recheck.cli import main
from recheck.grid import Grid
from recheck.inputs import Inputs
from recheck.manifest import root
from recheck.recordings import Run
from recheck.system import System
from recheck.verdict import Tally, Verdict, exit_code


def judged(folder, capsys, *options):
    """Returns exit code and JSON of the command."""
    arguments = [str(folder / "model.json"), "--data", str(folder / "data"), "--json", *options]
    code = main(arguments)
    output = capsys.readouterr()
    return code, json.loads(output.out) if code != 3 else output.err


@pytest.mark.parametrize("disturbance", ["sample", "measurable"])
@pytest.mark.parametrize("jitter", [0.0, 0.3])
def test_recordings_within_the_sets_hold(tmp_path, capsys, disturbance, jitter):
    toy.write(tmp_path, toy.content(disturbance=disturbance), jitter=jitter)
    code, found = judged(tmp_path, capsys)
    assert code == 0
    rows = found["rows"][0]
    assert (rows["holds"], rows["undecided"], rows["fails"]) == (20 * 4, 0, 0)


def test_recordings_beyond_the_sets_fail_and_are_named(tmp_path, capsys):
    model = toy.content()
    toy.write(tmp_path, model, part=1.0)
    model["initial_set"]["radius"] = [0.5 * r for r in model["initial_set"]["radius"]]
    (tmp_path / "model.json").write_text(json.dumps(model))
    code, found = judged(tmp_path, capsys)
    assert code == 1 and found["rows"][0]["fails"] > 0
    worst = found["rows"][0]["findings"][0]
    assert worst["verdict"] == "fails" and 0.0 < worst["excess"] < 0.1
    assert worst["place"].startswith("r")


def test_the_last_bit_of_a_radius_decides(tmp_path, capsys):
    """At the first sample the set is X0 itself: a row on its boundary holds, and fails with the
    radius one bit smaller."""
    model = toy.content()
    model["initial_set"] = {"centre": [0.0] * 4, "radius": [0.125, 1.0, 1.0, 1.0]}
    toy.write(tmp_path, model, runs=1, samples=1)
    model["data"]["suites"][0]["nominal_start"] = [0.25, 0.0, 0.0, 0.0]
    text = "t,q1,q2,qd1,qd2,tau1,tau2\n0,0.375,0,0,0,0,0\n"
    (tmp_path / "data" / "r0.csv").write_text(text)
    for radius, expected in ((0.125, 0), (0.12499999999999999, 1)):
        model["initial_set"]["radius"][0] = radius
        toy.relist(tmp_path, model)
        assert judged(tmp_path, capsys)[0] == expected


def test_inputs_known_to_a_tolerance_leave_tight_rows_open(tmp_path, capsys):
    model = toy.content(torque="link")
    toy.write(tmp_path, model)
    gravity_free = {**toy.ROBOT, "gravity": [0.0, 0.0, 0.0]}
    model["drive"]["robot"] = gravity_free
    (tmp_path / "model.json").write_text(json.dumps(model))
    code, found = judged(tmp_path, capsys)
    assert code == 0 and "computed here" in "".join(found["claim"]["conditions"])
    code, found = judged(tmp_path, capsys, "--input-error", "10")
    assert code == 2 and found["rows"][0]["fails"] == 0


def test_given_inputs_settle_what_was_open(tmp_path, capsys):
    model = toy.content(torque="link")
    model["drive"]["robot"] = {**toy.ROBOT, "gravity": [0.0, 0.0, 0.0]}
    toy.write(tmp_path, model)
    lines = ["file,k,u1,u2"]
    for run in range(4):
        with open(tmp_path / "data" / f"r{run}.csv") as file:
            rows = list(csv.reader(file))[1:]
        lines += [f"r{run}.csv,{k},{row[5]},{row[6]}" for k, row in enumerate(rows)]
    (tmp_path / "u.csv").write_text("\n".join(lines) + "\n")
    options = ["--inputs", str(tmp_path / "u.csv"), "--input-error", "10"]
    assert judged(tmp_path, capsys, *options)[0] == 0
    lines[2] = "r0.csv,1,20.0,0.0"
    (tmp_path / "u.csv").write_text("\n".join(lines) + "\n")
    code, message = judged(tmp_path, capsys, *options)
    assert code == 3 and "r0.csv differ by" in message


def test_motor_torque_is_the_input_with_gravity_and_friction():
    """One joint-1 state in closed form: u = tau - tau_c(g, qd) - g."""
    model = SimpleNamespace(
        joints=2, robot=toy.ROBOT, condition=None, correction=None,
        settings={"torque": "motor", "nominal": "mean",
                  "expansion_point": {"q": [0.0, 0.0], "qd": [0.0, 0.0]}},
    )
    run = Run("a.csv", "", Grid((0.0,), None), [[0.0, 0.0, 0.5, -0.5]], [[40.0, 8.0]], 1)
    recorded = Inputs(model, None, 0.0)._recorded(run).inputs[0]
    load = 10.0 * (2.0 * 0.5 + 1.0) + 7.5
    assert recorded == pytest.approx([40.0 - (2.0 + 0.1 * load) - load, 8.0 - 7.5], abs=1e-13)


def test_a_correction_is_taken_off_along_the_nominal_motion():
    """Each term in closed form, at the start and at the sample after it."""
    model = SimpleNamespace(
        joints=2, robot=toy.ROBOT, condition=None,
        nominal_start=lambda suite: [0.0, 0.0, 0.5, 0.01],
        a=toy.CONTENT["a"], b=toy.CONTENT["b"], drift=[0.0] * 4,
        correction={"joints": [
            {"quadratic": 0.3, "cubic": 0.7, "coulomb": [0.5, 0.1, 0.1, 0.1]},
            {"warm_up": 2.0},
        ], "payload": 0.25},
        settings={"torque": "compensated", "nominal": "mean",
                  "expansion_point": {"q": [0.0, 0.0], "qd": [0.1, 0.0]}},
    )
    grid = Grid((0.0, 0.25, 0.5), 0.25)
    run = Run("a.csv", "", grid, [[0.0] * 4] * 3, [[1.0, 2.0], [3.0, 4.0], [5.0, 6.0]], 3)
    (case,) = Inputs(model, System(model), 0.0).cases("S", [run])
    x, expected = numpy.array([0.0, 0.0, 0.5, 0.01]), []
    for tau in ([1.0, 2.0], [3.0, 4.0]):
        (q1, q2), (v1, v2) = x[:2], x[2:]
        load = 10.0 * 2.0 * math.cos(q1) + 7.5 * math.cos(q1 + q2)
        cubic = 0.3 * (v1 - 0.1) ** 2 + 0.7 * (v1 - 0.1) ** 3
        part = min(abs(v1) / 0.02, 1.0)
        friction = part * (0.5 * (2.0 + 0.1 * load) if v1 > 0.0 else -0.1 * 2.0)
        weight = [2.5 * (math.cos(q1) + math.cos(q1 + q2)), 2.5 * math.cos(q1 + q2)]
        u = [tau[0] - cubic - friction - weight[0], tau[1] - 2.0 * math.log(3) * v2 - weight[1]]
        expected.append(u)
        phi, gamma = toy.exact_step(0.25)
        x = phi @ x + gamma @ u
    assert case.inputs == [pytest.approx(u, abs=1e-12) for u in (*expected, [5.0, 6.0])]
    assert case.own is run and case.doubt == [0.0, 0.0]


def test_slow_joints_have_a_part_of_coulomb_friction():
    model = SimpleNamespace(
        joints=2, robot=toy.ROBOT, condition=None, nominal_start=lambda suite: None,
        drift=[0.0] * 4,
        correction={"joints": [{"coulomb": [0.5, 0.0, 0.0, 0.5]}, {}]},
        settings={"torque": "compensated", "nominal": "own",
                  "expansion_point": {"q": [0.0, 0.0], "qd": [0.0, 0.0]}},
        a=toy.CONTENT["a"], b=toy.CONTENT["b"],
    )
    states = [[0.0, 0.0, 0.005, 0.0]] * 2
    run = Run("a.csv", "", Grid((0.0, 0.25), 0.25), states, [[0.0, 0.0]] * 2, 1)
    (case,) = Inputs(model, System(model), 0.0).cases("S", [run])
    assert case.inputs[0] == pytest.approx([-0.25 * 0.5 * (2.0 + 2.75), 0.0], abs=1e-13)


def test_one_failure_outweighs_what_is_undecided():
    tallies = [Tally("a", [5, 2, 0]), Tally("b", [5, 0, 0])]
    assert exit_code(tallies) == 2
    tallies[1].counts[Verdict.FAILS] += 1
    assert exit_code(tallies) == 1
    assert exit_code([Tally("c", [5, 0, 0])]) == 0


@pytest.mark.parametrize("arguments", [
    [], ["--data"], ["--data", "nowhere"], ["--data", "data", "--suites", "T"],
    ["--data", "data", "--every", "0"], ["--data", "data", "--reach", "nowhere"],
    ["--data", "data", "--certificate", "nowhere"], ["--data", "data", "--what"],
])
def test_what_cannot_be_judged_is_no_verdict(tmp_path, capsys, monkeypatch, arguments):
    toy.write(tmp_path, toy.content())
    monkeypatch.chdir(tmp_path)
    assert main(["model.json", *arguments]) == 3
    assert "error: " in capsys.readouterr().err


def test_bounds_of_reach_must_be_outside(tmp_path, capsys):
    """Bounds that are 1e-6 wider than the exact ones hold; one moved inside fails."""
    model = toy.content()
    toy.write(tmp_path, model, samples=2, h=0.5)
    (tmp_path / "reach").mkdir()
    phi, gamma = toy.exact_step(0.5)
    x0, u = [0.3, -0.2, 0.1, 0.0], None
    with open(tmp_path / "data" / "r0.csv") as file:
        u = [float(x) for x in list(csv.reader(file))[1][5:]]
    c_x, r_x = model["initial_set"]["centre"], model["initial_set"]["radius"]
    c_u, r_u = model["input_set"]["centre"], model["input_set"]["radius"]
    first = [(x + c, r) for x, c, r in zip(x0, c_x, r_x, strict=True)]
    start = [x + c for x, c in zip(x0, c_x, strict=True)]
    held = [a + b for a, b in zip(u, c_u, strict=True)]
    second = list(zip(phi @ start + gamma @ held, abs(phi) @ r_x + abs(gamma) @ r_u, strict=True))
    names = ["q1", "q2", "qd1", "qd2"]
    ends = [[(m - r - 1e-6, m + r + 1e-6) for m, r in rows] for rows in (first, second)]
    header = ",".join(f"{n}_{kind}" for n in names for kind in ("lower", "nominal", "upper"))
    rows = [f"{t}," + ",".join(f"{low!r},0,{high!r}" for low, high in row)
            for t, row in zip((0.0, 0.5), ends, strict=True)]
    text = "\n".join(["t," + header, *rows, ""]).replace("np.float64(", "").replace(")", "")
    (tmp_path / "reach" / "S.csv").write_text(text)
    header = ",".join(f"{n}_{kind}" for n in names for kind in ("lower", "upper"))
    hull = [(min(a[0], b[0]), max(a[1], b[1])) for a, b in zip(*ends, strict=True)]
    row = "0,0.5," + ",".join(f"{float(low)!r},{float(high)!r}" for low, high in hull)
    (tmp_path / "reach" / "S_tube.csv").write_text(f"t_from,t_to,{header}\n{row}\n")
    toy.write_record(tmp_path, model)
    options = ["--reach", str(tmp_path / "reach")]
    code, found = judged(tmp_path, capsys, *options)
    assert code == 0 and [part["holds"] for part in found["bounds"]] == [16, 16]
    (tmp_path / "reach" / "S.csv").write_text(text.replace(f"{ends[1][0][1]:.9f}"[:8], "0.000000"))
    code, message = judged(tmp_path, capsys, *options)
    assert code == 3 and "differs from the one that reach.json names" in message
    toy.write_record(tmp_path, model)
    code, found = judged(tmp_path, capsys, *options)
    assert code == 1 and found["bounds"][0]["fails"] == 1
    model["input_set"]["radius"][0] *= 1.01
    (tmp_path / "model.json").write_text(json.dumps(model))
    code, message = judged(tmp_path, capsys, *options)
    assert code == 3 and "another model" in message


def test_the_root_of_three_leaves_is_that_of_the_library():
    entries = [(0, "a.csv", "A", "00ff"), (5, "b.csv", "A", "00ff"), (1, "b.csv", "A", "00ff")]
    expected = "06053100f0a52edfd68bf7e71262e0c32cb4960e373e313193b0613710f66f04"
    assert root(entries) == expected


def test_recordings_that_are_counted_are_compared_by_their_root(tmp_path, capsys):
    model = toy.content()
    toy.write(tmp_path, model)
    suite = model["data"]["suites"][0]
    places = range(len(suite["runs"]))
    digest = {
        run["file"]: hashlib.sha256((tmp_path / "data" / run["file"]).read_bytes()).hexdigest()
        for run in suite["runs"]
    }
    suite["run_count"] = len(suite.pop("runs"))
    leaves = [(place, file, "S", digest[file]) for place, file in zip(places, digest, strict=True)]
    for last, is_missing in ((digest["r3.csv"], False), ("0" * 64, True)):
        model["data"]["root"] = root([*leaves[:-1], (3, "r3.csv", "S", last)])
        (tmp_path / "model.json").write_text(json.dumps(model))
        code, found = judged(tmp_path, capsys)
        assert code == (2 if is_missing else 0)
        assert ("differ from the model file's" in "".join(found["claim"]["missing"])) == is_missing
