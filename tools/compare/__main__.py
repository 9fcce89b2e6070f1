"""Compares the command with peers and with an older build.

tools/compare/run                                  # the table, on standard output
tools/compare/run --before OLD/target/release/reachtube
tools/compare/run --growth docs/images/growth.svg  # the figure too
tools/compare/run --kernels                        # benchmarks of single functions too
"""

import argparse
import hashlib
import os
import re
import subprocess
import sys
import time
from pathlib import Path

import numpy
from growth import draw, grown
from measure import in_turn
import peers
import recordings

ROOT = Path(__file__).resolve().parents[2]


def main():
    parser = argparse.ArgumentParser(
        description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter
    )
    parser.add_argument("--before", type=Path, help="an older build of the command")
    parser.add_argument("--growth", type=Path, help="measure the growth and draw this figure")
    parser.add_argument("--kernels", action="store_true", help="measure single functions too")
    parser.add_argument("--rounds", type=int, default=3, help="how often each command runs")
    parser.add_argument("--only", default="", help="only the rows whose work contains this text")
    options = parser.parse_args()
    reachtube = Path(os.environ.get("REACHTUBE", ROOT / "target/release/reachtube")).resolve()
    if not reachtube.exists():
        build = ["cargo", "build", "--release", "--locked", "-p", "reachtube-cli"]
        subprocess.run(build, cwd=ROOT, check=True)
    folder = ROOT / "target/compare/work"
    folder.mkdir(parents=True, exist_ok=True)
    before = options.before and options.before.resolve()
    print(f"{processor()}, {os.cpu_count()} cores, {time.strftime('%Y-%m-%d')}\n")
    print("| work | before | after | peer | limit |\n|---|---|---|---|---|", flush=True)
    for work, commands, peer, limit in commands_of(reachtube, before, folder):
        if options.only in work:
            ours, old, other = in_turn([commands[0], commands[1], peer and peer[1]], options.rounds)
            peer_words = f"{peer[0]}: {words(other)}" if peer else "-"
            print(f"| {work} | {words(old)} | {words(ours)} | {peer_words} | {limit} |", flush=True)
    if options.kernels:
        print_kernels(folder)
    if options.growth:
        draw(grown(reachtube, before, folder, ROOT), options.growth)


def commands_of(reachtube, before, folder):
    """Yields each row of whole commands: work, commands now and before, peer, limit."""
    data = recordings.base(reachtube, ROOT, folder)
    few = recordings.copies(data, folder / "few", recordings.COPIES, False)
    many = recordings.copies(data, folder / "many", recordings.COPIES, True)
    whole = recordings.joined(many, folder / "whole.csv")
    limit = reading_limit(whole)

    def pair(*arguments):
        command = ["--quiet", "conform", "--robot", "lwa4p", "--torque", "compensated", *arguments]
        command += ["--out", folder / "model.json"]
        # The oldest builds know no --quiet, and name models otherwise.
        old = ["--model" if part == "--paper-model" else part for part in command[1:]]
        return [reachtube, *command], before and [before, *old]

    one = ("polars, one file", peers.polars(peers.POLARS_ONE, whole))
    files = ("polars, all files", peers.polars(peers.POLARS_MANY, many))
    yield "linear, 2,190 runs in 4 suites", pair("--data", few), one, limit
    yield "linear, the same in 120 suites", pair("--data", many), files, limit
    model = ("--data", data, "--order")
    yield "model 1, p = 3, 73 runs", pair(*model, "3"), None, "-"
    yield "model 2, p = 5, 73 runs", pair(*model, "5", "--paper-model", "2"), None, "-"
    settings = ROOT / "docs/identify/ur10e.toml"
    if (ROOT.parent / "shared/data/ur10e").is_dir():
        identify = ["identify", "--settings", settings, "--out", folder / "arm.toml"]
        old = before and [before, *identify]
        yield "identify, UR10e", ([reachtube, "--quiet", *identify], old), None, "-"


def reading_limit(whole):
    """Words the time to read the bytes once from memory and to digest them on one core."""
    content = numpy.fromfile(whole, numpy.uint8)
    reading = peers.least_time(lambda: content.view(numpy.uint64)[:-1].max(), count=3)
    digest = peers.least_time(lambda: hashlib.sha256(content), count=1, rounds=3)
    return f"reading {reading:.2f} s, SHA-256 {digest:.2f} s"


def words(cost):
    """Words what a command took."""
    return "-" if cost is None else f"{cost.cpu:.2f} s, {cost.memory:.0f} MB"


def processor():
    with open("/proc/cpuinfo") as file:
        names = [line.split(":")[1].strip() for line in file if line.startswith("model name")]
    return names[0] if names else "unknown processor"


def print_kernels(folder):
    """Prints the rows of single functions."""
    rnea, aba, crba = peers.pinocchio(folder) or [None] * 3
    own = benches("reachtube-robot", "dynamics")
    for name, peer, bench in [
        ("rnea, six joints", rnea, "rnea"),
        ("forward dynamics, six joints", aba, "forward_dynamics"),
        ("crba, six joints", crba, "crba"),
    ]:
        lanes = own.get((bench, "Lanes<8>", "lwa4p"))
        eighth = lanes and lanes / 8
        print_kernel(name, own.get((bench, "f64", "lwa4p")), f"Pinocchio: {nanoseconds(peer)}")
        print_kernel(f"{name}, each of 8 states", eighth, "-")
    products = benches("reachtube-scalar", "taylor")
    dace = f"DACE: {nanoseconds(peers.dace_product(12, 4))}"
    print_kernel("dense Taylor product (12, 4)", products.get(("product", "(12, 4)")), dace)
    interval = products.get(("product_of_intervals", "(12, 4)"))
    inari = f"inari: {nanoseconds(peers.inari(folder))}"
    print_kernel("multiply-add of intervals", interval and interval / 20475, inari)


def print_kernel(work, own, peer):
    print(f"| {work} | - | {nanoseconds(own)} | {peer} | - |", flush=True)


def nanoseconds(seconds):
    return "-" if seconds is None else f"{seconds * 1e9:.3g} ns"


def benches(package, bench):
    """Runs the benchmarks of a package, and returns the median of each by its names, s."""
    command = ["cargo", "bench", "--quiet", "-p", package, "--bench", bench]
    done = subprocess.run(command, cwd=ROOT, capture_output=True, text=True)
    if done.returncode != 0:
        print(done.stderr, file=sys.stderr)
    units = {"ns": 1e-9, "µs": 1e-6, "ms": 1e-3, "s": 1.0}
    found, path = {}, []
    for line in done.stdout.splitlines():
        match = re.match(r"^((?:[│ ]  )*)[├╰]─ (.*?)(?: {2,}|$)(.*)", line)
        if not match:
            continue
        depth, name, columns = len(match[1]) // 3, match[2].strip(), match[3].split("│")
        path = [*path[:depth], name]
        if len(columns) > 2 and (median := re.match(r"\s*([\d.]+) (\S+)", columns[2])):
            found[tuple(path)] = float(median[1]) * units[median[2]]
    return found


if __name__ == "__main__":
    main()
