"""Fleets: the bits of one machine, whatever the workers do."""

from __future__ import annotations

import os
import signal
import threading
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import numpy as np
import pytest

import reachtube as rt
from reachtube import _jobs, fleet

from conftest import RUNS, SAMPLES, SUITES, tasks_end_but

pytest.importorskip("pyarrow")
pytest.importorskip("fsspec")
distributed = pytest.importorskip("distributed")

@pytest.fixture(scope="module")
def alone(manifest: Path) -> rt.Model:
    return fleet.conform(rt.Robot.lwa4p(), manifest, torque="compensated")


pytestmark = pytest.mark.filterwarnings("ignore::reachtube.ReachtubeWarning")


def names_left_out(model: rt.Model) -> dict[str, Any]:
    content = model.to_dict()
    for key in ("sha256", "data"):
        content.pop(key)
    # Digests of recordings, which are of files in a fleet and of arrays in memory.
    content["drive"]["robot"].pop("identified_from", None)
    content.pop("seen", None)
    return content


def test_one_task_and_many_give_the_same_bits(manifest: Path, alone: rt.Model) -> None:
    assert alone.verified
    for size in (1, 7, 1000):
        found = fleet.conform(
            rt.Robot.lwa4p(), manifest, torque="compensated", runs_per_task=size
        )
        assert found == alone


def read(manifest: Path) -> list[rt.Run]:
    """Read the recordings of a manifest one by one."""
    runs = []
    for row in fleet.read_manifest(manifest):
        path = manifest.parent / row.file
        if row.file.endswith(".parquet"):
            run = rt.io.parquet(path, suite=row.suite, motion=row.motion)
        else:
            numbers = np.loadtxt(path, delimiter=",", skiprows=1)
            parts = np.split(numbers[:, 1:], 3, axis=1)
            labels = {"suite": row.suite, "motion": row.motion, "name": row.file}
            run = rt.Run(numbers[:, 0], *parts, **labels)
        runs.append(run)
    return runs


def test_a_fleet_is_the_data_set(manifest: Path, alone: rt.Model) -> None:
    runs = read(manifest)
    assert len(runs) == SUITES * RUNS
    found = rt.conform(rt.Robot.lwa4p(), runs, torque="compensated")
    assert names_left_out(found) == names_left_out(alone)
    fit = {"fit": ["viscous"], "pull": 0.02}
    by_run = {"fit": ["warm-up"], "pull": 0.02, "nominal": "own"}
    for other in [{"equations": "robot"}, fit, by_run]:
        arguments: dict[str, Any] = {"torque": "compensated", **other}
        folded = fleet.conform(rt.Robot.lwa4p(), manifest, **arguments)
        assert folded.verified and folded.cost != alone.cost
        found = rt.conform(rt.Robot.lwa4p(), runs, **arguments)
        assert names_left_out(found) == names_left_out(folded)


def test_a_fit_that_cannot_be_is_refused_before_anything_is_read(
    manifest: Path, tmp_path: Path
) -> None:
    robot, nowhere = rt.Robot.lwa4p(), tmp_path / "nowhere.parquet"
    for arguments, words in [
        ({"torque": "compensated", "fit": ["bogus"]}, "fit: unknown variant `bogus`"),
        ({"torque": "compensated", "pull": 0.02}, "fit names no group"),
        ({"torque": "compensated", "fit": "viscous", "pull": 2.0}, "from 0 to 1"),
        ({"torque": "compensated", "fit": ["viscous"], "notion": "exact"}, 'notion="hull"'),
    ]:
        with pytest.raises(rt.ReachtubeError, match=words):
            fleet.conform(robot, nowhere, **arguments)
    for choice, words in [
        ({"on_defect": "ignore"}, "on_defect is 'ignore'; give 'raise' or 'report'"),
        ({"runs_per_task": 1.5}, "runs_per_task is 1.5 of type float"),
        ({"runs_per_task": 0}, "runs_per_task is 0"),
    ]:
        with pytest.raises(rt.SettingError, match=words):
            fleet.conform(robot, manifest, torque="compensated", **choice)  # type: ignore[arg-type]
    # Only a fold can know that its recordings share their input.
    with pytest.raises(rt.ReachtubeError, match="a fit of warm-up needs each recording"):
        fleet.conform(robot, manifest, torque="compensated", fit=["warm-up"], pull=0.02)


def test_workers_give_the_same_bits(manifest: Path, alone: rt.Model, client: Any) -> None:
    found = fleet.conform(
        rt.Robot.lwa4p(), manifest, torque="compensated", client=client, runs_per_task=3
    )
    assert found == alone
    verdict = fleet.check(alone, manifest, client=client, runs_per_task=3)
    assert verdict and verdict == fleet.check(alone, manifest)
    fit: dict[str, Any] = {"torque": "compensated", "fit": ["viscous"], "pull": 0.02}
    found = fleet.conform(rt.Robot.lwa4p(), manifest, client=client, runs_per_task=3, **fit)
    assert found == fleet.conform(rt.Robot.lwa4p(), manifest, **fit)


def test_a_worker_that_is_killed_changes_nothing(
    manifest: Path, alone: rt.Model, client: Any
) -> None:
    victim = next(iter(client.run(os.getpid).values()))
    killed: list[int] = []

    def kill(done: int, total: int, words: list[str]) -> None:
        if done == 2 and not killed:
            killed.append(victim)
            os.kill(victim, signal.SIGKILL)

    found = fleet.conform(
        rt.Robot.lwa4p(), manifest, torque="compensated", client=client, runs_per_task=1,
        progress=kill,
    )
    assert killed and found == alone


def test_the_only_worker_is_killed_and_replaced(manifest: Path, alone: rt.Model) -> None:
    killed: list[int] = []
    with (
        distributed.LocalCluster(
            n_workers=1, threads_per_worker=1, dashboard_address=None, processes=True
        ) as cluster,
        distributed.Client(cluster) as client,
    ):

        def kill(done: int, total: int, words: list[str]) -> None:
            # Everything that the job has so far is with this worker.
            if done == 5 and not killed:
                killed.extend(client.run(os.getpid).values())
                os.kill(killed[0], signal.SIGKILL)

        found = fleet.conform(
            rt.Robot.lwa4p(), manifest, torque="compensated", client=client, runs_per_task=1,
            progress=kill,
        )
    assert killed and found == alone


def test_defects_are_named_or_left_out(manifest: Path, tmp_path: Path, client: Any) -> None:
    rows = [row._replace(file=str(manifest.parent / row.file))
            for row in fleet.read_manifest(manifest)]
    (tmp_path / "broken.csv").write_text("t,q1\n0,nonsense\n")
    good = rows[3]
    bad = [
        fleet.Recording("broken.csv", "S0", "m0"),
        fleet.Recording("none.csv", "S0", "m0"),
        good._replace(sha256="00" * 32),
        fleet.Recording(str(tmp_path / "text.parquet"), "S0", "m0"),
    ]
    (tmp_path / "text.parquet").write_text("no Parquet file")
    path = tmp_path / "manifest.parquet"
    fleet.write_manifest(path, [*rows, *bad])
    arguments: dict[str, Any] = {"torque": "compensated", "client": client, "runs_per_task": 5}
    with pytest.raises(rt.DefectsError) as error:
        fleet.conform(rt.Robot.lwa4p(), path, **arguments)
    files = {Path(defect.file).name for defect in error.value.defects}
    assert files == {"broken.csv", "none.csv", Path(good.file).name, "text.parquet"}
    assert "SHA-256" in str(error.value) and "no such file" in str(error.value)
    found = fleet.conform(rt.Robot.lwa4p(), path, on_defect="report", **arguments)
    assert found.verified and found.to_dict()["data"]["skipped"] == 4
    clean = tmp_path / "clean.parquet"
    fleet.write_manifest(clean, rows)
    other = fleet.conform(rt.Robot.lwa4p(), clean, **arguments)
    assert found.cost == other.cost and found.initial_set == other.initial_set


GATE = threading.Event()

FOLDED: list[Any] = []

FOLD_OF = _jobs.fold_of


def fold_two(job: Any, part: Any) -> bytes:
    """Fold a part, the third and later ones only when the gate is open."""
    FOLDED.append(part)
    assert len(FOLDED) <= 2 or GATE.wait(60)
    return FOLD_OF(job, part)


def test_a_stopped_job_leaves_the_workers(
    manifest: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    def stop(done: int, total: int, words: list[str]) -> None:
        if done == 2:
            raise KeyboardInterrupt

    with (
        distributed.LocalCluster(
            n_workers=1, threads_per_worker=1, dashboard_address=None, processes=False
        ) as cluster,
        distributed.Client(cluster) as client,
        monkeypatch.context() as patch,
    ):
        other = client.submit(len, "others", pure=False)
        patch.setattr(_jobs, "fold_of", fold_two)
        # The exception is kept, and with it what the job's frames hold.
        with pytest.raises(KeyboardInterrupt) as stopped:
            fleet.conform(
                rt.Robot.lwa4p(), manifest, torque="compensated", client=client, runs_per_task=1,
                progress=stop,
            )
        assert stopped.tb and tasks_end_but(other, client)
        GATE.set()
        assert other.result() == 6 and len(FOLDED) <= 3


def test_the_recordings_of_one_robot_are_chosen(manifest: Path, tmp_path: Path) -> None:
    rows = [row._replace(file=str(manifest.parent / row.file), robot=f"arm{k % 2}")
            for k, row in enumerate(fleet.read_manifest(manifest))]
    path, robot = tmp_path / "two.parquet", rt.Robot.lwa4p()
    fleet.write_manifest(path, [*rows, rows[0]._replace(robot=None)])
    with pytest.raises(rt.SettingError, match=r"arm0 \(20\), arm1 \(20\), no name \(1\).*robots=N"):
        fleet.conform(robot, path, torque="compensated")
    with pytest.raises(rt.SettingError, match="no recording is of robot 'arm2'"):
        fleet.conform(robot, path, torque="compensated", robots=["arm0", "arm2"])
    # The same recordings in a manifest of their own.
    fleet.write_manifest(tmp_path / "one.parquet", [row for row in rows if row.robot == "arm1"])
    one = fleet.conform(robot, tmp_path / "one.parquet", torque="compensated")
    chosen = fleet.conform(robot, path, torque="compensated", robots="arm1")
    assert chosen.cost == one.cost and chosen.proof["runs"] == 20
    both = fleet.conform(robot, path, torque="compensated", robots=["arm0", "arm1"])
    assert both.proof["runs"] == 40
    assert not fleet.check(one, path, robots="arm0") and fleet.check(one, path, robots="arm1")


def test_a_temperature_of_the_manifest_is_that_of_the_recording(
    manifest: Path, tmp_path: Path
) -> None:
    import pandas

    description = rt.Robot.lwa4p().to_dict()
    for joint in description["joint"]:
        law = {"by": "temperature", "reference": 20.0, "coulomb": 0.01, "viscous": 0.02}
        joint["friction"]["warming"] = law
    robot = rt.Robot.from_dict(description)
    rows = [row._replace(file=str(manifest.parent / row.file), temperature=20.0 + 4.0 * k)
            for k, row in enumerate(fleet.read_manifest(manifest)[:6])]
    # As pandas writes it, where one is not known.
    table = pandas.DataFrame([row._asdict() for row in rows])
    table.loc[5, "temperature"] = float("nan")
    table.to_parquet(tmp_path / "warm.parquet")
    found = fleet.conform(robot, tmp_path / "warm.parquet", torque="compensated")
    runs = []
    for row in rows:
        of_file = pandas.read_parquet if row.file.endswith(".parquet") else pandas.read_csv
        columns = of_file(row.file)
        parts = np.split(columns.to_numpy()[:, 1:], 3, axis=1)
        warm = None if row is rows[5] else np.full(parts[0].shape, row.temperature)
        labels = {"suite": row.suite, "motion": row.motion, "name": row.file}
        runs.append(rt.Run(columns["t"], *parts, temperature=warm, **labels))
    expected = rt.conform(robot, runs, torque="compensated")
    assert names_left_out(found) == names_left_out(expected)
    cold = fleet.conform(robot, manifest, torque="compensated", until=0.05, nominal="own")
    assert cold.cost != found.cost
    fleet.write_manifest(tmp_path / "hot.parquet", [rows[0]._replace(temperature=300.0)])
    with pytest.raises(rt.ReachtubeError, match="row 0 .*temperature 300.0 °C"):
        fleet.conform(robot, tmp_path / "hot.parquet", torque="compensated")


def test_summaries_are_a_table(manifest: Path, tmp_path: Path) -> None:
    from pyarrow import parquet

    fleet.conform(
        rt.Robot.lwa4p(), manifest, torque="compensated", runs_per_task=15,
        summaries=tmp_path / "runs",
    )
    table = parquet.read_table(tmp_path / "runs").to_pandas()
    assert list(table["place"]) == list(range(SUITES * RUNS))
    assert set(table["samples"]) == {SAMPLES} and (table["defects"] == "").all()
    assert (table["sha256"].str.len() == 64).all()


def test_wrong_manifests_are_refused(tmp_path: Path) -> None:
    import pyarrow
    from pyarrow import parquet

    robot = rt.Robot.lwa4p()
    with pytest.raises(rt.ReachtubeError, match="no such file"):
        fleet.conform(robot, tmp_path / "none.parquet", torque="motor")
    (tmp_path / "text.parquet").write_text("text")
    with pytest.raises(rt.ReachtubeError, match="no Parquet file"):
        fleet.conform(robot, tmp_path / "text.parquet", torque="motor")
    parquet.write_table(pyarrow.table({"file": ["a.csv"]}), tmp_path / "short.parquet")
    with pytest.raises(rt.ReachtubeError, match="missing: suite"):
        fleet.conform(robot, tmp_path / "short.parquet", torque="motor")
    parquet.write_table(
        pyarrow.table({"file": ["a.csv"], "suite": [None]}), tmp_path / "empty.parquet"
    )
    with pytest.raises(rt.ReachtubeError, match="row 0"):
        fleet.conform(robot, tmp_path / "empty.parquet", torque="motor")
    with pytest.raises(rt.ReachtubeError, match="use the notion hull"):
        fleet.conform(robot, tmp_path / "empty.parquet", torque="motor", notion="exact")


@pytest.fixture
def store(manifest: Path) -> Iterator[dict[str, Any]]:
    """A store on loopback, with the fleet's files."""
    server = pytest.importorskip("moto.server")
    s3fs = pytest.importorskip("s3fs")
    running = server.ThreadedMotoServer(port=0, verbose=False)
    running.start()
    host, port = running.get_host_and_port()
    options = {
        "key": "a",
        "secret": "b",
        "client_kwargs": {"endpoint_url": f"http://{host}:{port}"},
    }
    files = s3fs.S3FileSystem(**options, skip_instance_cache=True)
    files.mkdir("fleet")
    files.put([str(path) for path in manifest.parent.iterdir()], "fleet/")
    yield options
    running.stop()


def test_a_store_of_objects_gives_the_same_bits(
    store: dict[str, Any], alone: rt.Model, client: Any
) -> None:
    found = fleet.conform(
        rt.Robot.lwa4p(),
        "s3://fleet/manifest.parquet",
        torque="compensated",
        client=client,
        runs_per_task=8,
        storage_options=store,
        resume="s3://fleet/tasks",
    )
    assert found == alone


def test_a_store_that_fails_is_asked_again(
    manifest: Path, alone: rt.Model, monkeypatch: pytest.MonkeyPatch
) -> None:
    import fsspec

    from reachtube import _store

    asked: dict[str, int] = {}
    opened = fsspec.open

    def unsure(address: str, *arguments: Any, **options: Any) -> Any:
        asked[address] = asked.get(address, 0) + 1
        if asked[address] <= 2:
            raise OSError(f"503 of {address}")
        return opened(address, *arguments, **options)

    monkeypatch.setattr(fsspec, "open", unsure)
    monkeypatch.setattr(_store, "WAIT", 1e-4)
    found = fleet.conform(rt.Robot.lwa4p(), manifest, torque="compensated")
    assert found == alone and set(asked.values()) == {3}
    monkeypatch.setattr(_store, "TRIES", 2)
    asked.clear()
    with pytest.raises(rt.ReachtubeError, match="in 2 tries: 503"):
        fleet.conform(rt.Robot.lwa4p(), manifest, torque="compensated")
