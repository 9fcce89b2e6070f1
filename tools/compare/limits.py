"""What one core of the machine can do at most."""

import os
import subprocess
import sys
from dataclasses import dataclass
from pathlib import Path

HERE = Path(__file__).resolve().parent


@dataclass
class Limit:
    """What `limits/` printed, by name; empty if it could not be built."""

    numbers: dict

    def words(self):
        """Words the two limits."""
        if not self.numbers:
            return "no limits"
        operations = self.numbers["operations_per_second"] / 1e9
        copied = self.numbers["copied_bytes_per_second"] / 1e9
        return f"{operations:.1f} GFLOP/s fused, {copied:.1f} GB/s copied"

    def of_operations(self, count):
        """Returns the time of so many operations, or of those that a name stands for, s."""
        count = self.numbers.get(count) if isinstance(count, str) else count
        return count and self.numbers and count / self.numbers["operations_per_second"]

    def of_bytes(self, count):
        """Returns the time of copying so many bytes, s."""
        return self.numbers and count / self.numbers["copied_bytes_per_second"]


def measured(folder):
    """Measures the limits, by a program that is built for this machine."""
    done = run_for_this_machine("limits", folder)
    lines = [line.split() for line in done.splitlines()] if done else []
    return Limit({name: float(number) for name, number in lines})


def run_for_this_machine(package, folder):
    """Builds a Rust package beside this file for this machine, runs it, and returns what it prints;
    None if it does not build."""
    environment = {**os.environ, "RUSTFLAGS": "-C target-cpu=native", "RUSTC_WORKSPACE_WRAPPER": ""}
    command = ["cargo", "run", "--quiet", "--release", "--target-dir", folder / package]
    done = subprocess.run(
        command, cwd=HERE / package, env=environment, capture_output=True, text=True
    )
    if done.returncode == 0:
        return done.stdout
    print(f"{package} is left out: {done.stderr.splitlines()[-1:]}", file=sys.stderr)
    return None
