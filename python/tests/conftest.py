"""Recordings of a small virtual arm, made of the robot's own dynamics."""

from __future__ import annotations

import os
import time
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import numpy as np
import pytest

import reachtube as rt

SHARED = Path(os.environ.get("REACHTUBE_SHARED", Path(__file__).parents[3] / "shared"))

SCHUNK = SHARED / "data" / "schunk_lwa4p"


def runs(
    robot: rt.Robot, count: int = 3, samples: int = 60, noise_of: float = 1e-4
) -> list[rt.Run]:
    """Return runs of two suites near a smooth motion, with torques of the robot's own dynamics."""
    n = robot.joints
    random = np.random.default_rng(1)
    found = []
    for suite in range(2):
        t = 0.004 * np.arange(samples)
        phase = random.uniform(0, 1, n)
        q = 0.3 * np.sin(2 * t[:, None] + phase)
        qd = 0.6 * np.cos(2 * t[:, None] + phase)
        qdd = -1.2 * np.sin(2 * t[:, None] + phase)
        tau = robot.rnea(q, qd, qdd) + robot.viscous_friction(qd) + robot.coulomb_friction(q, qd)
        for k in range(count):
            noise = noise_of * random.standard_normal((2, samples, n))
            name = "AB"[suite]
            run = rt.Run(t, q + noise[0], qd + 10 * noise[1], tau, suite=name, motion=f"m{suite}")
            found.append(run)
    return found


@pytest.fixture(scope="session")
def robot() -> rt.Robot:
    return rt.Robot.lwa4p()


@pytest.fixture(scope="session")
def data(robot: rt.Robot) -> rt.Recordings:
    return rt.Recordings(runs(robot))


@pytest.fixture(scope="session")
def model(robot: rt.Robot, data: rt.Recordings) -> rt.Model:
    import warnings

    with warnings.catch_warnings():
        warnings.simplefilter("ignore", rt.ReachtubeWarning)
        return rt.conform(robot, data, torque="motor")


def write_csv(folder: Path, recordings: list[rt.Run]) -> rt.Recordings:
    """Write runs as a data set of CSV files, with all digits."""
    lines = ["file,suite,motion"]
    for number, run in enumerate(recordings, 1):
        n = run.joints
        head = [f"{part}{j + 1}" for part in ("q", "qd", "tau") for j in range(n)]
        rows = [",".join(["t", *head])]
        for k in range(len(run)):
            numbers = [run.t[k], *run.q[k], *run.qd[k], *run.tau[k]]
            rows.append(",".join(repr(float(number)) for number in numbers))
        (folder / f"{number}.csv").write_text("\n".join(rows) + "\n")
        lines.append(f"{number}.csv,{run.suite},{run.motion}")
    (folder / "runs.csv").write_text("\n".join(lines) + "\n")
    return rt.Recordings.open(folder)


#: The recordings of a fleet.
SUITES, RUNS, SAMPLES = 2, 20, 30


def recordings(folder: Path) -> list[rt.fleet.Recording]:
    """Write runs that share their input, as CSV and Parquet files in turn."""
    from pyarrow import Table, parquet

    robot, random = rt.Robot.lwa4p(), np.random.default_rng(4)
    t = 0.004 * np.arange(SAMPLES)
    rows = []
    for suite in range(SUITES):
        q = 0.2 * np.sin(3 * t[:, None] + random.uniform(0, 1, 6))
        qd = np.gradient(q, t, axis=0)
        tau = robot.viscous_friction(qd) + robot.crba(np.zeros(6)).diagonal() * 0.3
        for number in range(RUNS):
            noise = 1e-3 * random.standard_normal((2, SAMPLES, 6))
            run = rt.Run(t, q + noise[0], qd + noise[1], tau)
            name = f"{suite}_{number}.{'parquet' if number % 5 == 0 else 'csv'}"
            if name.endswith(".parquet"):
                parquet.write_table(Table.from_pandas(run.to_pandas()), folder / name)
            else:
                lines = run.to_pandas().to_csv(index=False)
                (folder / name).write_text(lines)
            rows.append(rt.fleet.Recording(name, f"S{suite}", f"m{suite}"))
    return rows


@pytest.fixture(scope="session")
def manifest(tmp_path_factory: pytest.TempPathFactory) -> Path:
    folder = tmp_path_factory.mktemp("fleet")
    rt.fleet.write_manifest(folder / "manifest.parquet", recordings(folder))
    return folder / "manifest.parquet"


@pytest.fixture(scope="session")
def workers() -> Iterator[Any]:
    """One cluster for all tests: two workers, each a process of its own."""
    distributed = pytest.importorskip("distributed")
    with (
        distributed.LocalCluster(
            n_workers=2, threads_per_worker=1, dashboard_address=None, processes=True
        ) as cluster,
        distributed.Client(cluster) as found,
    ):
        yield found


@pytest.fixture
def client(workers: Any) -> Any:
    """The cluster, after it has replaced the workers that another test killed."""
    workers.wait_for_workers(2)
    return workers


def tasks_end_but(other: Any, client: Any) -> bool:
    """Return whether a client's scheduler soon has no task but the one of `other`."""
    for _ in range(2000):
        tasks = client.run_on_scheduler(lambda dask_scheduler: list(dask_scheduler.tasks))
        if tasks == [other.key]:
            return True
        time.sleep(0.05)
    return False
