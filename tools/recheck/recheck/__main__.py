"""Runs the command as `python -m recheck`."""

import sys
import traceback


def run():
    """Returns the exit code. A fault of this program is no verdict: its code is 3, and not the 1
    that Python ends with by itself."""
    try:
        from .cli import main

        return main()
    except Exception:
        traceback.print_exc()
        return 3


sys.exit(run())
