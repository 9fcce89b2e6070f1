"""Writes the test suites of a data set as robot logs, by libraries that share no code with
reachtube: run.mcap by mcap-ros2-support, and bag/bag.db3 by rosbags.

    python tools/logs/write_logs.py DATA OUT SUITE..

Joints are in another order in every message, and every other message of the bag is big-endian. The
topic /run holds the suite's name during a run, and nothing between runs.
"""

import csv
import random
import sys
from decimal import Decimal
from pathlib import Path

import numpy as np
from mcap_ros2.writer import Writer as McapWriter
from rosbags.rosbag2 import StoragePlugin, Writer as BagWriter
from rosbags.typesys import Stores, get_typestore

START = 1_700_000_000 * 10**9
BETWEEN_RUNS = 100 * 10**9
MARGIN = 10**9

JOINT_STATE = """std_msgs/Header header
string[] name
float64[] position
float64[] velocity
float64[] effort
================================================================================
MSG: std_msgs/Header
builtin_interfaces/Time stamp
string frame_id
================================================================================
MSG: builtin_interfaces/Time
int32 sec
uint32 nanosec"""


def runs(data, suites):
    """Yields the suite and the samples (time in ns, q, qd, tau) of each run."""
    with open(data / "runs.csv", newline="") as index:
        listed = [row for row in csv.DictReader(index) if row["suite"] in suites]
    for number, row in enumerate(listed):
        with open(data / row["file"], newline="") as file:
            header, *lines = csv.reader(file)
        n = header.index("qd1") - 1
        samples = []
        for line in lines:
            time = int(Decimal(line[0]) * 10**9) + START + number * BETWEEN_RUNS
            values = [float(cell) for cell in line[1 : 3 * n + 1]]
            samples.append((time, values[:n], values[n : 2 * n], values[2 * n :]))
        yield row["suite"], samples


def messages(data, suites, names):
    """Yields topic, time in ns, and content of each message: a text, or names and values."""
    shuffle = random.Random(1).shuffle
    for suite, samples in runs(data, suites):
        yield "/run", samples[0][0] - MARGIN, suite
        for time, *values in samples:
            order = list(range(len(names)))
            shuffle(order)
            yield "/joint_states", time, [
                [quantity[joint] for joint in order]
                for quantity in ([*names], *values)
            ]
        yield "/run", samples[-1][0] + MARGIN, ""


def stamp(time):
    return {"sec": time // 10**9, "nanosec": time % 10**9}


def write_mcap(path, content):
    with open(path, "wb") as file:
        # The library's chunks are of 1 MiB; smaller ones are met more often.
        writer = McapWriter(file, chunk_size=100_000)
        states = writer.register_msgdef("sensor_msgs/msg/JointState", JOINT_STATE)
        texts = writer.register_msgdef("std_msgs/msg/String", "string data")
        for topic, time, what in content:
            if topic == "/run":
                schema, message = texts, {"data": what}
            else:
                header = {"stamp": stamp(time), "frame_id": "base"}
                fields = dict(zip(("name", "position", "velocity", "effort"), what))
                schema, message = states, {"header": header, **fields}
            writer.write_message(topic, schema, message, log_time=time)
        writer.finish()


def write_bag(folder, content):
    store = get_typestore(Stores.ROS2_HUMBLE)
    types = {"/joint_states": "sensor_msgs/msg/JointState", "/run": "std_msgs/msg/String"}
    with BagWriter(folder, version=9, storage_plugin=StoragePlugin.SQLITE3) as writer:
        connections = {
            topic: writer.add_connection(topic, kind, typestore=store)
            for topic, kind in types.items()
        }
        for number, (topic, time, what) in enumerate(content):
            if topic == "/run":
                message = store.types[types[topic]](what)
            else:
                time_type = store.types["builtin_interfaces/msg/Time"]
                header = store.types["std_msgs/msg/Header"](time_type(**stamp(time)), "base")
                names, *values = what
                arrays = [np.array(quantity, dtype=np.float64) for quantity in values]
                message = store.types[types[topic]](header, names, *arrays)
            data = store.serialize_cdr(message, types[topic], little_endian=number % 2 == 0)
            writer.write(connections[topic], time, data)


def main():
    data, out, *suites = sys.argv[1:]
    names = [f"joint{joint}" for joint in range(1, 7)]
    content = list(messages(Path(data), suites, names))
    Path(out).mkdir(parents=True, exist_ok=True)
    write_mcap(Path(out) / "run.mcap", content)
    write_bag(Path(out) / "bag", content)


if __name__ == "__main__":
    main()
