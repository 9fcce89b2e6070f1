#!/usr/bin/env python3
"""Checks what `cargo package --workspace` wrote: a package must stand on its own.

Each package needs a description, keywords, categories, both licences and a README of its own. A
link of the README must not lead out of the package. Exits with 1 where one does not hold.
"""

import json
import re
import subprocess
import sys
import tarfile
from pathlib import Path

ROOT = Path(__file__).resolve().parents[2]
LICENCES = ("LICENSE-MIT", "LICENSE-APACHE")
FIELDS = ("description", "license", "readme", "rust_version", "keywords", "categories")


def main():
    command = ["cargo", "metadata", "--no-deps", "--format-version", "1", "--locked"]
    found = subprocess.run(command, cwd=ROOT, check=True, capture_output=True, text=True).stdout
    metadata = json.loads(found)
    # An empty list stands for `publish = false`.
    packages = [package for package in metadata["packages"] if package["publish"] != []]
    folder = Path(metadata["target_directory"]) / "package"
    faults = [fault for package in packages for fault in faults_of(package, folder)]
    print("\n".join(faults) or f"{len(packages)} packages have licences, README and metadata")
    return 1 if faults else 0


def faults_of(package, folder):
    """Yields what a package lacks, as text."""
    name = f"{package['name']}-{package['version']}"
    for field in FIELDS:
        if not package[field]:
            yield f"{name}: Cargo.toml has no {field}"
    with tarfile.open(folder / f"{name}.crate") as archive:
        files = {Path(member.name).relative_to(name).as_posix() for member in archive}

        def text(file):
            return archive.extractfile(f"{name}/{file}").read().decode()

        for licence in LICENCES:
            if licence not in files:
                yield f"{name}: {licence} is missing; link it: ln -s ../../{licence}"
            elif text(licence) != (ROOT / licence).read_text():
                yield f"{name}: {licence} differs from the repository's"
        if "README.md" not in files:
            yield f"{name}: README.md is missing"
            return
        for link in re.findall(r"\]\((?!https?:|#)([^)\s]+)\)", text("README.md")):
            # Links of rustdoc, such as [`reach`](fn@reach), name no file.
            if link.startswith("..") or ("/" in link and link not in files):
                yield f"{name}: README.md has a link that leaves the package: {link}"


if __name__ == "__main__":
    sys.exit(main())
