"""Linear systems that are seen through their outputs."""

from __future__ import annotations

import pickle
from pathlib import Path

import numpy as np
import pytest

import reachtube as rt


def drives() -> list[dict[str, np.ndarray]]:
    """Return drives through a lag of 0.5 s whose output has an error."""
    random = np.random.default_rng(1)
    decay = np.exp(-0.1)
    runs = []
    for _ in range(4):
        u = np.repeat(random.uniform(-1.0, 1.0, 6), 10)
        v = np.zeros(60)
        for k in range(59):
            v[k + 1] = u[k] + (v[k] - u[k]) * decay + random.uniform(-2e-3, 2e-3)
        runs.append({"t": 0.05 * np.arange(60), "u": u, "v": v})
    return runs


def lag() -> rt.System:
    return rt.System([[-2.0]], [[2.0]], [[1.0]], states=["v"], inputs=["u"], outputs=["v"])


def test_a_model_is_found_checked_saved_and_reached(tmp_path: Path) -> None:
    runs = drives()
    model = lag().conform(runs)
    assert model and model.verified and "narrower than without a model" in str(model)
    assert model.check(runs) and not model.check([{**runs[0], "v": runs[0]["v"] + 0.5}])
    model.save(tmp_path / "model.json")
    again = rt.SystemModel.load(tmp_path / "model.json")
    assert again.to_dict() == model.to_dict()
    assert pickle.loads(pickle.dumps(model)) == model
    for run, tube in zip(runs, model.reach(runs), strict=True):
        assert tube.lower.shape == (60, 1) and np.array_equal(tube.t, run["t"])
        assert (tube.lower[:, 0] <= run["v"]).all() and (run["v"] <= tube.upper[:, 0]).all()


def test_numbers_are_found_without_a_system() -> None:
    model = rt.System.arx(["u"], ["v"], 0.05).conform(drives())
    assert model.useful and model.to_dict()["system"]["kind"] == "discrete"
    assert abs(model.to_dict()["system"]["A"][0][0] - np.exp(-0.1)) < 0.02


def test_given_sets_need_no_recordings() -> None:
    box = {"radius": [0.1], "fixed": True}
    system = rt.System([[-2.0]], C=[[1.0]], start={"at": [1.0]}, X0=box, W="none")
    tube = system.reach(np.linspace(0.0, 1.0, 11))
    decay = np.exp(-2.0 * tube.t)
    assert np.allclose(tube.upper[:, 0], 1.1 * decay, atol=1e-12)
    assert np.allclose(tube.lower[:, 0], 0.9 * decay, atol=1e-12)


def test_systems_of_other_libraries_are_taken() -> None:
    class Other:
        """A state-space system as other libraries have it."""

        A, B, C, D, dt = np.array([[0.5]]), np.array([[1.0]]), np.eye(1), np.zeros((1, 1)), 0.1

    system = rt.System(Other())
    assert system.to_dict()["kind"] == "discrete" and system.to_dict()["step"] == 0.1
    assert system == rt.System([[0.5]], [[1.0]], [[1.0]], [[0.0]], step=0.1)


@pytest.mark.parametrize(
    ("run", "expected"),
    [
        ({"v": [0.0, 1.0]}, "run 1 has no column u"),
        ({"t": [0.0, 0.1], "u": [0.0, 0.0], "v": [0.0]}, "has not"),
        ({"t": [0.0, 0.1], "u": [0.0, 0.0], "v": [0.0, np.nan]}, "v of run 1 is not finite"),
        ({"t": [0.1, 0.1], "u": [0.0, 0.0], "v": [0.0, 0.0]}, "do not increase"),
        ({"u": [0.0, 0.0], "v": [0.0, 0.0]}, "no times t"),
    ],
)
def test_wrong_recordings_are_refused(run: dict[str, list[float]], expected: str) -> None:
    with pytest.raises(rt.SettingError, match=expected):
        lag().conform([run])


def test_a_system_file_is_read(tmp_path: Path) -> None:
    text = "kind = 'continuous'\nstates = ['v']\noutputs = ['v']\nA = [[-1]]"
    (tmp_path / "a.toml").write_text(text)
    assert rt.System.load(tmp_path / "a.toml").to_dict()["A"] == [[-1.0]]
    (tmp_path / "a.toml").write_text("kind = 'continuous'\noutputs = 3")
    with pytest.raises(rt.SettingError, match="line 2, column"):
        rt.System.load(tmp_path / "a.toml")


def test_wrong_systems_are_refused() -> None:
    with pytest.raises(rt.SettingError, match="A needs 2 rows of 2 entries"):
        rt.System([[1.0]], C=[[1.0, 0.0]], states=["a", "b"])
    with pytest.raises(rt.SettingError, match="no recordings"):
        lag().conform([])
