"""Processor time, wall time and memory of a command."""

import json
import resource
import statistics
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

    def __str__(self):
        return f"{self.cpu:.2f} s ({self.wall:.2f} s), {self.memory:.0f} MB"


def once(command):
    """Runs a command and returns what it took; None if it fails. A small process of its own starts
    the command, since the memory of a process that starts a command counts for the command."""
    helper = [sys.executable, "-S", __file__, *map(str, command)]
    done = subprocess.run(helper, stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True)
    if done.returncode == 0:
        return Cost(*json.loads(done.stdout))
    words = done.stderr.strip().splitlines()[:1]
    print(f"left out: {' '.join(map(str, command))}: {' '.join(words)}", file=sys.stderr)
    return None


def in_turn(commands, rounds):
    """Runs commands one after the other, again and again, and returns the medians of what each
    takes; None where there is no command, or it fails."""
    found = [[] for _ in commands]
    for _ in range(rounds):
        for costs, command in zip(found, commands):
            if command is not None and None not in costs:
                costs.append(once(command))
    return [median(costs) if costs and None not in costs else None for costs in found]


def median(costs):
    """Returns the medians of processor time, wall time and memory."""
    of = [(cost.cpu, cost.wall, cost.memory) for cost in costs]
    return Cost(*(statistics.median(column) for column in zip(*of)))


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
