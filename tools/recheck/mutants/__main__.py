"""Edits the files of a small experiment in many ways, and compares each answer of the second
program with the one that it must give. `tools/recheck/run` writes the files.

    python tools/recheck/mutants FOLDER
"""

import contextlib
import io
import os
import shutil
import sys
import tempfile
import time
from pathlib import Path

os.environ.setdefault("OMP_NUM_THREADS", "1")
sys.path.insert(0, str(Path(__file__).parents[1]))

from edits import Files  # noqa: E402
from table import MUTANTS  # noqa: E402

from recheck.cli import main  # noqa: E402

def prepare(source, folder):
    """Takes what the mutants need of it."""
    for name in ("short.json", "exact.json", "planes.json", "cubic.json", "points.jsonl",
                 "planes.jsonl"):
        shutil.copy(source / name, folder)
    (folder / "cubic").mkdir()
    for name in ("reach.json", "M1a.csv", "M1a_tube.csv"):
        shutil.copy(source / "cubic" / name, folder / "cubic")
    shutil.copytree(source / "short", folder / "recordings")


def answer(original, model, edit, options):
    """Edits a copy of the files, and returns the exit code of the second program and its words."""
    with tempfile.TemporaryDirectory() as folder:
        folder = Path(folder) / "copy"
        shutil.copytree(original, folder, copy_function=os.link)
        files = Files(folder, model)
        edit(files)
        files.seal()
        options = [str(folder / x) if (folder / x).exists() else x for x in options]
        said = io.StringIO()
        with contextlib.redirect_stdout(said), contextlib.redirect_stderr(said):
            code = main([str(files.path), "--data", str(folder / "recordings"), *options])
        return code, said.getvalue()


def run(source):
    """Tries all mutants, prints what differs, and returns the number of wrong answers."""
    started, wrong = time.process_time(), 0
    with tempfile.TemporaryDirectory() as folder:
        original = Path(folder)
        prepare(Path(source), original)
        for model, name, edit, options, expected in MUTANTS:
            code, said = answer(original, model, edit, options)
            if code != expected:
                wrong += 1
                print(f"{model}, {name}: exit code {code}, not {expected}\n{said}")
    seconds = time.process_time() - started
    print(f"mutants: {len(MUTANTS)}, wrong answers: {wrong} ({seconds:.0f} s of processor time)")
    return wrong


if __name__ == "__main__":
    sys.exit(min(run(sys.argv[1]), 1))
