"""From logs to a model in one call, against the command's files and the recordings."""

from __future__ import annotations

import json
import os
import pickle
import re
import subprocess
import warnings
from collections.abc import Callable
from dataclasses import dataclass
from functools import partial
from pathlib import Path
from typing import Any

import numpy as np
import pytest

import reachtube as rt
from reachtube import _conform

from conftest import write_csv


def wave(robot: rt.Robot, number: int, joints: int) -> rt.Run:
    """Return a motion of some joints, with torques of the robot's own dynamics."""
    random = np.random.default_rng(number)
    t = 0.004 * np.arange(750)
    rates = random.uniform(1.0, 3.0, joints)
    size = 0.4 / rates
    phase = rates * t[:, None] + random.uniform(0, 6, joints)
    q, qd = size * np.sin(phase), size * rates * np.cos(phase)
    qdd = -(rates**2) * q
    tau = robot.rnea(q, qd, qdd) + robot.viscous_friction(qd) + robot.coulomb_friction(q, qd)
    noise = random.standard_normal((3, len(t), joints))
    return rt.Run(
        t,
        q + 1e-5 * noise[0],
        qd + 1e-3 * noise[1],
        tau + 0.02 * noise[2],
        motion=f"wave {number}",
        name=f"wave_{number}",
    )


@pytest.fixture(scope="module")
def arm() -> rt.Robot:
    return rt.Robot.lwa4p()


@pytest.fixture(scope="module")
def logs(arm: rt.Robot) -> list[rt.Run]:
    return [wave(arm, number, arm.joints) for number in range(4)]


@pytest.fixture(scope="module")
def choices(tmp_path_factory: pytest.TempPathFactory) -> Path:
    # Three motions give sets so small that the fourth needs three times the set of a joint.
    file = tmp_path_factory.mktemp("choices") / "choices.toml"
    file.write_text("largest-growth = 4.0\nlargest-outside = 0.2\n")
    return file


@pytest.fixture(scope="module")
def built(arm: rt.Robot, logs: list[rt.Run], choices: Path) -> rt.BuiltModel:
    return rt.model(arm, logs, torque="motor", horizon=0.1, settings=choices)


@dataclass
class OfFiles:
    """A model of a robot file and a folder of logs, and what it reported."""

    file: Path
    folder: Path
    built: rt.BuiltModel
    told: list[str]


@pytest.fixture(scope="module")
def of_files(
    arm: rt.Robot, logs: list[rt.Run], choices: Path, tmp_path_factory: pytest.TempPathFactory
) -> OfFiles:
    place, told = tmp_path_factory.mktemp("files"), list[str]()
    folder, file = place / "logs", place / "arm.toml"
    folder.mkdir()
    for run in logs:
        write_csv(folder, [rt.Run(run.t, run.q, run.qd, run.tau)])
        (folder / "1.csv").rename(folder / f"{run.name}.csv")
    (folder / "runs.csv").unlink()
    arm.save(file)
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", rt.ReachtubeWarning)
        found = rt.model(
            rt.Robot.load(file),
            folder,
            "motor",
            horizon=0.1,
            settings=choices,
            progress=lambda done, total, sentences: told.extend(sentences),
        )
    return OfFiles(file, folder, found, told)


@pytest.mark.filterwarnings("ignore::reachtube.ReachtubeWarning")
def test_arrays_become_a_useful_model(built: rt.BuiltModel, arm: rt.Robot) -> None:
    assert built and built.useful and built.conformant and built.model.verified
    assert built.horizon == 0.1
    assert [row.name for row in built.joints] == arm.joint_names
    assert all(row.ratio is not None and row.ratio < 0.5 for row in built.joints)
    assert built.held_out.windows > 0 and built.held_out.failure is None
    # One motion of four is held out.
    chosen = {choice.key: choice for choice in built.choices}
    assert chosen["held-out"].value == "wave 3" and "every fourth" in chosen["held-out"].reason
    assert [w.horizon for w in built.horizons][:2] == [0.1, 0.2]
    assert len(built.horizons[0].ratios) == arm.joints
    assert "conformant" in [finding.code for finding in built.findings]
    assert "conformant and useful up to 0.1 s" in str(built) and "conformant" in repr(built)
    assert "--" not in str(built)
    assert list(built.to_pandas().columns[:2]) == ["name", "half_width"]
    assert "<table" in built._repr_html_()
    assert pickle.loads(pickle.dumps(built)) == built


@pytest.mark.filterwarnings("ignore::reachtube.ReachtubeWarning")
def test_logs_are_prepared_for_the_model(built: rt.BuiltModel, logs: list[rt.Run]) -> None:
    verdict = rt.check(built.model, logs[:3])
    assert verdict and verdict.violations == 0
    everything = built.model.check(rt.Recordings(logs))
    assert everything.violations == built.held_out.outside
    # A torque that no robot of this kind has leaves the sets.
    run = logs[0]
    pushed = rt.Run(run.t, run.q, run.qd, run.tau + 30.0 * np.sin(20 * run.t)[:, None], name="odd")
    assert not rt.check(built.model, pushed)
    assert len(rt.reach(built.model, logs[:1])) == len(verdict.suites) / 3


def gapped(run: rt.Run) -> rt.Run:
    """Return a run without the samples of 0.08 s."""
    kept = np.r_[:60, 80 : len(run)]
    return rt.Run(run.t[kept], run.q[kept], run.qd[kept], run.tau[kept], name="gapped")


@pytest.mark.filterwarnings("ignore::reachtube.ReachtubeWarning")
def test_no_window_crosses_a_gap(
    built: rt.BuiltModel, arm: rt.Robot, logs: list[rt.Run], tmp_path: Path
) -> None:
    brakes = {"torque": [[45, 60]] * 6, "delay": [0.01, 0.03]}
    run = gapped(logs[0])
    jobs: list[Callable[..., object]] = [
        partial(rt.check, built.model, run),
        partial(rt.reach, built.model, run),
        partial(rt.report, built.model, run, tmp_path),
        partial(rt.stop, built.model, run, brakes, every=20),
    ]
    for job in jobs:
        with pytest.raises(rt.SettingError, match="no window of a log crosses one"):
            job(max_gap=0.1)
        job()
    crossed = rt.check(built.model, logs[0])
    assert len(rt.check(built.model, run).suites) < len(crossed.suites)
    with pytest.raises(rt.ReachtubeError, match="as long as the horizon of 9 s"):
        rt.model(arm, [*logs, run], torque="motor", horizon=9.0)


@pytest.mark.filterwarnings("ignore::reachtube.ReachtubeWarning")
def test_a_fit_is_what_its_arguments_say(
    arm: rt.Robot, logs: list[rt.Run], choices: Path, tmp_path: Path
) -> None:
    found = rt.model(
        arm, logs, "motor", horizon=0.05, settings=choices, fit=["viscous"], pull=0.02
    )
    assert {choice.key: choice.value for choice in found.choices}["fit"] == "viscous"
    assert found.model.verified
    found.save(tmp_path)
    written = (tmp_path / "choices.toml").read_text().splitlines()
    assert {'fit = ["viscous"]', "pull = 0.02"} <= set(written)
    for wrong, words in [
        ({"pull": 0.02}, "fit names no group"),
        ({"fit": ["viscous"], "pull": 2.0}, "pull is 2.0; give a weight from 0 to 1"),
        ({"fit": ["mass"]}, "fit: unknown variant `mass`"),
        ({"gains": [np.nan] * 6}, "gains is .*; give finite numbers"),
        ({"gains": [1.0] * 5}, "gains: 5 given; give one for each of the 6 joints"),
        ({"gains": [0.0] * 6}, "gain 1 is 0"),
    ]:
        with pytest.raises(rt.SettingError, match=words):
            rt.model(arm, logs, "motor", **wrong)  # type: ignore[arg-type]


def test_the_order_and_the_temperatures_of_runs_are_kept(
    arm: rt.Robot, logs: list[rt.Run]
) -> None:
    warm: dict[str, Any] = {"torque": "motor", "fit": ["warm-up"], "horizon": 9.0}
    with pytest.raises(rt.ReachtubeError, match="warm-up, for wave_0"):
        rt.model(arm, logs, **warm)
    ordered, heated = [], []
    for order, run in zip((7, 3), logs, strict=False):
        part = (run.t, run.q, run.qd, run.tau)
        ordered.append(rt.Run(*part, suite="A", motion="m", order=order, name=run.name))
        heat = np.full(run.q.shape, 20.0 + order)
        heated.append(rt.Run(*part, temperature=heat, name=run.name))
    for given in (ordered, heated):
        with pytest.raises(rt.ReachtubeError, match="as long as the horizon of 9 s"):
            rt.model(arm, given, **warm)
    # Windows of logs have both.
    for given, expected in [(ordered, {7, 3}), (heated, {1})]:
        windows, _, _ = _conform._cut(arm, given, "motor", 0.5, None, None, ())
        assert {row[4] for row in windows.index()} == expected
        warmth = windows.read(0).arrays()[4]
        assert (warmth is None) == (given is ordered)
        assert warmth is None or set(warmth.ravel()) == {27.0}
    # Runs of two data sets may have the same order.
    same = [rt.Run(run.t, run.q, run.qd, run.tau, suite="A", order=1) for run in logs[:2]]
    windows, _, _ = _conform._cut(arm, same, "motor", 0.5, None, None, ())
    assert {row[4] for row in windows.index()} == {1, 2}


@pytest.mark.filterwarnings("ignore::reachtube.ReachtubeWarning")
def test_paths_give_the_files_of_the_command(
    built: rt.BuiltModel, of_files: OfFiles, tmp_path: Path
) -> None:
    out, other = tmp_path / "arm", of_files.built
    assert any(sentence.startswith("horizon: 0.1 s") for sentence in of_files.told)
    # Runs in memory have the same numbers; only their motions have other names.
    for own, known in [
        (other.model.initial_set, built.model.initial_set),
        (other.model.input_set, built.model.input_set),
    ]:
        np.testing.assert_array_equal(own.radius, known.radius)
    other.save(out)
    for name in ["model.json", "robot.toml", "choices.toml", "page/report.html",
                 "held-out/report.html"]:
        assert (out / name).is_file(), name
    assert rt.Model.load(out / "model.json") == other.model
    with pytest.raises(rt.ReachtubeError, match="exists"):
        other.save(out)
    # The same choices give the same bytes, and one that is given replaces its own.
    robot = rt.Robot.load(of_files.file)
    again = rt.model(robot, settings=out / "choices.toml")
    again.save(out, force=True)
    assert again.model == other.model
    assert str(of_files.folder) in (out / "choices.toml").read_text()
    assert json.loads(json.dumps(again.to_dict()))["horizon"] == 0.1
    with pytest.raises(rt.ReachtubeError, match="as long as the horizon of 9 s"):
        rt.model(robot, settings=out / "choices.toml", horizon=9.0)


@pytest.mark.filterwarnings("ignore::reachtube.ReachtubeWarning")
def test_parquet_files_give_the_sets_of_their_runs(
    built: rt.BuiltModel, arm: rt.Robot, logs: list[rt.Run], choices: Path, tmp_path: Path
) -> None:
    pyarrow = pytest.importorskip("pyarrow")
    from pyarrow import parquet

    read = []
    for run in logs:
        file = tmp_path / f"{run.name}.parquet"
        parquet.write_table(pyarrow.Table.from_pandas(run.to_pandas()), file)
        read.append(rt.io.parquet(file, motion=run.motion))
    found = rt.model(arm, read, torque="motor", horizon=0.1, settings=choices)
    for own, other in zip(
        [found.model.initial_set, found.model.input_set],
        [built.model.initial_set, built.model.input_set],
        strict=True,
    ):
        np.testing.assert_array_equal(own.radius, other.radius)
        np.testing.assert_array_equal(own.centre, other.centre)
    assert found.held_out == built.held_out and found.joints == built.joints


@pytest.mark.filterwarnings("ignore::reachtube.ReachtubeWarning")
@pytest.mark.skipif("REACHTUBE" not in os.environ, reason="needs the command")
def test_the_files_are_those_of_the_command_byte_for_byte(
    of_files: OfFiles, choices: Path, tmp_path: Path
) -> None:
    of_files.built.save(tmp_path / "python")
    command = [os.environ["REACHTUBE"], "model", "--robot", str(of_files.file)]
    command += ["--data", str(of_files.folder)]
    command += ["--torque", "motor", "--horizon", "0.1", "--settings", str(choices)]
    command += ["--out", str(tmp_path / "command")]
    done = subprocess.run(command, capture_output=True, text=True, check=False)
    # 3 says that the model is not accepted.
    assert done.returncode in (0, 3), done.stderr
    files = ["model.json", "robot.toml", "choices.toml", "page/report.html", "held-out/report.html"]
    for name in files:
        ours, theirs = [(tmp_path / by / name).read_bytes() for by in ("python", "command")]
        assert ours == theirs, name


def test_conform_cuts_logs_at_a_horizon(arm: rt.Robot, logs: list[rt.Run]) -> None:
    model = rt.conform(
        arm,
        logs[:2],
        torque="motor",
        horizon=0.1,
        noise="fitted",
        nominal="own",
        equations="robot",
    )
    assert model.verified
    own = rt.check(model, logs[:2])
    assert own and own.violations == 0
    # Each window is a suite, of both logs.
    assert len(own.suites) > 20 and own.suites[0]["suite"].startswith("wave_0_w")
    with pytest.raises(rt.SettingError, match="exclude each other"):
        rt.conform(arm, logs[:2], torque="motor", horizon=0.1, until=1.0)
    with pytest.raises(rt.SettingError, match="above 0"):
        rt.conform(arm, logs[:2], torque="motor", horizon=-1.0)


def test_wrong_arguments_are_named(arm: rt.Robot, logs: list[rt.Run], tmp_path: Path) -> None:
    for arguments, words in [
        ({"data": logs}, "torque is not given"),
        ({"torque": "motor"}, "no recordings are given"),
        ({"data": logs, "torque": "motors"}, "torque: unknown variant `motors`"),
        ({"data": logs, "torque": "motor", "horizon": -1.0}, "horizon is -1.0 s"),
        ({"data": logs, "torque": "motor", "horizon": 9.0}, "as long as the horizon of 9 s"),
        (
            {"data": logs, "torque": "motor", "held_out": ["z"]},
            'held_out "z" .*the motions are wave 0, wave 1',
        ),
        ({"data": [1], "torque": "motor"}, "a recording is of type int"),
        ({"data": tmp_path / "none", "torque": "motor"}, "none"),
        ({"settings": tmp_path / "none.toml"}, "none.toml"),
    ]:
        with pytest.raises(rt.ReachtubeError, match=words):
            rt.model(arm, **arguments)  # type: ignore[arg-type]
    still = np.zeros((500, arm.joints))
    rest = rt.Run(0.004 * np.arange(500), still, still, arm.gravity(still), name="rest")
    with pytest.raises(rt.ReachtubeError, match="1 at rest"):
        rt.model(arm, rest, torque="motor")


def test_windows_of_logs_are_what_the_command_writes(
    arm: rt.Robot, logs: list[rt.Run], tmp_path: Path
) -> None:
    windows = rt.prepare(arm, logs[:2], window=0.5, cut_off=20.0, compensate=True)
    assert len(windows) == 10 and windows.suites[0] == "wave_0_w01"
    first = windows[0]
    assert first.motion == "wave_0" and len(first) == 126 and first.duration == 0.5
    # Gravity and friction are taken off: what is left is the inertia's part.
    assert np.abs(first.tau).max() < 0.5 * np.abs(logs[0].tau).max()
    model = rt.conform(arm, windows, torque="compensated", nominal="own", noise="fitted")
    assert rt.check(model, windows)
    # Names of repeats, columns in another order, and gains are taken as the command takes them.
    names = arm.joint_names[::-1]
    turned = rt.Run(logs[0].t, logs[0].q[:, ::-1], logs[0].qd[:, ::-1], logs[0].tau[:, ::-1] / 2)
    by_name = rt.prepare(arm, turned, joints=names, gains=[2.0] * arm.joints, cut_off=20.0)
    plain = rt.prepare(arm, logs[0], cut_off=20.0)
    np.testing.assert_allclose(by_name[0].tau, plain[0].tau, atol=2e-7)
    with pytest.raises(rt.ReachtubeError, match="as long as the window of 9 s"):
        rt.prepare(arm, logs, window=9.0)
    with pytest.raises(rt.SettingError, match="window is -1"):
        rt.prepare(arm, logs, window=-1.0)
    with pytest.raises(rt.SettingError, match="unknown field"):
        rt.prepare(arm, logs, columns={"torque": "m_{}"})
    with pytest.raises(rt.SettingError, match="gains: 1 given"):
        rt.prepare(arm, logs, gains=[2.0])
    with pytest.raises(rt.SettingError, match="must name each of the robot's 6 joints"):
        rt.prepare(arm, logs, joints=["a"])


def test_runs_of_files_of_other_libraries_are_the_same_runs(
    logs: list[rt.Run], tmp_path: Path
) -> None:
    for run in logs:
        path = tmp_path / f"{run.name}.npz"
        np.savez(path, t=run.t, q=run.q, qd=run.qd, tau=run.tau)
        other = rt.io.npz(path, motion=run.motion)
        assert (other.name, other.motion) == (path.name, run.motion)
        for part in ("t", "q", "qd", "tau"):
            np.testing.assert_array_equal(getattr(other, part), getattr(run, part))


def test_columns_and_logs_that_do_not_fit_are_refused(
    arm: rt.Robot, logs: list[rt.Run], tmp_path: Path
) -> None:
    with pytest.raises(rt.SettingError, match="columns: .*speed"):
        rt.model(arm, logs, "motor", columns={"speed": "v{}"})
    with pytest.raises(rt.SettingError, match="log: .*yesterday"):
        rt.model(arm, logs, "motor", time="yesterday")  # type: ignore[arg-type]
    (tmp_path / "run.mcap").write_bytes(b"no log")
    with pytest.raises(rt.ReachtubeError, match="neither MCAP nor SQLite"):
        rt.model(arm, tmp_path, "motor")


@pytest.mark.filterwarnings("ignore::reachtube.ReachtubeWarning")
def test_a_check_says_by_how_much_torques_come_late(
    built: rt.BuiltModel, logs: list[rt.Run]
) -> None:
    late = [
        rt.Run(run.t[15:], run.q[15:], run.qd[15:], run.tau[:-15], motion=f"late {k}")
        for k, run in enumerate(logs)
    ]
    check = built.model.check(late)
    causes = [finding.text for finding in check.findings if finding.code == "cause"]
    assert not check and len(causes) == 1
    lag = re.search(r"come (\d+) ms later", causes[0])
    assert lag is not None and abs(int(lag[1]) - 60) < 10, causes
