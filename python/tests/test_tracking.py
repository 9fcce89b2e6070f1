"""Arms under their controllers."""

from __future__ import annotations

import pickle
from pathlib import Path

import numpy as np
import pytest

import reachtube as rt

LAGS = (0.009, 0.014)

ARM = """<robot name="two"><link name="base"/>
<link name="upper"><collision><origin xyz="0.25 0 0" rpy="0 1.5707963 0"/>
  <geometry><cylinder length="0.5" radius="0.04"/></geometry></collision></link>
<link name="fore"><collision><origin xyz="0.25 0 0" rpy="0 1.5707963 0"/>
  <geometry><cylinder length="0.5" radius="0.03"/></geometry></collision></link>
<joint name="shoulder" type="continuous"><parent link="base"/><child link="upper"/>
  <axis xyz="0 0 1"/></joint>
<joint name="elbow" type="continuous"><parent link="upper"/><child link="fore"/>
  <origin xyz="0.5 0 0"/><axis xyz="0 0 1"/></joint></robot>"""


def wave(number: int, t: np.ndarray) -> np.ndarray:
    """Return the command of a plan, which rests at both ends."""
    random = np.random.default_rng(number)
    size, rate = random.uniform(0.2, 0.6, 2), random.uniform(0.8, 2.0, 2)
    rise = np.clip(np.minimum(t, 6.0 - t) / 1.5, 0.0, 1.0)[:, None]
    return rise**3 * (10 - 15 * rise + 6 * rise**2) * size * np.sin(rate * t[:, None])


def recorded(number: int) -> dict[str, np.ndarray]:
    t = 0.01 * np.arange(600)
    noise = np.random.default_rng(1000 + number).uniform(-1e-4, 1e-4, (600, 2))
    late = np.column_stack([wave(number, t - lag)[:, i] for i, lag in enumerate(LAGS)])
    return {"t": t, "command": wave(number, t), "actual": late + noise}


def model(count: int = 8) -> rt.TrackingModel:
    return rt.TrackingModel.of([recorded(k) for k in range(count)], joints=["shoulder", "elbow"])


def test_a_model_is_made_checked_saved_and_followed(tmp_path: Path) -> None:
    made = model()
    assert made and made.verified and "conformant and useful" in str(made)
    assert made.lags == pytest.approx(dict(zip(made.joints, LAGS, strict=True)), abs=1e-4)
    other = recorded(20)
    other["actual"] = other["actual"] + 0.05
    assert made.check([recorded(1)]) and not made.check([other])
    made.save(tmp_path / "model.json")
    again = rt.TrackingModel.load(tmp_path / "model.json")
    assert again.to_dict() == made.to_dict() and again.useful
    assert pickle.loads(pickle.dumps(made)) == made
    run = recorded(2)
    tube = made.tube(run["t"], run["command"])
    assert ((tube.lower <= run["actual"]) & (run["actual"] <= tube.upper)).all()
    along, goal = made.tolerances()["elbow"]
    assert along > goal > np.abs(run["actual"][-1] - run["command"][-1]).max()


def test_frames_and_columns_of_arrays_are_taken() -> None:
    pandas = pytest.importorskip("pandas")
    frames = []
    for number in range(8):
        run = recorded(number)
        columns = {"action": list(run["command"]), "observation.state": list(run["actual"])}
        frames.append(pandas.DataFrame({"timestamp": run["t"], **columns}))
    made = rt.TrackingModel.of(frames, joints=["shoulder", "elbow"])
    assert made.to_dict()["joints"] == model().to_dict()["joints"]


def test_links_are_padded(tmp_path: Path) -> None:
    urdf = tmp_path / "arm.urdf"
    urdf.write_text(ARM)
    made = model()
    path, time = made.padding(urdf), made.padding(urdf, same_time=True)
    assert 0.0 < path["upper"] < path["fore"] < time["fore"] < 0.1
    assert made.padding(urdf, speed=0.5)["fore"] < path["fore"]
    with pytest.raises(rt.SettingError, match="up to 1"):
        made.padding(urdf, speed=2.0)


def test_wrong_recordings_and_plans_are_named() -> None:
    run = recorded(0)
    wrong = {
        "no times": {"command": run["command"], "actual": run["actual"]},
        "no commanded and actual": {"t": run["t"]},
        "have the shapes": {**run, "actual": run["actual"][:-1]},
        "finite numbers": {**run, "actual": np.full((600, 2), np.nan)},
        "do not increase": {**run, "t": run["t"][::-1]},
        "but 2 are needed": {**run, "command": run["t"], "actual": run["t"]},
    }
    for text, bad in wrong.items():
        with pytest.raises(rt.SettingError, match=text):
            rt.TrackingModel.of([run, bad])
    with pytest.raises(rt.ReachtubeError, match="no measurement"):
        rt.TrackingModel.of([{**run, "actual": run["command"]}])
    with pytest.raises(rt.SettingError, match="no recordings"):
        rt.TrackingModel.of([])
    made = model()
    with pytest.raises(rt.ReachtubeError, match="% of its speed"):
        made.tube(run["t"] / 5.0, run["command"])
    with pytest.raises(rt.SettingError, match="1 joints"):
        made.tube(run["t"], run["command"][:, 0])
