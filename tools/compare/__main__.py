"""Compares the command with peers, with older builds and with the limits of the machine.

tools/compare/run                                  # whole commands, on standard output
tools/compare/run --before NAME=CHECKOUT           # and the builds of older checkouts
tools/compare/run --kernels                        # single functions too
tools/compare/run --growth docs/images/growth.svg  # and how time and memory grow

A build is CHECKOUT/target/release/reachtube. The build of this checkout is made if it is missing.
"""

import argparse
import os
import time
from pathlib import Path

from builds import Build
from commands import rows_of_commands
from growth import draw, grown
from kernels import rows_of_kernels
import limits

ROOT = Path(__file__).resolve().parents[2]


def main():
    options = options_of_command()
    ours = Build("now", ROOT)
    ours.make()
    builds = [*options.before, ours]
    folder = ROOT / "target/compare/work"
    folder.mkdir(parents=True, exist_ok=True)
    limit = limits.measured(folder)
    print(f"{processor()}, {os.cpu_count()} cores, {time.strftime('%Y-%m-%d')}, load "
          f"{os.getloadavg()[0]:.1f}; one core: {limit.words()}\n")
    if not options.no_commands:
        print_table(builds, rows_of_commands(builds, folder, options))
    if options.kernels:
        print_table(builds, rows_of_kernels(builds, folder, limit, options.only))
    if options.growth:
        draw(grown(builds, folder, ROOT, options.rounds), options.growth)


def options_of_command():
    parser = argparse.ArgumentParser(
        description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter
    )
    parser.add_argument("--before", type=Build.of, action="append", default=[],
                        metavar="NAME=CHECKOUT", help="an older checkout; can be repeated")
    parser.add_argument("--growth", type=Path, help="measure the growth and draw this figure")
    parser.add_argument("--kernels", action="store_true", help="measure single functions too")
    parser.add_argument("--no-commands", action="store_true", help="leave whole commands out")
    parser.add_argument("--long", action="store_true", help="model 2, p = 5 too: minutes")
    parser.add_argument("--rounds", type=int, default=3, help="how often each command runs")
    parser.add_argument("--only", default="", help="only the rows whose work contains this text")
    return parser.parse_args()


def print_table(builds, rows):
    """Prints rows of a work, what each build takes, what a peer takes, and the limit."""
    columns = ["work", *(build.name for build in builds), "peer", "limit"]
    print(f"| {' | '.join(columns)} |\n|{'---|' * len(columns)}", flush=True)
    for work, costs, peer, limit in rows:
        cells = [work, *("-" if cost is None else str(cost) for cost in costs), peer, limit]
        print(f"| {' | '.join(cells)} |", flush=True)
    print()


def processor():
    with open("/proc/cpuinfo") as file:
        names = [line.split(":")[1].strip() for line in file if line.startswith("model name")]
    return names[0] if names else "unknown processor"


if __name__ == "__main__":
    main()
