"""Times, decimals and files."""

import json
from fractions import Fraction

import pytest
import toy

from recheck.errors import BadInput
from recheck.grid import Grid, distinct, grid_of
from recheck.model import read_model
from recheck.recordings import picoseconds, read_index, read_run


@pytest.mark.parametrize(("text", "expected"), [
    ("0.004", 4 * 10**9), ("-1.5e-3", -15 * 10**8), ("0.0000000000015", 2), ("1e-400", 0),
    ("1700000000.004", 1_700_000_000_004_000_000_000), ("+.5", 5 * 10**11), ("5.", 5 * 10**12),
])
def test_times_are_read_to_the_picosecond_as_written(text, expected):
    assert picoseconds(text) == expected


@pytest.mark.parametrize("text", ["", ".", "nan", "inf", "1_0", "1e999", "0x1", "--1", "1 2"])
def test_text_that_is_no_number_is_refused(text):
    with pytest.raises(BadInput):
        picoseconds(text)


def test_a_fixed_rate_is_found_and_shared():
    decimal = grid_of([round(0.004 * k, 3) for k in range(937)])
    assert decimal.step == 0.004
    hertz = grid_of([k / 240.0 for k in range(240)])
    assert hertz.step == 1.0 / 240.0
    assert grid_of([0.0, 0.004, 0.012]).step is None
    short = grid_of([0.0, 0.004, 0.008])
    assert short.is_prefix_of(decimal) and not decimal.is_prefix_of(short)
    assert distinct([short, decimal, hertz]) == [decimal, hertz]


def test_spans_of_recorded_times_are_exact_differences():
    times = (0.0, 0.1, 1000.3)
    exact = Fraction(times[2]) - Fraction(times[1])
    assert exact != Fraction(times[2] - times[1])
    span = Grid(times, None).span(1)
    assert span.is_exact() and span * exact.denominator == exact.numerator


def test_a_run_is_read_to_its_end_or_until_a_time(tmp_path):
    lines = ["\ufefft, q1,qd1,tau1,note", "5.0,1,2,3,a", "", '5.1,"1.5",2,3,', "5.3,2,2,3,b"]
    (tmp_path / "a.csv").write_text("\r\n".join(lines), encoding="utf-8")
    run = read_run(tmp_path, "a.csv", 1, 1, None)
    assert (run.grid.times, run.states[1]) == ((0.0, 0.1, 0.3), [1.5, 2.0])
    assert len(read_run(tmp_path, "a.csv", 1, 1, 0.1).grid) == 2


@pytest.mark.parametrize("text", [
    "t,q1,tau1,qd1\n0,1,2,3", "t,q1,qd1,tau1\n0,1,2", "t,q1,qd1,tau1\n0,1,2,3\n0,1,2,3",
    "t,q1,qd1,tau1\n", "", "t,q1,qd1,tau1\n0,1,2,nan",
])
def test_a_defect_is_refused(tmp_path, text):
    (tmp_path / "a.csv").write_text(text)
    with pytest.raises(BadInput, match="a.csv"):
        read_run(tmp_path, "a.csv", 1, 1, None)


def test_the_order_of_runs_follows_the_columns(tmp_path):
    def places(text):
        (tmp_path / "runs.csv").write_text(text)
        return read_index(tmp_path)["S"]

    assert places("file,suite\na,S\nb,S\nc,\n") == [("a", 1), ("b", 2)]
    assert places("file,suite,repeat\na,S,2\nb,S,1\n") == [("a", 2), ("b", 1)]
    assert places("file,suite,repeat\na,S,2\nb,S,2\n") == [("a", 1), ("b", 2)]
    assert places("file,suite,repeat,order\na,S,2,5\nb,S,1,3\n") == [("a", 5), ("b", 3)]
    with pytest.raises(BadInput):
        places("file,suite,order\na,S,1\nb,S,\n")


@pytest.mark.parametrize(("key", "value"), [
    ("a", [[0.0]]), ("drift", [0.0, 0.0, float("inf"), 0.0]), ("settings", {}),
    ("initial_set", {"centre": [0.0] * 4, "radius": [0.1, -0.1, 0.1, 0.1]}),
    ("noise_set", {"centre": [0.0, 0.1, 0.0, 0.0], "radius": [0.1] * 4}),
])
def test_a_model_whose_parts_do_not_fit_is_refused(tmp_path, key, value):
    (tmp_path / "model.json").write_text(json.dumps({**toy.content(), key: value}))
    with pytest.raises(BadInput, match="model.json"):
        read_model(tmp_path / "model.json")


def test_a_file_that_is_no_linear_model_is_refused(tmp_path):
    for text in ("", "{}", '{"format": "reachtube-model", "version": 2}', "[1]"):
        (tmp_path / "model.json").write_text(text)
        with pytest.raises(BadInput, match="model.json"):
            read_model(tmp_path / "model.json")
