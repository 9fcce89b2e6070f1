"""What a model file claims: its notion, the recordings that it lists, its cost and lower bound."""

import json

import numpy
import pytest
import toy

from recheck.cli import main
from recheck.grid import Grid, stood_for
from recheck.search import independent_rows, nonnegative_least_squares


def judged(folder, capsys, *options):
    """Returns exit code and JSON of the command."""
    code = main([str(folder / "model.json"), "--data", str(folder / "data"), "--json", *options])
    return code, json.loads(capsys.readouterr().out)


@pytest.mark.parametrize(("notion", "missing"), [
    ("hull", 0), ("phase-plane", 1), ("exact", 1),
])
def test_rows_alone_do_not_decide_a_notion_that_asks_more(tmp_path, capsys, notion, missing):
    toy.write(tmp_path, toy.content(notion=notion))
    code, found = judged(tmp_path, capsys)
    assert code == (2 if missing else 0)
    assert found["rows"][0]["undecided"] == found["rows"][0]["fails"] == 0
    assert found["claim"]["notion"] == notion and len(found["claim"]["missing"]) == missing


def test_a_certificate_of_planes_does_not_decide_the_notion_exact(tmp_path, capsys):
    model = toy.content(notion="exact")
    toy.write(tmp_path, model, runs=1, samples=1)
    path = tmp_path / "certificate.jsonl"
    for notion, code in (("phase-plane", 2), ("exact", 0)):
        header = {"format": "reachtube-certificate", "version": 1, "notion": notion,
                  "model_sha256": "", "limit": 0.5}
        path.write_text(json.dumps(header) + "\n")
        assert judged(tmp_path, capsys, "--certificate", str(path))[0] == code
    assert judged(tmp_path, capsys, "--certificate", str(path), "--every", "2")[0] == 2


def test_a_listed_recording_that_is_missing_leaves_the_claim_open(tmp_path, capsys):
    toy.write(tmp_path, toy.content())
    index = tmp_path / "data" / "runs.csv"
    index.write_text("".join(line for line in index.read_text().splitlines(keepends=True)
                             if "r2" not in line))
    code, found = judged(tmp_path, capsys)
    assert code == 2 and "r2.csv" in found["claim"]["missing"][0]


def smallest(tmp_path):
    """Writes one recording that starts 0.5 off in the position of the first joint alone, and
    returns a model with the smallest sets for it: its centres are free, so that they cost nothing;
    and a second recording that is 0.5 off on the other side."""
    model = toy.content()
    for name in ("initial_set", "input_set"):
        model[name] = {"centre": [0.0] * len(model[name]["centre"]),
                       "radius": [0.0] * len(model[name]["radius"])}
    toy.write(tmp_path, model, runs=2, samples=3, h=0.5)
    start = model["data"]["suites"][0]["nominal_start"] = [0.0] * 4
    for run, q in enumerate((0.5, -0.5)):
        rows = [f"{0.5 * k},{start[0] + q},0,0,0,0,0" for k in range(3)]
        text = "\n".join(["t,q1,q2,qd1,qd2,tau1,tau2", *rows, ""])
        (tmp_path / "data" / f"r{run}.csv").write_text(text)
    # A position that is off stays so, and costs its width at each of three samples, which stand for
    # half a second each.
    model["initial_set"]["radius"][0] = 0.5
    model |= {"cost": 1.5, "cost_of_samples": 3.0, "cost_lower_bound": 1.5, "optimality_gap": 0.0}
    toy.relist(tmp_path, model)
    return model


@pytest.mark.parametrize(("changes", "expected"), [
    ({}, 0), ({"cost": 1.50005}, 1), ({"cost_lower_bound": 1.45, "optimality_gap": 0.04}, 0),
    ({"cost_of_samples": 3.0001}, 1),
    ({"cost_lower_bound": 1.55, "optimality_gap": 0.1}, 1),
    ({"cost_lower_bound": 1.45, "optimality_gap": 0.01}, 1),
])
def test_cost_and_lower_bound_are_proved(tmp_path, capsys, changes, expected):
    model = smallest(tmp_path)
    toy.relist(tmp_path, model | changes)
    code, found = judged(tmp_path, capsys)
    assert code == expected
    (fact,) = [fact for fact in found["claim"]["facts"] if "less than" in fact]
    assert float(fact.split()[-1]) == pytest.approx(1.5, rel=1e-12)


def test_costs_of_older_files_are_sums_over_samples(tmp_path, capsys):
    model = smallest(tmp_path)
    del model["cost_of_samples"]
    toy.relist(tmp_path, model | {"cost": 3.0, "cost_lower_bound": 3.0})
    assert judged(tmp_path, capsys)[0] == 0
    toy.relist(tmp_path, model)
    assert judged(tmp_path, capsys)[0] == 1


@pytest.mark.parametrize(("lists", "expected"), [
    (([0.0, 0.5, 1.0],), [[0.5, 0.5, 0.5]]),
    (([0.0, 1.0, 5.0],), [[1.0, 2.5, 4.0]]),
    (([0.0],), [[1.0]]),
    (([0.0, 0.5, 1.0], [0.0, 0.5]), [[0.25, 0.25, 0.5], [0.25, 0.25]]),
])
def test_a_sample_stands_for_the_time_to_halfway_to_its_neighbours(lists, expected):
    found = stood_for([Grid(tuple(times), None) for times in lists])
    assert [[float(t) for t in times] for times in found] == expected


def test_sets_that_are_too_wide_are_not_the_smallest(tmp_path, capsys):
    model = smallest(tmp_path)
    model["initial_set"]["radius"][0] = 0.6
    toy.relist(tmp_path, model | {"cost": 1.8, "cost_of_samples": 3.6, "cost_lower_bound": 1.8})
    code, found = judged(tmp_path, capsys)
    assert code == 2 and found["costs"][0]["undecided"] == 1


def test_least_squares_stay_above_zero():
    a, b = numpy.array([[1.0, 1.0, 0.0], [0.0, 1.0, 1.0]]), numpy.array([1.0, -1.0])
    assert nonnegative_least_squares(a, b) == pytest.approx([1.0, 0.0, 0.0])
    x = nonnegative_least_squares(a, numpy.array([3.0, 1.0]))
    assert (x >= 0.0).all() and a @ x == pytest.approx([3.0, 1.0])


def test_rows_are_picked_that_are_independent():
    rows = [[1.0, 1.0], [2.0, 2.0], [0.0, 0.0], [1.0, -1.0]]
    assert sorted(independent_rows(rows)) == [1, 3]
    assert independent_rows([]) == []
