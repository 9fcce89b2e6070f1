#!/usr/bin/env python3
"""Runs notebooks. A notebook with outputs is a page of the documentation: it must print what it
has.

    tools/python/notebooks.py FILE...            run, and compare what is printed
    tools/python/notebooks.py --write FILE...    run, and keep what is printed and drawn
"""

import argparse
import difflib
import re
import sys
from pathlib import Path

import nbformat
from nbclient import NotebookClient
from nbclient.exceptions import CellExecutionError

# Seconds that a cell may take.
TIMEOUT = 1200

# Where the kernel keeps a cell, which differs from run to run.
PLACE = re.compile(r"\S*ipykernel_\d+/\d+\.py:(\d+)")


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--write", action="store_true", help="keep what is printed and drawn")
    parser.add_argument("files", nargs="+", type=Path)
    options = parser.parse_args()
    failed = [path for path in options.files if not run(path, options.write)]
    print(f"{len(options.files)} notebooks, {len(failed)} failed.")
    return 1 if failed else 0


def run(path, writes):
    """Runs a notebook in its folder, and returns whether it printed what it has."""
    notebook = nbformat.read(path, as_version=4)
    stored = [printed(cell) for cell in notebook.cells]
    has_outputs = any(cell.get("outputs") for cell in notebook.cells)
    client = NotebookClient(
        notebook,
        timeout=TIMEOUT,
        resources={"metadata": {"path": str(path.parent)}},
        extra_arguments=["--log-level=ERROR"],
    )
    try:
        client.execute()
    except CellExecutionError as error:
        print(f"{path}: {error}")
        return False
    notebook.cells = [without_places(cell) for cell in notebook.cells]
    if writes:
        notebook.metadata.language_info = {"name": "python"}
        nbformat.write(notebook, path)
        return True
    found = [printed(cell) for cell in notebook.cells]
    if not has_outputs or found == stored:
        return True
    for number, (before, now) in enumerate(zip(stored, found)):
        name = f"{path}: cell {number}"
        lines = difflib.unified_diff(
            before.splitlines(), now.splitlines(), name, "now", lineterm=""
        )
        for line in lines:
            print(line)
    print(f"{path} prints something else now; tools/python/notebooks.py --write {path} keeps it.")
    return False


def without_places(cell):
    """Returns a cell without times, and with the number of a line for its place."""
    cell.metadata.pop("execution", None)
    for output in cell.get("outputs", []):
        if output.output_type == "stream":
            output.text = PLACE.sub(r"line \1", output.text)
    return cell


def printed(cell):
    """Returns the text of a cell's outputs; figures and warnings differ between libraries."""
    texts = []
    for output in cell.get("outputs", []):
        if output.get("name") == "stdout":
            texts.append(output.text)
        elif "image/png" not in output.get("data", {}):
            texts.append(output.get("data", {}).get("text/plain", ""))
    return "".join(texts)


if __name__ == "__main__":
    sys.exit(main())
