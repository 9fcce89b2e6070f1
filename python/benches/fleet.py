"""Times folds of many recordings in one process and on 1, 2 and 4 Dask workers, one of them killed.

    reachtube campaign --runs 132 --rest 2 --out CAMPAIGN
    python python/benches/fleet.py CAMPAIGN [SIZE]

CAMPAIGN holds the paper's whole experiment on a virtual arm, with more runs in each suite: 20,064
runs of up to 5 s in 152 suites. Half of the runs and all of them are folded, SIZE (500) in a task;
every way must give the same bits. Prints the time and the peak memory of each process: one that
asks is a new one each time.
"""

from __future__ import annotations

import concurrent.futures
import csv
import multiprocessing
import os
import random
import signal
import sys
import threading
import time
import warnings
from collections.abc import Callable
from pathlib import Path
from typing import Any

import reachtube as rt
from reachtube import fleet

def manifests(campaign: Path) -> list[Path]:
    """Write manifests of half of the runs and of all."""
    with open(campaign / "runs.csv", newline="") as file:
        rows = [row for row in csv.DictReader(file) if row["kind"] == "test_suite"]
    listed = [
        (
            int(row["repeat"]),
            fleet.Recording(
                row["file"],
                row["suite"],
                row["motion"],
                int(row["repeat"]),
                row["sha256"],
                temperature=float(row["temperature"]),
            ),
        )
        for row in rows
    ]
    # The manifest lists runs of all suites, as they arrive from many robots.
    random.Random(7).shuffle(listed)
    last = max(repeat for repeat, _ in listed)
    written = []
    for most in (last // 2, last):
        kept = [row for repeat, row in listed if repeat <= most]
        written.append(campaign / f"manifest_{len(kept)}.parquet")
        fleet.write_manifest(written[-1], kept)
    return written


def peak() -> float:
    """Return the largest memory of this process so far, MB, on Linux."""
    lines = Path("/proc/self/status").read_text().splitlines()
    [line] = [line for line in lines if line.startswith("VmHWM")]
    return int(line.split()[1]) / 1024


def on_workers(manifest: Path, workers: int, kill: bool, size: int) -> dict[str, Any]:
    """Return the model, the time, and the peak memory of this process and of each worker."""
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
        model = conform(manifest, size, client=client)
        seconds = time.perf_counter() - start
        peaks = sorted(client.run(peak).values())
    return {"model": model, "seconds": seconds, "own": peak(), "workers": peaks}


def alone(manifest: Path, size: int) -> dict[str, Any]:
    """Return the same of this process without workers."""
    start = time.perf_counter()
    model = conform(manifest, size)
    seconds = time.perf_counter() - start
    return {"model": model, "seconds": seconds, "own": peak(), "workers": []}


def conform(manifest: Path, size: int, **options: Any) -> rt.Model:
    with warnings.catch_warnings():
        warnings.simplefilter("ignore")
        return fleet.conform(
            rt.Robot.lwa4p(), manifest, torque="compensated", runs_per_task=size, **options
        )


def in_a_new_process(job: Callable[..., dict[str, Any]], *arguments: Any) -> dict[str, Any]:
    """Run a job in a process of its own, so that its peak memory is the job's."""
    context = multiprocessing.get_context("spawn")
    with concurrent.futures.ProcessPoolExecutor(1, mp_context=context) as pool:
        return pool.submit(job, *arguments).result()


def main() -> None:
    campaign, size = Path(sys.argv[1]), int((sys.argv[2:] or ["500"])[0])
    for manifest in manifests(campaign):
        first = in_a_new_process(alone, manifest, size)
        print(f"{manifest.stem}: one process {first['seconds']:.1f} s, peak {first['own']:.0f} MB, "
              f"cost {first['model'].cost:.3f}", flush=True)
        for workers, kill in [(1, False), (2, False), (4, False), (2, True)]:
            found = in_a_new_process(on_workers, manifest, workers, kill, size)
            same = "same bits" if found["model"] == first["model"] else "OTHER BITS"
            words = ", ".join(f"{one:.0f}" for one in found["workers"])
            killed = ", one killed" if kill else ""
            print(f"{manifest.stem}: {workers} workers{killed} {found['seconds']:.1f} s, peak of "
                  f"each {words} MB, of the process that asks {found['own']:.0f} MB, {same}",
                  flush=True)


if __name__ == "__main__":
    main()
