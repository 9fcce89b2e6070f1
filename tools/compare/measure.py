"""Processor time, wall time and memory of a command."""

import json
import resource
import subprocess
import sys
import time
from dataclasses import dataclass


@dataclass
class Cost:
    """What a command took."""

    cpu: float
    """Processor time, s."""
    wall: float
    """Time on the clock, s."""
    memory: float
    """Largest resident memory, MB."""


def once(command):
    """Runs a command and returns what it took. A small process of its own starts the command, since
    the memory of a process that starts a command counts for the command."""
    helper = [sys.executable, "-S", __file__, *map(str, command)]
    done = subprocess.run(helper, stdout=subprocess.PIPE, text=True)
    if done.returncode != 0:
        raise SystemExit(f"failed: {' '.join(map(str, command))}")
    return Cost(*json.loads(done.stdout))


def in_turn(commands, rounds=3):
    """Runs commands one after the other, again and again, and returns the least cost of each; None
    where there is no command."""
    found = [[] for _ in commands]
    for _ in range(rounds):
        for costs, command in zip(found, commands):
            if command is not None:
                costs.append(once(command))
    return [min(costs, key=lambda cost: cost.cpu) if costs else None for costs in found]


def main():
    """Runs the command of the arguments and prints what it took. Exit codes 1 and 3 are answers."""
    began = time.perf_counter()
    code = subprocess.run(sys.argv[1:], stdout=subprocess.DEVNULL).returncode
    wall = time.perf_counter() - began
    usage = resource.getrusage(resource.RUSAGE_CHILDREN)
    print(json.dumps([usage.ru_utime + usage.ru_stime, wall, usage.ru_maxrss / 1024]))
    sys.exit(0 if code in (0, 1, 3) else 1)


if __name__ == "__main__":
    main()
