"""Fleets: finished tasks, from which a job that was stopped goes on."""

from __future__ import annotations

import hashlib
from pathlib import Path
from typing import Any

import pytest

import reachtube as rt
from reachtube import fleet

pytest.importorskip("pyarrow")
pytest.importorskip("fsspec")

pytestmark = pytest.mark.filterwarnings("ignore::reachtube.ReachtubeWarning")


def with_digests(manifest: Path) -> Path:
    """Write the manifest once more, with the SHA-256 of each recording."""
    path = manifest.parent / "digests.parquet"
    rows = fleet.read_manifest(manifest)
    digest = lambda row: hashlib.sha256((manifest.parent / row.file).read_bytes()).hexdigest()
    fleet.write_manifest(path, [row._replace(sha256=digest(row)) for row in rows])
    return path


def test_a_stopped_job_goes_on(manifest: Path, tmp_path: Path) -> None:
    alone = fleet.conform(rt.Robot.lwa4p(), manifest, torque="compensated")
    arguments: dict[str, Any] = {
        "torque": "compensated", "runs_per_task": 10, "resume": tmp_path / "tasks"
    }
    # Without digests, recordings may be others by the time the job goes on.
    assert fleet.conform(rt.Robot.lwa4p(), manifest, **arguments) == alone
    assert not (tmp_path / "tasks").exists()
    manifest = with_digests(manifest)

    def stop(done: int, total: int, words: list[str]) -> None:
        if done == 2:
            raise KeyboardInterrupt

    with pytest.raises(KeyboardInterrupt):
        fleet.conform(rt.Robot.lwa4p(), manifest, progress=stop, **arguments)
    finished = sorted((tmp_path / "tasks").iterdir())
    assert len(finished) == 2
    times = [path.stat().st_mtime_ns for path in finished]
    # One of them is damaged; it is folded again.
    finished[0].write_bytes(finished[0].read_bytes()[:-1])
    assert fleet.conform(rt.Robot.lwa4p(), manifest, **arguments) == alone
    assert len(list((tmp_path / "tasks").iterdir())) == 4
    assert finished[1].stat().st_mtime_ns == times[1]
