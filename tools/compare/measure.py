"""Processor time, wall time and memory of a command."""

import os
import subprocess
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


def once(command, cwd=None):
    """Runs a command and returns what it took. Exit code 3 is an answer too."""
    began = time.perf_counter()
    process = subprocess.Popen(
        list(map(str, command)), cwd=cwd, stdout=subprocess.DEVNULL, stderr=subprocess.PIPE
    )
    errors = process.stderr.read().decode()
    _, status, usage = os.wait4(process.pid, 0)
    process.stderr.close()
    process.returncode = os.waitstatus_to_exitcode(status)
    if process.returncode not in (0, 1, 3):
        raise SystemExit(f"{' '.join(map(str, command))}\n{errors}")
    wall = time.perf_counter() - began
    return Cost(usage.ru_utime + usage.ru_stime, wall, usage.ru_maxrss / 1024)


def in_turn(commands, rounds=3):
    """Runs commands one after the other, again and again, and returns the least cost of each; None
    where there is no command."""
    found = [[] for _ in commands]
    for _ in range(rounds):
        for costs, command in zip(found, commands):
            if command is not None:
                costs.append(once(command))
    return [min(costs, key=lambda cost: cost.cpu) if costs else None for costs in found]
