"""Logs and files that other libraries wrote, against the route by CSV files, to the last bit."""

from __future__ import annotations

import dataclasses
import importlib.util
import subprocess
import sys
from pathlib import Path

import numpy as np
import pytest

import reachtube as rt

from conftest import write_csv

TOOLS = Path(__file__).parents[2] / "tools" / "logs" / "write_logs.py"
NAMES = [f"joint{j + 1}" for j in range(6)]
SHUFFLED = [3, 0, 5, 1, 4, 2]


@pytest.fixture(scope="module")
def folder(data: rt.Recordings, tmp_path_factory: pytest.TempPathFactory) -> Path:
    path = tmp_path_factory.mktemp("recordings")
    write_csv(path, list(data))
    return path


@pytest.fixture(scope="module")
def first(folder: Path) -> rt.Run:
    return rt.Recordings.open(folder)[0]


def is_same(one: rt.Run, other: rt.Run) -> bool:
    """Return whether the numbers of two runs are the same to the last bit."""
    pairs = zip(one._native.arrays(), other._native.arrays(), strict=True)
    return all(np.array_equal(a, b) for a, b in pairs if a is not None or b is not None)


@pytest.mark.skipif(
    not all(importlib.util.find_spec(name) for name in ("rosbags", "mcap_ros2")),
    reason="needs rosbags and mcap-ros2-support",
)
@pytest.mark.parametrize("log", ["run.mcap", "bag"])
def test_logs_of_other_writers_are_the_csv_files(
    folder: Path, robot: rt.Robot, log: str, tmp_path: Path
) -> None:
    subprocess.run([sys.executable, str(TOOLS), str(folder), str(tmp_path), "A", "B"], check=True)
    found = rt.io.bag(
        tmp_path / log, topic="/joint_states", joints=robot.joint_names, marker="/run"
    )
    expected = rt.Recordings.open(folder)
    assert len(found) == len(expected) == 6 and found.suites == ["A", "B"]
    for one, other in zip(found, expected, strict=True):
        assert is_same(one, other) and one.suite == other.suite
    with pytest.raises(rt.ReachtubeError, match="elbow"):
        rt.io.bag(tmp_path / log, topic="/joint_states", joints=["elbow"])


def test_a_log_that_is_missing_or_none_is_an_error(tmp_path: Path) -> None:
    with pytest.raises(rt.ReachtubeError, match="none.mcap"):
        rt.io.bag(tmp_path / "none.mcap", topic="/joint_states", joints=NAMES)
    (tmp_path / "text.mcap").write_text("this is no log at all")
    with pytest.raises(rt.ReachtubeError, match="text.mcap"):
        rt.io.bag(tmp_path / "text.mcap", topic="/joint_states", joints=NAMES)


def test_parquet_by_columns_and_by_names(first: rt.Run, tmp_path: Path) -> None:
    pyarrow = pytest.importorskip("pyarrow")
    from pyarrow import parquet

    parquet.write_table(pyarrow.Table.from_pandas(first.to_pandas()), tmp_path / "run.parquet")
    assert is_same(rt.io.parquet(tmp_path / "run.parquet", suite="A"), first)
    columns = {"t": first.t}
    for part, values in {
        "effort": first.tau, "position": first.q, "velocity": first.qd
    }.items():
        columns.update({f"{part}.{NAMES[j]}": values[:, j] for j in SHUFFLED})
    parquet.write_table(pyarrow.table(columns), tmp_path / "named.parquet")
    assert is_same(rt.io.parquet(tmp_path / "named.parquet", joints=NAMES), first)
    with pytest.raises(rt.ReachtubeError, match="effort.wrist"):
        rt.io.parquet(tmp_path / "named.parquet", joints=["joint1", "wrist"])
    with pytest.raises(rt.ReachtubeError, match="joints="):
        rt.io.parquet(tmp_path / "named.parquet")


def arrays(run: rt.Run, order: list[int]) -> dict[str, np.ndarray]:
    return {"t": run.t, "q": run.q[:, order], "qd": run.qd[:, order], "tau": run.tau[:, order]}


def test_npz_with_joints_in_another_order(first: rt.Run, tmp_path: Path) -> None:
    np.savez(tmp_path / "run.npz", **arrays(first, list(range(6))))
    assert is_same(rt.io.npz(tmp_path / "run.npz"), first)
    names = np.array([NAMES[j] for j in SHUFFLED])
    np.savez(tmp_path / "named.npz", joints=names, **arrays(first, SHUFFLED))
    assert is_same(rt.io.npz(tmp_path / "named.npz", joints=NAMES), first)
    with pytest.raises(rt.ReachtubeError, match="does not name its joints"):
        rt.io.npz(tmp_path / "run.npz", joints=NAMES)
    np.savez(tmp_path / "short.npz", t=first.t, q=first.q)
    with pytest.raises(rt.ReachtubeError, match="missing: qd, tau"):
        rt.io.npz(tmp_path / "short.npz")
    broken = arrays(first, list(range(6)))
    broken["tau"] = broken["tau"].copy()
    broken["tau"][7, 2] = np.nan
    np.savez(tmp_path / "broken.npz", **broken)
    with pytest.raises(rt.DefectsError, match="joint 3: tau .* sample 7") as error:
        rt.io.npz(tmp_path / "broken.npz")
    assert error.value.defects[0].joint == 3


def test_hdf5_with_names_as_an_attribute(first: rt.Run, tmp_path: Path) -> None:
    h5py = pytest.importorskip("h5py")
    with h5py.File(tmp_path / "runs.h5", "w") as file:
        group = file.create_group("one")
        for name, values in arrays(first, SHUFFLED).items():
            group[name] = values
        group.attrs["joints"] = [NAMES[j] for j in SHUFFLED]
    found = rt.io.hdf5(tmp_path / "runs.h5", group="one", joints=NAMES)
    assert is_same(found, first)
    with pytest.raises(rt.ReachtubeError, match="no group two"):
        rt.io.hdf5(tmp_path / "runs.h5", group="two")


def test_a_bag_of_ros_1(first: rt.Run, tmp_path: Path) -> None:
    pytest.importorskip("rosbags")
    from rosbags.rosbag1 import Writer
    from rosbags.typesys import Stores, get_typestore

    store = get_typestore(Stores.ROS1_NOETIC)
    types = store.types
    header, time = types["std_msgs/msg/Header"], types["builtin_interfaces/msg/Time"]
    state = types["sensor_msgs/msg/JointState"]
    with Writer(tmp_path / "run.bag") as writer:
        connection = writer.add_connection("/joint_states", state.__msgtype__, typestore=store)
        for k in range(len(first)):
            stamp = round(first.t[k] * 1e9) + 1_700_000_000 * 10**9
            order = np.random.default_rng(k).permutation(6)
            message = state(
                header(seq=k, stamp=time(stamp // 10**9, stamp % 10**9), frame_id=""),
                [NAMES[j] for j in order],
                first.q[k, order],
                first.qd[k, order],
                first.tau[k, order],
            )
            data = store.serialize_ros1(message, state.__msgtype__)
            writer.write(connection, stamp, data)
    found = rt.io.ros1(tmp_path / "run.bag", topic="/joint_states", joints=NAMES, suite="A")
    assert is_same(found, first)
    with pytest.raises(rt.ReachtubeError, match="no topic /other; there are /joint_states"):
        rt.io.ros1(tmp_path / "run.bag", topic="/other", joints=NAMES)
    with pytest.raises(rt.ReachtubeError, match="missing: wrist"):
        rt.io.ros1(tmp_path / "run.bag", topic="/joint_states", joints=["wrist"])


def test_figures_are_drawn(model: rt.Model, data: rt.Recordings, tmp_path: Path) -> None:
    matplotlib = pytest.importorskip("matplotlib")
    matplotlib.use("agg")
    from reachtube import plot

    found = rt.reach(model, data)[0]
    figure = plot.reachable_set(found, data, deviation=True)
    figure.savefig(tmp_path / "sets.png")
    assert len(figure.axes) == 12 and len(figure.axes[0].lines) == 1
    assert [axis.get_ylabel() for axis in figure.axes if axis.get_ylabel()] == [
        "q [rad]", "qd [rad/s]"
    ]
    # The second joint slides.
    units = ("rad", "m", *found.units[2:7], "m/s", *found.units[8:])
    figure = plot.reachable_set(dataclasses.replace(found, units=units))
    labels = [axis.get_ylabel() for axis in figure.axes]
    assert labels[:4] == ["q [rad]", "q [m]", "q [rad]", ""] and labels[7] == "qd [m/s]"
    axis = plot.flowpipe(found.lower, found.upper, 0, 6)
    axis.figure.savefig(tmp_path / "plane.png")
    assert (tmp_path / "plane.png").stat().st_size > 1000
