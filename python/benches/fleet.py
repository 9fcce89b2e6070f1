"""Times folds of many recordings in one process and on 1, 2 and 4 Dask workers, one of them killed.

    python python/benches/fleet.py FOLDER [RUNS]

FOLDER holds the recordings, which are made where they are missing: suites of a virtual LWA 4P,
whose runs repeat with scatter. Every way must give the same bits. Prints the time and the peak
memory of each process.
"""

from __future__ import annotations

import os
import signal
import sys
import threading
import time
import warnings
from pathlib import Path
from typing import Any

import numpy as np

import reachtube as rt
from reachtube import fleet

SUITES, SAMPLES = 40, 126
HEADER = ",".join(["t", *(f"{part}{j}" for part in ("q", "qd", "tau") for j in range(1, 7))])


def record(folder: Path, count: int) -> Path:
    """Write runs of half a second at 250 Hz, and their manifest."""
    folder = folder / str(count)
    manifest = folder / "manifest.parquet"
    if manifest.exists():
        return manifest
    folder.mkdir(parents=True, exist_ok=True)
    robot, rows = rt.Robot.lwa4p(), []
    t = 0.004 * np.arange(SAMPLES)
    for suite in range(SUITES):
        (folder / f"S{suite}").mkdir(exist_ok=True)
        random = np.random.default_rng(suite)
        amplitude, phase = random.uniform(0.1, 0.6, 6), random.uniform(0, 6, 6)
        q = amplitude * np.sin(4 * t[:, None] + phase)
        qd = 4 * amplitude * np.cos(4 * t[:, None] + phase)
        mass = robot.crba(np.zeros(6)).diagonal()
        tau = robot.viscous_friction(qd) - 16 * mass * q
        for number in range(count // SUITES):
            drift = random.normal(0, 2e-3, 12) * np.linspace(0.2, 1, SAMPLES)[:, None]
            states = np.hstack([q, qd]) + drift + random.normal(0, 1e-4, (SAMPLES, 12))
            name = f"S{suite}/{number}.csv"
            table = np.hstack([t[:, None], states, tau])
            with open(folder / name, "w") as file:
                np.savetxt(file, table, fmt="%.9g", delimiter=",", header=HEADER, comments="")
            rows.append(fleet.Recording(name, f"S{suite}", f"M{suite // 4}"))
    # Tasks take runs of all suites, as they arrive from many robots.
    order = np.random.default_rng(7).permutation(len(rows))
    fleet.write_manifest(manifest, [rows[place] for place in order])
    return manifest


def peak() -> float:
    """Return the largest memory of this process so far, MB, on Linux."""
    lines = Path("/proc/self/status").read_text().splitlines()
    [line] = [line for line in lines if line.startswith("VmHWM")]
    return int(line.split()[1]) / 1024


def on_workers(manifest: Path, workers: int, kill: bool) -> tuple[rt.Model, float, list[float]]:
    """Return the model, the time, and the peak memory of each worker."""
    from distributed import Client, LocalCluster

    with (
        LocalCluster(
            n_workers=workers, threads_per_worker=1, dashboard_address=None, memory_limit=0
        ) as cluster,
        Client(cluster) as client,
    ):
        client.run(lambda: __import__("reachtube"))
        if kill:
            [victim, *_] = client.run(os.getpid).values()
            threading.Timer(5.0, os.kill, (victim, signal.SIGKILL)).start()
        start = time.perf_counter()
        model = conform(manifest, client=client)
        return model, time.perf_counter() - start, sorted(client.run(peak).values())


def conform(manifest: Path, **options: Any) -> rt.Model:
    with warnings.catch_warnings():
        warnings.simplefilter("ignore")
        return fleet.conform(
            rt.Robot.lwa4p(), manifest, torque="compensated", runs_per_task=500, **options
        )


def main() -> None:
    folder, count = Path(sys.argv[1]), int((sys.argv[2:] or ["20000"])[0])
    small, large = record(folder, count // 2), record(folder, count)
    for manifest in (small, large):
        start = time.perf_counter()
        alone = conform(manifest)
        print(f"{manifest.parent.name} runs: one process {time.perf_counter() - start:.1f} s, "
              f"peak {peak():.0f} MB, cost {alone.cost:.3f}", flush=True)
        for workers, kill in [(1, False), (2, False), (4, False), (2, True)]:
            model, seconds, memory = on_workers(manifest, workers, kill)
            same = "same bits" if model == alone else "OTHER BITS"
            words = ", ".join(f"{size:.0f}" for size in memory)
            killed = ", one killed" if kill else ""
            print(f"{manifest.parent.name} runs: {workers} workers{killed} {seconds:.1f} s, "
                  f"peak of each {words} MB, {same}", flush=True)


if __name__ == "__main__":
    main()
