"""Runs the command as `python tools/recheck`."""

import os
import sys
import traceback

# Matrices are small here: more threads only wait for each other.
os.environ.setdefault("OMP_NUM_THREADS", "1")


def run():
    """Returns the exit code. A fault of this program is no verdict: its code is 3, and not the 1
    that Python ends with by itself."""
    try:
        from recheck.cli import main

        return main()
    except ImportError as error:
        print(f"error: {error}; run `pip install -r tools/recheck/requirements.txt` with Python "
              "3.10 or later", file=sys.stderr)
    except Exception:
        traceback.print_exc()
    return 3


sys.exit(run())
