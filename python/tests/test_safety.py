"""Stops and obstacles, from Python."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import numpy as np
import pytest

import reachtube as rt

from conftest import runs, write_csv

BRAKES: dict[str, Any] = {
    "torque": [[45, 60]] * 4 + [[22, 30]] * 2,
    "delay": [0.01, 0.03],
    "deceleration": [4, 4, 4, 6, 6, 6],
}


def test_stops_are_typed_and_those_of_the_file(
    model: rt.Model, data: rt.Recordings, tmp_path: Path
) -> None:
    study = rt.stop(model, data, BRAKES, every=20)
    assert study and study.category == 0 and len(study.stops) == 2 * 6
    assert study.findings[0].code == "stands" and study.findings[0].numbers["not_proved"] == 0
    assert str(study).startswith(study.findings[0].text)
    worst = max(study.stops, key=lambda stop: stop.way)
    assert 0 < worst.way < 0.5 and worst.proved == worst.samples == 3
    # The same brakes in a file, in other notation, give the same answer.
    file = tmp_path / "brakes.toml"
    file.write_text(
        f"torque = {BRAKES['torque']}\ndelay = [0.01, 0.03]\ndeceleration = [4, 4, 4, 6, 6, 6]\n"
    )
    assert rt.stop(model, data, file, every=20) == study
    arrays = {**BRAKES, "torque": np.array(BRAKES["torque"], float)}
    assert rt.stop(model, data, arrays, every=20) == study
    assert rt.StopStudy.from_bytes(study.to_bytes()) == study
    assert len(study.to_pandas()) == 12 and "<table" in study._repr_html_()
    with pytest.raises(rt.SettingError, match="table=True"):
        study.save(tmp_path)


def test_a_table_and_a_recorded_stop(
    model: rt.Model, robot: rt.Robot, data: rt.Recordings, tmp_path: Path
) -> None:
    # An arm that moves on is no stop.
    moving = runs(robot, count=1)[0]
    study = rt.stop(model, data, BRAKES, every=50, table=True, recorded=[moving], suites="A")
    assert not study and study.findings[0].code == "stop-not-covered"
    assert study.recorded[0].time is None and not study.recorded[0].is_within
    assert {row.category for row in study.annex_b} == {0, 1} and study.annex_b[0].time > 0
    assert "table-incomplete" in {finding.code for finding in study.findings}
    study.save(tmp_path / "stops")
    assert "Annex B" in (tmp_path / "stops/stop.html").read_text()
    with pytest.raises(rt.ReachtubeError, match="force=True"):
        study.save(tmp_path / "stops")


def test_brakes_that_are_not_possible_are_refused(model: rt.Model, data: rt.Recordings) -> None:
    with pytest.raises(rt.SettingError, match="brakes:.*torque has 1 entries"):
        rt.stop(model, data, {"torque": [[45, 60]], "delay": [0.01, 0.03]})
    without = {key: value for key, value in BRAKES.items() if key != "deceleration"}
    with pytest.raises(rt.SettingError, match="category 1 need"):
        rt.stop(model, data, without, category=1)
    with pytest.raises(rt.SettingError, match="category is 2"):
        rt.stop(model, data, BRAKES, category=2)  # type: ignore[arg-type]
    with pytest.raises(rt.ReachtubeError, match="none.toml"):
        rt.stop(model, data, "none.toml")


def test_verdicts_are_typed(model: rt.Model, robot: rt.Robot, tmp_path: Path) -> None:
    model.save(tmp_path / "model.json")
    (tmp_path / "recordings").mkdir()
    write_csv(tmp_path / "recordings", runs(robot, count=1))

    def scenario(height: float) -> dict[str, Any]:
        floor = {"normal": [0, 0, 1], "offset": height}
        return {
            "model": tmp_path / "model.json",
            "data": tmp_path / "recordings",
            "suites": ["A"],
            "until": 0.1,
            "obstacle": [{"name": "floor", "half-space": floor, "links": ["joint6"]}],
        }

    answer = rt.verify(scenario(-2.0))
    assert answer and answer.answer == "safe" and answer.findings[0].code == "safe"
    [motion] = answer.motions
    assert motion.closest is None and motion.clearances[0].obstacle == "floor"
    assert motion.clearances[0].distance == answer.findings[0].numbers["proved_distance"] > 1.0
    assert {margin.link for margin in motion.margins} >= {"joint6"}
    assert list(answer.pictures) == ["A.svg"] and "<svg" in answer._repr_html_()
    below = rt.verify(scenario(2.0))
    assert not below and below.answer == "unsafe"
    found = below.motions[0].closest
    assert found is not None and found.distance < 0 and len(found.start) == 12
    assert found.stop is None
    below.save(tmp_path / "cell")
    assert {path.name for path in (tmp_path / "cell").iterdir()} == {"A.svg", "A_closest.csv"}
    # A file, and a model and recordings in memory, give the same answer.
    text = 'model = "model.json"\ndata = "recordings"\nsuites = ["A"]\nuntil = 0.1\n'
    text += '[[obstacle]]\nname = "floor"\nlinks = ["joint6"]\n'
    text += "half-space = { normal = [0, 0, 1], offset = -2.0 }\n"
    (tmp_path / "cell.toml").write_text(text)
    assert rt.verify(tmp_path / "cell.toml") == answer
    assert rt.verify({**scenario(-2.0), "model": model, "data": runs(robot, count=1)}) == answer
    assert motion.stops is None
    brakes = f"torque = {BRAKES['torque']}\ndelay = [0.01, 0.03]\n"
    (tmp_path / "brakes.toml").write_text(brakes)
    stopped = rt.verify({**scenario(-2.0), "stop": {"brakes": tmp_path / "brakes.toml"}})
    [motion] = stopped.motions
    assert stopped and motion.stops is not None
    wrist = motion.stops[-1]
    assert wrist.link == "joint6" and 0 < wrist.way < 0.5 and wrist.stop_at <= 0.1
    assert wrist.distance == pytest.approx(wrist.way + 1.6 * wrist.time)
    with pytest.raises(rt.SettingError, match="nothing to stay clear of"):
        rt.verify({**scenario(0.0), "obstacle": []})


def test_a_monitor_has_findings(model: rt.Model, robot: rt.Robot) -> None:
    run = runs(robot, count=1)[0]
    watch = rt.monitor(model, step=0.004, horizon=0.1)
    assert [finding.code for finding in watch.findings] == ["never-left"]
    left = watch.push(run.t, run.q, run.qd, run.tau + 5.0)
    assert left and [finding.code for finding in watch.findings] == ["left-set", "left-set"]
    assert watch.findings[1].place == f"joint{left[0].part}"
    assert "left its set" in str(watch.findings[1])
