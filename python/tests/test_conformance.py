"""Sets, checks and reachable sets, against the command's file and each other."""

from __future__ import annotations

import inspect
import json
import pickle
import warnings
from pathlib import Path
from typing import Any, Literal, get_args

import numpy as np
import pytest

import reachtube as rt
from reachtube import _reachtube, _settings

from conftest import SCHUNK, runs, write_csv


def test_every_recording_lies_in_the_reachable_set(
    model: rt.Model, data: rt.Recordings
) -> None:
    assert model.verified and model.cost is not None and model.cost > 0
    verdict = rt.check(model, data)
    assert verdict and verdict.violations == 0 and verdict.trust is None
    # Motor torques differ in gravity and friction, so each run has a nominal motion of its own.
    sets = {found.run: found for found in rt.reach(model, data)}
    assert len(sets) == 6
    for run in data:
        states = np.hstack([run.q, run.qd])
        assert sets[run.name].contains(states).all()
        assert not sets[run.name].contains(states + 1.0).any()
    for found in sets.values():
        assert (found.step_lower <= found.lower[:-1]).all()
        assert (found.step_upper >= found.upper[1:]).all()


def test_nominal_motions_may_follow_the_robot(robot: rt.Robot) -> None:
    exact = runs(robot, noise_of=0.0)
    model, by_robot = (
        rt.conform(robot, exact, torque="motor", equations=equations)
        for equations in ("model", "robot")
    )
    assert by_robot.to_dict()["drive"]["settings"]["equations"] == "robot"
    assert rt.check(by_robot, exact)
    # The robot itself gives the torques, and its inertia is another than at q = 0.
    assert by_robot.cost is not None and model.cost is not None
    assert by_robot.cost < 0.5 * model.cost, (by_robot.cost, model.cost)
    with pytest.raises(rt.ReachtubeError, match="need a linear model"):
        rt.conform(robot, exact, torque="motor", order=3, equations="robot")


def test_the_input_set_may_grow_with_the_nominal_motion(robot: rt.Robot) -> None:
    exact, n = runs(robot, noise_of=0.0), robot.joints
    model = rt.conform(robot, exact, torque="motor", input_doubling=np.full(n, 0.7))
    assert model.to_dict()["settings"]["input_doubling"] == [0.7] * n
    assert rt.check(model, exact)
    with pytest.raises(rt.ReachtubeError, match=f"give {n}"):
        rt.conform(robot, exact, torque="motor", input_doubling=[1.0])
    with pytest.raises(rt.ReachtubeError, match="needs the notion hull"):
        rt.conform(robot, exact, torque="motor", input_doubling=[1.0] * n, notion="exact")


def test_saving_counts_the_models_that_the_same_motions_calibrated(
    robot: rt.Robot, data: rt.Recordings, tmp_path: Path
) -> None:
    def calibrated(disturbance: Literal["sample", "measurable"]) -> rt.Model:
        with warnings.catch_warnings():
            warnings.simplefilter("ignore", rt.ReachtubeWarning)
            return rt.conform(
                robot, data, torque="motor", disturbance=disturbance, calibrate=["m1"]
            )

    def saved(model: rt.Model, path: Path) -> dict[str, Any]:
        path.parent.mkdir(exist_ok=True)
        model.save(path)
        content: dict[str, Any] = json.loads(path.read_text())
        assert rt.Model.load(path).cost == model.cost
        return content

    first, second = calibrated("sample"), calibrated("measurable")
    alone = saved(first, tmp_path / "one" / "first.json")
    assert "candidates" not in alone["calibration"] and alone["trust"]["kind"] == "guarantee"
    # The bound of one motion, 1/2, is too weak for the better of two models.
    both = saved(second, tmp_path / "one" / "second.json")
    assert both["calibration"]["candidates"] == 2 and "kind" not in both["trust"]
    # A copy of the same model is no other one, and other folders are not known.
    assert saved(second, tmp_path / "other" / "second.json")["trust"]["kind"] == "guarantee"
    copy = saved(second, tmp_path / "other" / "copy.json")
    assert "candidates" not in copy["calibration"]


def test_stiction_widens_the_input_set(robot: rt.Robot, data: rt.Recordings) -> None:
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", rt.ReachtubeWarning)
        model, wider = (
            rt.conform(robot, data, torque="motor", stiction=stiction)
            for stiction in (False, True)
        )
    small, wide = model.to_dict(), wider.to_dict()
    assert wider.verified and "stiction" not in small and wide["stiction"]
    assert all(joint["room"] >= joint["torque"] > 0 for joint in wide["stiction"])
    radii = (content["input_set"]["radius"] for content in (small, wide))
    grown = np.subtract(*reversed(list(radii)))
    assert np.allclose(grown, wide["allowance"][12:]) and (grown > 0).any()
    assert "stiction" in [finding.code for finding in wider.findings]


def test_not_conformant_is_a_value_with_a_witness(model: rt.Model, robot: rt.Robot) -> None:
    moved = []
    for run in runs(robot):
        qd = run.qd.copy()
        qd[30, 2] += 0.5
        moved.append(rt.Run(run.t, run.q, qd, run.tau, suite=run.suite, name="moved"))
    verdict = rt.check(model, moved)
    assert not verdict and verdict.violations > 0
    worst = verdict.worst
    assert worst is not None
    assert (worst["state"], worst["sample"], worst["side"]) == ("qd3", 30, "upper")
    assert 0.3 < worst["excess"] < 0.6


def test_arrays_and_csv_files_give_the_same_model(
    robot: rt.Robot, data: rt.Recordings, model: rt.Model, tmp_path: Path
) -> None:
    from_files = write_csv(tmp_path, list(data))
    with warnings.catch_warnings():
        warnings.simplefilter("ignore")
        other = rt.conform(robot, from_files, torque="motor")

    def numbers(value: object) -> object:
        """Return a value without names and digests of files."""
        if isinstance(value, dict):
            names = {"sha256", "file", "run"}
            return {key: numbers(inner) for key, inner in value.items() if key not in names}
        if isinstance(value, list):
            return [numbers(inner) for inner in value]
        return value

    assert numbers(model.to_dict()) == numbers(other.to_dict())


def test_models_are_frozen_values(model: rt.Model, tmp_path: Path) -> None:
    path = tmp_path / "model.json"
    model.save(path)
    assert rt.Model.load(path) == model == pickle.loads(pickle.dumps(model))
    assert hash(rt.Model.load(path)) == hash(model)
    with pytest.raises(AttributeError, match="cannot be changed"):
        model._text = ""
    with pytest.raises(rt.ReachtubeError, match="force=True"):
        model.save(path)
    changed = json.loads(path.read_text())
    changed["input_set"]["radius"][0] *= 0.5
    (tmp_path / "changed.json").write_text(json.dumps(changed))
    with pytest.raises(rt.ModelFileError, match="changed.json"):
        rt.Model.load(tmp_path / "changed.json")
    with pytest.raises(rt.ModelFileError):
        rt.Model.from_bytes(b"nonsense")
    with pytest.raises(rt.ReachtubeError, match="no such|No such"):
        rt.Model.load(tmp_path / "none.json")


def test_results_show_themselves(model: rt.Model, data: rt.Recordings) -> None:
    assert "conformant" in repr(model) and "<svg" in model._repr_html_()
    frame = model.to_pandas()
    assert list(frame.columns) == ["set", "entry", "unit", "centre", "radius"]
    assert len(frame) == 18 and frame["unit"].iloc[-1] == "N m"
    verdict = rt.check(model, data)
    assert "0 of" in repr(verdict) and "<table" in verdict._repr_html_()
    assert pickle.loads(pickle.dumps(verdict)) == verdict
    assert verdict.to_pandas()["outside"].sum() == 0
    first, second, *_ = rt.reach(model, data)
    assert first == pickle.loads(pickle.dumps(first)) != second
    assert first.to_pandas().shape == (60, 1 + 3 * 12)


def test_settings_reach_the_product(robot: rt.Robot, data: rt.Recordings) -> None:
    with warnings.catch_warnings():
        warnings.simplefilter("ignore")
        found = rt.conform(
            robot,
            data,
            torque="motor",
            suites="A",
            centre="zero",
            disturbance="constant",
            noise=[1e-4, 1e-3],
            weights=[1.0, 0.5],
            until=0.1,
        )
    settings = found.settings
    assert settings["centre"] == "zero" and settings["disturbance"] == "constant"
    assert settings["torque"] == "motor"
    assert settings["noise"] == {"fixed": [1e-4] * 6 + [1e-3] * 6}
    assert settings["until"] == 0.1 and not found.input_set.centre.any()
    assert found.noise_set is not None and found.noise_set.radius[7] == 1e-3
    assert [suite["suite"] for suite in found.proof["suites"]] == ["A"]


@pytest.mark.parametrize(
    ("setting", "words"),
    [
        ({"torque": "motr"}, "torque: unknown variant `motr`"),
        ({"centre": "middle"}, "centre: unknown variant `middle`"),
        ({"noise": [1.0, 2.0, 3.0]}, "noise has 3 numbers; give 2 or 12"),
        ({"until": -1.0}, "until is -1.0 s"),
        ({"suites": ["Z"]}, 'no suite "Z"'),
        ({"fit": ["mass"]}, "fit: unknown variant `mass`"),
        ({"paper_model": 4}, "paper_model is 4; give 1 to 3"),
        ({"order": 0}, "order"),
        ({"weights": [0.0, 1.0]}, "weight 1 is 0"),
    ],
)
def test_a_wrong_setting_is_named(
    robot: rt.Robot, data: rt.Recordings, setting: dict[str, object], words: str
) -> None:
    arguments = {"torque": "motor", **setting}
    with pytest.raises(rt.SettingError, match=words):
        rt.conform(robot, data, **arguments)  # type: ignore[arg-type]


def test_torque_has_no_default(robot: rt.Robot, data: rt.Recordings) -> None:
    with pytest.raises(TypeError, match="torque"):
        rt.conform(robot, data)  # type: ignore[call-arg]


def test_defects_name_file_line_and_joint(tmp_path: Path, robot: rt.Robot) -> None:
    (tmp_path / "runs.csv").write_text("file,suite\none.csv,A\n")
    (tmp_path / "one.csv").write_text("t,q1,qd1,tau1\n0.0,0,0,0\n0.1,nan,0,0\n")
    with pytest.raises(rt.DefectsError) as error:
        rt.conform(robot, rt.Recordings.open(tmp_path), torque="motor")
    defects = error.value.defects
    assert defects and all(defect.file.endswith("one.csv") for defect in defects)
    assert pickle.loads(pickle.dumps(error.value)).defects == defects
    with pytest.raises(rt.DefectsError) as error:
        rt.Recordings.open(tmp_path)[0]
    assert (error.value.defects[0].line, error.value.defects[0].joint) == (3, 1)


def test_the_path_of_a_folder_is_its_data_set(
    robot: rt.Robot, data: rt.Recordings, model: rt.Model, tmp_path: Path
) -> None:
    folder = write_csv(tmp_path, list(data))
    for path in (tmp_path, str(tmp_path)):
        assert rt.check(model, path) == rt.check(model, folder)
    with pytest.raises(rt.ReachtubeError, match=r"none.*runs\.csv.*give the folder"):
        rt.check(model, tmp_path / "none")


@pytest.mark.parametrize(
    ("given", "words"),
    [
        (42, "of type int; give Recordings, runs or the path of a folder"),
        (None, "of type NoneType"),
        ([1.0], r"item 1 of the recordings is of type float; give runs: Run\(t, q"),
        (np.zeros((3, 6)), "item 1 .* of type ndarray"),
    ],
)
def test_what_is_no_recording_is_named(model: rt.Model, given: object, words: str) -> None:
    with pytest.raises(rt.SettingError, match=words):
        rt.check(model, given)  # type: ignore[arg-type]
    with pytest.raises(rt.SettingError, match=words):
        rt.Recordings(given)  # type: ignore[arg-type]


def test_a_path_is_opened_and_not_iterated() -> None:
    with pytest.raises(rt.SettingError, match=r"is a path.*Recordings\.open\('folder'\)"):
        rt.Recordings("folder")  # type: ignore[arg-type]


def test_a_robot_with_other_joints_is_refused(data: rt.Recordings) -> None:
    pendulum = rt.Robot.from_dict(
        {**rt.Robot.lwa4p().to_dict(), "joint": rt.Robot.lwa4p().to_dict()["joint"][:2]}
    )
    with pytest.raises(rt.DefectsError, match="6 joints, but the robot has 2"):
        rt.conform(pendulum, data, torque="motor")


def test_the_report_is_written_once(
    model: rt.Model, data: rt.Recordings, tmp_path: Path
) -> None:
    page = rt.report(model, data, tmp_path, assets="beside")
    assert page.read_text(encoding="utf-8").lstrip().lower().startswith("<!doctype html>")
    with pytest.raises(rt.ReachtubeError, match="exists"):
        rt.report(model, data, tmp_path)
    with pytest.raises(rt.SettingError, match="assets is 'outside'; give 'inside' or 'beside'"):
        rt.report(model, data, tmp_path, assets="outside")  # type: ignore[arg-type]


def test_implausible_answers_are_warned_of(robot: rt.Robot) -> None:
    turned = [
        rt.Run(run.t, run.q, run.qd, -run.tau, suite=run.suite, motion=run.motion)
        for run in runs(robot)
    ]
    with pytest.warns(rt.ReachtubeWarning, match="the torques have the opposite sign"):
        rt.conform(robot, turned, torque="motor")
    with warnings.catch_warnings(record=True) as found:
        warnings.simplefilter("always")
        rt.conform(robot, runs(robot), torque="motor")
    assert not any("have the opposite sign" in str(warning.message) for warning in found)


@pytest.mark.skipif(not SCHUNK.is_dir(), reason="needs the paper's recordings, ../shared/data")
def test_the_papers_recordings_cost_what_the_command_finds(robot: rt.Robot) -> None:
    data = rt.Recordings.open(SCHUNK)
    found = rt.conform(robot, data, torque="compensated", suites=["A", "B", "D", "E"])
    assert found.verified and round(float(found.cost_of_samples or 0), 3) == 6048.048
    assert round(float(found.cost or 0), 6) == 24.192192


def test_the_schema_of_models_has_the_notions_and_the_choices() -> None:
    schema = json.loads(_reachtube.model_schema())["$defs"]
    assert [one["const"] for one in schema["Notion"]["oneOf"]] == list(get_args(_settings.Notion))
    known = {"paper_model", "order", "expansion", "max_gap"}
    known |= {*schema["Settings"]["properties"], *schema["ArmSettings"]["properties"]}
    assert set(_settings.among(inspect.signature(rt.conform).parameters)) <= known
