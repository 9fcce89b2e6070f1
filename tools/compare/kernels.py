"""The rows of single functions, by the benchmarks of the repository."""

import os
import re
import subprocess
import sys

import peers

# Products of coefficients in a dense product of 12 variables and order 4.
PRODUCTS = 20475
# Samples of a recording in the benchmark of reading.
SAMPLES = 1000
# Operations of the gains of 1250 steps: e^{A t} of 12 states by 12, and 6 inputs.
OPERATIONS_OF_GAINS = 1250 * 2 * (12 * 12 * 12 + 12 * 12 * 6)


class Time(float):
    """A time in seconds that prints in the unit that suits it."""

    def __str__(self):
        for unit, size in (("s", 1.0), ("ms", 1e-3), ("µs", 1e-6)):
            if self >= size:
                return f"{self / size:.3g} {unit}"
        return f"{self / 1e-9:.3g} ns"


def rows_of_kernels(builds, folder, limit, only):
    """Yields each row: work, what each build takes, what a peer takes, the limit."""
    times = [times_of(build) for build in builds]
    for work, names, parts, peer, bound in works(folder, limit):
        if only in work:
            costs = [of and of.get(names) and Time(of[names] / parts) for of in times]
            yield work, costs, peer, "-" if not bound else str(Time(bound))


def works(folder, limit):
    """Yields each work: what it is called, the names of its benchmark, by what its time is divided,
    the words of its peer, and its least time, s."""
    pinocchio = peers.pinocchio(folder) or {}
    for name, words in [
        ("rnea", "inverse dynamics (rnea)"),
        ("forward_dynamics", "forward dynamics"),
        ("crba", "mass matrix (crba)"),
    ]:
        peer, bound = of_peer("Pinocchio", pinocchio.get(name)), limit.of_operations(name)
        yield f"{words}, six joints", (name, "f64", "lwa4p"), 1, peer, bound
        yield f"{words}, each of 8 states", (name, "Lanes<8>", "lwa4p"), 8, peer, bound
    product, bound = of_peer("DACE", peers.dace_product(12, 4)), limit.of_operations(2 * PRODUCTS)
    yield "dense Taylor product (12, 4)", ("product", "f64", "(12, 4)"), 1, product, bound
    yield "the same, each of 8", ("product", "Lanes<8>", "(12, 4)"), 8, product, bound
    # Four products and two sums.
    bound = limit.of_operations(6)
    peer = of_peer("inari", peers.inari(folder))
    yield "multiply-add of intervals", ("product_of_intervals", "(12, 4)"), PRODUCTS, peer, bound
    names, bound = ("input_gains", "Measurable"), limit.of_operations(OPERATIONS_OF_GAINS)
    yield "gains of measurable disturbances", names, 1, "-", bound
    content = peers.recording(SAMPLES)
    peer = of_peer("polars, one thread", peers.polars_parsing(content, folder))
    bound = limit.of_bytes(len(content))
    work = f"CSV of {len(content) // 1000} kB, with its SHA-256"
    yield work, ("read_csv_and_digest_of_six_joints",), 1, peer, bound
    yield "SHA-256 of it alone", ("digest_of_six_joints",), 1, "-", bound


def of_peer(name, seconds):
    """Words what a peer takes."""
    return f"{name}: not to be had" if seconds is None else f"{name}: {Time(seconds)}"


def times_of(build):
    """Runs the benchmarks of a build's checkout, and returns the least time of each, s, by its
    names."""
    times = {}
    for package, bench, filters in [
        ("scalar", "taylor", ["product"]),
        ("robot", "dynamics", ["rnea", "forward_dynamics", "crba"]),
        ("reach", "reach", ["input_gains"]),
        ("recordings", "reading", []),
    ]:
        if (build.checkout / f"crates/{package}/benches/{bench}.rs").exists():
            times |= bench_of(build.checkout, f"reachtube-{package}", bench, filters)
    return times


def bench_of(checkout, package, bench, filters):
    command = ["cargo", "bench", "--quiet", "-p", package, "--bench", bench, "--", *filters]
    environment = {**os.environ, "RUSTC_WORKSPACE_WRAPPER": ""}
    done = subprocess.run(command, cwd=checkout, env=environment, capture_output=True, text=True)
    if done.returncode != 0:
        print(f"{bench} is left out: {done.stderr.splitlines()[-1:]}", file=sys.stderr)
    return dict(least_times(done.stdout))


def least_times(text):
    """Yields the names and the least time, s, of each benchmark of divan's tree."""
    units = {"ns": 1e-9, "µs": 1e-6, "ms": 1e-3, "s": 1.0}
    path = []
    for line in text.splitlines():
        match = re.match(r"^((?:[│ ]  )*)[├╰]─ (.*)", line)
        if not match:
            continue
        name, *columns = match[2].split("│")
        named = re.match(r"(.*?)\s+([\d.]+) (ns|µs|ms|s)\s*$", name)
        path = [*path[: len(match[1]) // 3], (named[1] if named else name).strip()]
        if named and columns:
            yield tuple(path), float(named[2]) * units[named[3]]
