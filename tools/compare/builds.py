"""Builds of the command: of this checkout, and of older ones."""

import os
import subprocess
from dataclasses import dataclass
from pathlib import Path


@dataclass
class Build:
    """A checkout and the build in it."""

    name: str
    """What a column is called."""
    checkout: Path
    """The folder of the checkout."""

    @classmethod
    def of(cls, text):
        """Reads NAME=CHECKOUT."""
        name, _, checkout = text.partition("=")
        build = cls(name, Path(checkout).resolve())
        if not checkout or not build.command.exists():
            raise ValueError(f"{text}: there is no {build.command}")
        return build

    @property
    def command(self):
        """The command; for this checkout, another one that REACHTUBE names."""
        named = os.environ.get("REACHTUBE") if self.name == "now" else None
        return Path(named or self.checkout / "target/release/reachtube").resolve()

    def make(self):
        """Builds the command if it is missing."""
        if not self.command.exists():
            build = ["cargo", "build", "--release", "--locked", "-p", "reachtube-cli"]
            subprocess.run(build, cwd=self.checkout, check=True)
