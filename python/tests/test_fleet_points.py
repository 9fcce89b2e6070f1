"""Fleets for the notions that need every point: the bits of one machine, whatever workers do."""

from __future__ import annotations

import os
import pickle
import signal
import sys
import threading
import time
from pathlib import Path
from typing import Any

import numpy as np
import pytest

import reachtube as rt
from reachtube import _jobs, _points, fleet
from reachtube._settings import of_conformance

from conftest import RUNS, tasks_end_but

pytest.importorskip("pyarrow")
pytest.importorskip("fsspec")
distributed = pytest.importorskip("distributed")

pytestmark = pytest.mark.filterwarnings("ignore::reachtube.ReachtubeWarning")

GATE = threading.Event()


def wait_at_the_gate() -> bool:
    return GATE.wait(60)


@pytest.fixture(scope="module")
def few(manifest: Path) -> Path:
    """A manifest of some of the recordings."""
    rows = fleet.read_manifest(manifest)
    fleet.write_manifest(manifest.parent / "few.parquet", rows[:8] + rows[RUNS : RUNS + 6])
    return manifest.parent / "few.parquet"


def of_points(notion: str) -> dict[str, Any]:
    return {"torque": "compensated", "notion": notion, "until": 0.03}


@pytest.mark.parametrize("notion", ["exact", "phase-plane"])
def test_points_that_workers_hold_give_the_same_bits(
    few: Path, client: Any, notion: str
) -> None:
    robot, arguments = rt.Robot.lwa4p(), of_points(notion)
    alone = fleet.conform(robot, few, **arguments)
    assert alone.verified and alone.proof["points"]["unproved"] == 0
    hull = fleet.conform(robot, few, **of_points("hull"))
    assert alone.cost is not None and hull.cost is not None and alone.cost > hull.cost
    assert fleet.conform(robot, few, client=client, runs_per_task=3, **arguments) == alone
    verdict = fleet.check(alone, few, runs_per_task=9)
    assert verdict and verdict == fleet.check(alone, few, client=client, runs_per_task=4)


def at_a_corner(model: rt.Model, manifest: Path) -> Path:
    """Write a manifest whose first recording ends at a corner of the hull of the reachable set.

    The corner has the highest positions and the lowest velocities.
    """
    rows = {row.file: row for row in fleet.read_manifest(manifest)}
    row, other = rows["0_1.csv"], rows["0_2.csv"]
    numbers = np.loadtxt(manifest.parent / row.file, delimiter=",", skiprows=1)
    parts = np.split(numbers[:, 1:], 3, axis=1)
    [tube] = rt.reach(model, rt.Run(numbers[:, 0], *parts, suite="S0"))
    last, n = len(tube.t) - 1, 6
    # A part of a percent inside the hull, so that only the points can be outside.
    inside = 1e-3 * (tube.upper[last] - tube.lower[last])
    numbers[last, 1 : 1 + n] = (tube.upper[last] - inside)[:n]
    numbers[last, 1 + n : 1 + 2 * n] = (tube.lower[last] + inside)[n:]
    names = ["t", *(f"{part}{j + 1}" for part in ("q", "qd", "tau") for j in range(n))]
    head = ",".join(names)
    np.savetxt(
        manifest.parent / "corner.csv",
        numbers,
        fmt="%.17g",
        delimiter=",",
        header=head,
        comments="",
    )
    altered = [row._replace(file="corner.csv"), other]
    fleet.write_manifest(manifest.parent / "corner.parquet", altered)
    return manifest.parent / "corner.parquet"


def test_a_check_asks_the_points_of_an_exact_model(few: Path, client: Any) -> None:
    model = fleet.conform(rt.Robot.lwa4p(), few, **of_points("exact"))
    corner = at_a_corner(model, few)
    inside = fleet.check(model, few)
    assert inside and inside.to_dict()["points"]["unproved"] == 0
    # The hull holds the point that the set itself does not hold.
    hull = fleet.check(model, corner, notion="hull")
    assert hull and "points" not in hull.to_dict()
    found = fleet.check(model, corner, client=client, runs_per_task=1)
    assert not found and found == fleet.check(model, corner)
    points = found.to_dict()["points"]
    assert points["unproved"] == 1
    worst = points["worst"]
    assert (worst["suite"], worst["run"]) == ("S0", "corner.csv")


def test_jobs_leave_nothing_but_the_futures_of_others(few: Path, client: Any) -> None:
    other = client.submit(len, "others", pure=False)
    model = fleet.conform(
        rt.Robot.lwa4p(), few, client=client, runs_per_task=3, **of_points("exact")
    )
    assert tasks_end_but(other, client) and other.status == "finished"
    assert fleet.check(model, few, client=client, runs_per_task=4)
    assert tasks_end_but(other, client) and other.result() == 6


def test_a_question_that_waits_ends(few: Path) -> None:
    with (
        distributed.LocalCluster(
            n_workers=1, threads_per_worker=1, dashboard_address=None, processes=False
        ) as cluster,
        distributed.Client(cluster) as client,
    ):
        other = client.submit(wait_at_the_gate, pure=False)
        robot = rt.Robot.lwa4p()
        settings = of_conformance(robot, torque="compensated", notion="exact", until=0.03)
        job = _jobs.Job("robot", robot._native.description(), settings)
        points = _points.Points(job, fleet._parts(few, 3, None, (None, None), None), client, b"")
        ended: list[type] = []

        def ask() -> None:
            try:
                points.ask(b"")
            except BaseException as error:
                ended.append(type(error))

        asking = threading.Thread(target=ask)
        asking.start()
        while points._asked is None and asking.is_alive():
            time.sleep(0.01)
        points.close()
        asking.join(30)
        assert ended and issubclass(ended[0], distributed.client.CancelledError)
        assert tasks_end_but(other, client)
        GATE.set()
        assert other.result()


def test_a_worker_that_held_points_is_killed(
    few: Path, client: Any, monkeypatch: pytest.MonkeyPatch
) -> None:
    alone = fleet.conform(rt.Robot.lwa4p(), few, **of_points("exact"))
    asked: list[int] = []
    ask = _points.Points.ask

    def kill_in_the_fourth_round(self: Any, question: bytes) -> bytes:
        asked.append(len(question))
        if len(asked) == 4:
            os.kill(next(iter(client.run(os.getpid).values())), signal.SIGKILL)
        return ask(self, question)

    monkeypatch.setattr(_points.Points, "ask", kill_in_the_fourth_round)
    found = fleet.conform(
        rt.Robot.lwa4p(), few, client=client, runs_per_task=4, **of_points("exact")
    )
    assert len(asked) > 4 and found == alone


def test_points_go_from_worker_to_worker(few: Path) -> None:
    robot = rt.Robot.lwa4p()
    settings = of_conformance(robot, torque="compensated", notion="exact", until=0.03)
    job = _jobs.Job("robot", robot._native.description(), settings)
    [part] = fleet._parts(few, 1000, None, (None, None), None)
    points = _points._points(job, _jobs.fold_of(job, part), part)
    again = pickle.loads(pickle.dumps(points))
    assert again.to_bytes() == points.to_bytes()
    # Dask plans its memory by this: 14 recordings of 7 points.
    assert sys.getsizeof(again) == sys.getsizeof(points) > 14 * 7 * 6 * 24
