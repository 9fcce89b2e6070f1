"""Recordings for the comparison: copies of a data set, and arms of other numbers of joints."""

import csv
import itertools
import math
import shutil
import subprocess
from pathlib import Path


def base(reachtube, root, folder):
    """Returns a data set of four suites: the paper's recordings, or a campaign without them."""
    paper = root.parent / "shared/data/schunk_lwa4p"
    if paper.is_dir():
        return paper
    made = folder / "campaign"
    if not (made / "runs.csv").exists():
        options = ["--motions", "1", "--start-points", "4", "--runs", "18", "--longest", "4.3"]
        options += ["--rest", "2", "--one-joint", "1", "--excitation", "1", "--validation", "0"]
        subprocess.run([reachtube, "--quiet", "campaign", *options, "--out", made], check=True)
    return made


def suites_of(data, out, count):
    """Copies the suites of a data set `count` times, each a suite of its own. Returns the
    folder."""
    if not (out / "runs.csv").exists():
        copied = [
            (run["file"], f"{run['suite']}{copy:02}", copy)
            for copy in range(count) for run in recorded(data)
        ]
        copy_runs(data, out, copied)
    return out


def runs_of(data, out, count):
    """Makes a data set of `count` runs in the suites of a data set, which are taken in turn, by
    copies of it. Returns the folder."""
    if not (out / "runs.csv").exists():
        suites = {}
        for run in recorded(data):
            suites.setdefault(run["suite"], []).append(run["file"])
        turns = itertools.zip_longest(*suites.values())
        each = [run for turn in turns for run in zip(turn, suites) if run[0]]
        copied = [(*each[at % len(each)], at // len(each)) for at in range(count)]
        copy_runs(data, out, copied)
    return out


def copy_runs(data, out, copied):
    """Copies recordings, each given by its file, its new suite and the number of the copy."""
    listed = []
    for file, suite, copy in copied:
        to = f"{suite}/{Path(file).stem}_{copy:02}.csv"
        (out / suite).mkdir(parents=True, exist_ok=True)
        shutil.copyfile(data / file, out / to)
        listed.append([to, suite])
    write_index(out, listed)


def recorded(data):
    """Returns the runs of a data set that belong to a suite."""
    with open(data / "runs.csv", newline="") as file:
        return [run for run in csv.DictReader(file) if run["suite"]]


def write_index(out, listed):
    with open(out / "runs.csv", "w", newline="") as file:
        csv.writer(file).writerows([["file", "suite"], *listed])


def joined(folder, out):
    """Writes the rows of all recordings of a folder into one file, and returns it."""
    if not out.exists():
        with open(out, "wb") as whole:
            for at, path in enumerate(sorted(folder.glob("*/*.csv"))):
                with open(path, "rb") as file:
                    header = file.readline()
                    whole.write((header if at == 0 else b"") + file.read())
    return out


def arm(joints, folder):
    """Writes a chain of equal links and recordings of it: the file and the folder."""
    robot, data = folder / f"arm{joints}.toml", folder / f"arm{joints}"
    link = [
        'placement = { translation = [0.0, 0.0, -0.2] }', "axis = [1.0, 0.0, 0.0]", "mass = 0.6",
        "com = [0.0, 0.0, -0.1]", "inertia = [0.03, 0.0, 0.0, 0.03, 0.0, 0.003]",
        'about = "com"', "gear_ratio = 100.0", "rotor_inertia = 1e-4", "[joint.friction]",
        "viscous = [2.0, 0.0, 0.0]",
    ]
    parts = ["schema_version = 1", f'name = "chain of {joints}"', "gravity = [0.0, 0.0, 0.0]"]
    for joint in range(joints):
        parts += ["[[joint]]", f'name = "joint{joint + 1}"', *link]
    robot.write_text("\n".join(parts) + "\n")
    listed = []
    for suite in "ABCD":
        (data / suite).mkdir(parents=True, exist_ok=True)
        for run in range(4):
            file = f"{suite}/{run}.csv"
            (data / file).write_text(motion(joints, "ABCD".index(suite), run))
            listed.append([file, suite])
    write_index(data, listed)
    return robot, data


def motion(joints, suite, run, samples=500, step=0.004):
    """Returns a smooth motion of all joints, which starts a little elsewhere in each run."""
    names = [f"{of}{j + 1}" for of in ("q", "qd", "tau") for j in range(joints)]
    lines = [",".join(["t", *names])]
    speeds = [0.5 + 0.1 * suite + 0.07 * j for j in range(joints)]
    for k in range(samples):
        t = k * step
        q = [0.3 * math.sin(w * t) + 1e-3 * run for w in speeds]
        qd = [0.3 * w * math.cos(w * t) for w in speeds]
        qdd = [-0.3 * w * w * math.sin(w * t) for w in speeds]
        tau = [1.0 * a + 2.0 * v for a, v in zip(qdd, qd)]
        lines.append(",".join([f"{t:.3f}", *(f"{x:.6g}" for x in q + qd + tau)]))
    return "\n".join(lines) + "\n"
