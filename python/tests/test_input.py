"""Input as new users give it: wrong types, missing files, numbers that are none."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path
from typing import Any

import numpy as np
import pytest

import reachtube as rt

X, Y = rt.variables("x y")


def conform(robot: Any, data: Any, **settings: Any) -> object:
    return rt.conform(robot, data, torque="motor", **settings)


@pytest.mark.parametrize(
    ("settings", "words"),
    [
        ({"suites": 3}, "3 is no name and no list of names"),
        ({"until": "1"}, "until has the type"),
        ({"noise": [float("nan"), 1.0]}, r"noise is \[nan, 1.0\]; give finite numbers"),
        ({"order": "x"}, "order is 'x' of type str"),
        ({"order": -1}, "order is -1; give 1 to 255"),
        ({"paper_model": 2.5}, "paper_model is 2.5 of type float"),
        ({"expansion": [1.0, 2.0]}, "the expansion point has 2 values, but the robot has 6 joints"),
        ({"expansion": [float("nan")] * 6}, "expansion is .*; give finite numbers"),
        ({"stiction": {1}}, r"settings: \{1\} is of type set"),
    ],
)
def test_settings_of_wrong_types_are_named(
    robot: rt.Robot, data: rt.Recordings, settings: dict[str, Any], words: str
) -> None:
    with pytest.raises(rt.SettingError, match=words):
        conform(robot, data, **settings)


@pytest.mark.parametrize(
    ("call", "words"),
    [
    ],
)
def test_old_names_of_arguments_fail_with_the_new_one(
    data: rt.Recordings, call: Callable[[rt.Recordings], object], words: str
) -> None:
    with pytest.raises(TypeError, match=words):
        call(data)


def test_numbers_of_numpy_are_numbers(robot: rt.Robot, data: rt.Recordings) -> None:
    own: dict[str, Any] = {"order": np.int64(1), "until": np.float32(0.125)}
    found: Any = conform(robot, data, **own)
    assert found.settings["until"] == 0.125
    assert rt.Robot.load("lwa4p", lock={"joint6": np.float64(0.5)}).joints == 5
    assert conform(robot, data, stiction=np.bool_(False)) == conform(robot, data)
    with pytest.raises(rt.ReachtubeError, match="low-pass of 5 Hz"):
        rt.identify(robot, excitation=data[0], prepare={"cut_off": np.float32(5.0)})


def test_what_users_write_is_taken(model: rt.Model, data: rt.Recordings) -> None:
    assert rt.variables("x, y") == rt.variables("x y") == (X, Y) and +X == X
    with pytest.raises(TypeError, match="'Polynomial' and 'Polynomial'"):
        X / Y  # type: ignore[operator]
    box = rt.Box([0, 1], [1, 2])  # type: ignore[arg-type]
    assert box.lower.tolist() == [-1.0, -1.0] and rt.Box.from_bytes(box.to_bytes()) == box
    found = rt.reach(model, data[0])[0]
    assert found.contains(found.lower.tolist()).all()
    with pytest.raises(rt.SettingError, match=r"states has the shape \(3, 12\)"):
        found.contains(np.zeros((3, 12)))
    with pytest.raises(rt.SettingError, match="scenario has a model and no data"):
        rt.verify({"model": model, "obstacle": []})


@pytest.mark.parametrize(
    ("call", "words"),
    [
        (lambda data: conform("lwa4p", data), "the robot is of type str; give a Robot"),
        (lambda data: rt.check("model.json", data), "the model is of type str; give a Model"),
        (lambda data: rt.reach(None, data), "the model is of type NoneType"),
        (lambda data: rt.abstract("lwa4p"), "the robot is of type str"),
        (lambda data: rt.excite("lwa4p"), "the robot is of type str"),
        (lambda data: rt.identify("lwa4p", excitation=data[0]), "the robot is of type str"),
        (lambda data: rt.fleet.conform("lwa4p", "m.parquet", torque="motor"), "type str"),
        (
            lambda data: rt.identify(rt.Robot.lwa4p(), excitation=3),
            "of type int; give runs or paths",
        ),
        (lambda data: rt.identify(rt.Robot.lwa4p(), prepare=[1]), r"prepare is \[1\]"),
        (lambda data: rt.Robot.load("lwa4p", lock=["joint1"]), "give the positions of joints"),
        (lambda data: rt.Robot.from_dict(3), "the description is of type int"),
        (lambda data: rt.Robot.from_dict({"gravity": float("nan")}), "the description: Out"),
        (lambda data: rt.flowpipe({X: "y", Y: -X}, {X: 1, Y: 0}, [0, 1]), "'y' is no polynomial"),
        (lambda data: rt.flowpipe({X: -X}, {X: [1, 2, 3]}, [0, 1]), "an interval"),
        (lambda data: rt.flowpipe({X: -X}, {X: float("nan")}, [0, 1]), "give a finite number"),
        (lambda data: rt.flowpipe({X: X * float("inf")}, {X: 1}, [0, 1]), "must be finite"),
        (lambda data: rt.Robot("arm.urdf"), r"Robot.load\(PATH\) reads .* given 'arm.urdf'"),
        (lambda data: rt.Model("model.json"), r"Model.load\(PATH\) reads .* given 'model.json'"),
        (lambda data: rt.Abstraction("a.json"), r"Abstraction.load\(PATH\) reads"),
        (lambda data: rt.Monitor("model.json"), r"monitor\(model, step=SECONDS\)"),
        (lambda data: data.inspect(max_gap=-1), "max_gap is -1.0 s; give a finite number above 0"),
        (lambda data: rt.io.bag("a.mcap", joints=["a"], time="now"), "time is 'now'; give"),
        (lambda data: rt.io.bag("a.mcap", joints=["a"], rest_speed=-1), "rest_speed is -1.0 rad/s"),
        (lambda data: rt.io.bag("a.mcap", joints=["a"], max_gap=0), "max_gap is 0.0 s"),
        (lambda data: rt.flowpipe([-X], {X: 1}, [0, 1]), "rates is of type list; give a dict"),
        (lambda data: rt.flowpipe({X: -X}, {X: 1, Y: 2}, [0, 1]), "initial: y is no state"),
        (lambda data: rt.flowpipe({X: -X}, {X: 1}, [0, 1], inputs={X: 1}), "x is a state"),
        (lambda data: rt.variables(["x"]), "give one text"),
        (lambda data: rt.sin(1.0), "sin of 1.0: give a single variable"),
        (lambda data: rt.cos("x"), "'x' is no polynomial"),
        (lambda data: rt.Box.from_bytes("x"), "data is of type str; give bytes"),
        (lambda data: rt.Model.from_bytes("x"), "data is of type str; give bytes"),
        (lambda data: rt.plot.flowpipe([[0.0]], [[1.0]]), "y is 1; give 0 to 0"),
        (lambda data: rt.Robot.from_dict({}), "the description: missing field `schema_version`$"),
        (lambda data: rt.conform(rt.Robot.lwa4p(), [], torque="motor"), "there are no recordings"),
        (lambda data: rt.prepare(rt.Robot.lwa4p(), data, torque="m"), "torque: .* `link`$"),
        (lambda data: rt.prepare(rt.Robot.lwa4p(), data, columns="q=p"), "columns is of type str"),
        (lambda data: rt.model(rt.Robot.lwa4p(), data, columns=["q"]), "columns is of type list"),
        (lambda data: rt.model(rt.Robot.lwa4p(), settings={}), "settings is of type dict"),
        (lambda data: X ** "a", "the exponent 'a'"),
        (lambda data: X + "a", "'a' is no polynomial"),
    ],
)
def test_wrong_arguments_are_named(
    data: rt.Recordings, call: Callable[[Any], object], words: str
) -> None:
    with pytest.raises(rt.SettingError, match=words):
        call(data)


@pytest.mark.parametrize(
    ("labels", "words"),
    [
        ({"suite": 3}, "suite is 3 of type int"),
        ({"name": b"run"}, "name is b'run'"),
        ({"order": 0}, "order is 0; give 1 to"),
    ],
)
def test_labels_of_a_run_are_texts(labels: dict[str, Any], words: str) -> None:
    still = np.zeros((2, 6))
    with pytest.raises(rt.SettingError, match=words):
        rt.Run([0.0, 0.1], still, still, still, **labels)


def test_runs_are_taken_by_number_and_slice(data: rt.Recordings) -> None:
    assert data[-1] == data[len(data) - 1] and data[1:3] == [data[1], data[2]]
    with pytest.raises(IndexError, match="there is no run 6; there are 6"):
        data[6]


@pytest.mark.parametrize("reader", ["npz", "hdf5", "parquet", "ros1"])
def test_files_that_other_libraries_cannot_read_are_named(reader: str, tmp_path: Path) -> None:
    for module in {"hdf5": ["h5py"], "parquet": ["pyarrow"], "ros1": ["rosbags"]}.get(reader, []):
        pytest.importorskip(module)
    more: dict[str, Any] = {"topic": "/t", "joints": ["a"]} if reader == "ros1" else {}
    read = getattr(rt.io, reader)
    with pytest.raises(rt.ReachtubeError, match="none.bag: there is no such file"):
        read(tmp_path / "none.bag", **more)
    (tmp_path / "text.bag").write_text("this is none")
    with pytest.raises(rt.ReachtubeError, match="text.bag: it could not be read"):
        read(tmp_path / "text.bag", **more)


def test_temperatures_of_a_table_are_read(tmp_path: Path) -> None:
    pyarrow = pytest.importorskip("pyarrow")
    from pyarrow import parquet

    still = np.zeros((2, 2))
    run = rt.Run([0.0, 0.1], still, still, still, temperature=still + 21.0)
    parquet.write_table(pyarrow.Table.from_pandas(run.to_pandas()), tmp_path / "run.parquet")
    found = rt.io.parquet(tmp_path / "run.parquet").temperature
    assert found is not None and (found == 21.0).all()
