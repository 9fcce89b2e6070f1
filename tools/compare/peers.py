"""What peers take for the same work; `None` if a peer cannot be installed here."""

import math
import os
import shutil
import subprocess
import sys
import time
from pathlib import Path

from limits import run_for_this_machine

HERE = Path(__file__).resolve().parent

POLARS_ONE = "import sys, polars; print(polars.read_csv(sys.argv[1]).height)"
POLARS_MANY = """import sys, pathlib, polars
files = sorted(pathlib.Path(sys.argv[1]).glob("*/*.csv"))
print(sum(polars.read_csv(file).height for file in files))"""

POLARS_PARSING = """import io, sys, pathlib, polars
sys.path.insert(0, sys.argv[1])
from peers import least_time
content = pathlib.Path(sys.argv[2]).read_bytes()
print(least_time(lambda: polars.read_csv(io.BytesIO(content)), count=20))"""


def polars(script, path):
    """Returns the command with which polars reads a file or all files of a folder."""
    return [sys.executable, "-c", script, path]


def least_time(work, count=200, rounds=7):
    """Returns the least time of one call among several rounds, s."""
    times = []
    for _ in range(rounds):
        began = time.perf_counter()
        for _ in range(count):
            work()
        times.append((time.perf_counter() - began) / count)
    return min(times)


def dace_product(variables, order):
    """Returns the time of one dense product in DACE, s."""
    try:
        from daceypy import DA
    except ImportError:
        return None
    DA.init(order, variables)
    x = [DA(i + 1) for i in range(variables)]
    total = sum((0.1 + 0.01 * i) * x for i, x in enumerate(x))
    a, b = 1 / (2 + total), 1 / (2.5 + total)
    return least_time(lambda: a * b)


def pinocchio(folder):
    """Returns the times of rnea, forward dynamics and crba of Pinocchio for six joints, s, by name.
    Its headers come with the package; they need g++ and Boost."""
    try:
        import cmeel
    except ImportError:
        cmeel = None
    prefix = Path(sys.prefix) / f"lib/python3.{sys.version_info.minor}/site-packages/cmeel.prefix"
    boost = (prefix / "include/boost").is_dir() or Path("/usr/include/boost").is_dir()
    if cmeel is None or shutil.which("g++") is None or not boost:
        return None
    program = folder / "pinocchio"
    if not program.exists():
        options = ["-O3", "-march=native", "-DNDEBUG", "-std=c++17"]
        for define in ("LIMIT_LIST_SIZE=30", "LIMIT_VECTOR_SIZE=30", "CFG_NO_PREPROCESSED_HEADERS"):
            options.append(f"-DBOOST_MPL_{define}")
        options.append("-DBOOST_FUSION_INVOKE_MAX_ARITY=12")
        include = ["-I", prefix / "include", "-I", prefix / "include/eigen3"]
        libraries = ["-L", prefix / "lib", f"-Wl,-rpath,{prefix / 'lib'}", "-lpinocchio_default"]
        command = ["g++", *options, *include, HERE / "pinocchio.cpp", "-o", program, *libraries]
        done = subprocess.run(command, capture_output=True, text=True)
        if done.returncode != 0:
            print(f"Pinocchio is left out: {done.stderr.splitlines()[:1]}", file=sys.stderr)
            return None
    numbers = subprocess.run([program], capture_output=True, text=True, check=True).stdout.split()
    times = [float(number) * 1e-9 for number in numbers]
    return dict(zip(("rnea", "forward_dynamics", "crba"), times))


def inari(folder):
    """Returns the time of one multiply-add of intervals in inari, s."""
    printed = run_for_this_machine("inari", folder)
    return printed and float(printed) * 1e-9


def recording(samples):
    """Returns a recording of six joints as the benchmark of reading makes it."""
    names = [f"{of}{joint}" for of in ("q", "qd", "tau") for joint in range(1, 7)]
    lines = [",".join(["t", *names])]
    for k in range(samples):
        values = [math.sin(0.01 * k + column) for column in range(18)]
        lines.append(",".join([f"{0.004 * k:.3f}", *(f"{value:.6f}" for value in values)]))
    return "\n".join(lines) + "\n"


def polars_parsing(content, folder):
    """Returns the least time in which one thread of polars parses a recording in memory, s."""
    path = folder / "recording.csv"
    path.write_text(content)
    environment = {**os.environ, "POLARS_MAX_THREADS": "1"}
    done = subprocess.run(
        [sys.executable, "-c", POLARS_PARSING, HERE, path],
        env=environment, capture_output=True, text=True,
    )
    return float(done.stdout) if done.returncode == 0 else None
