"""Runs the command as `python -m recheck`."""

import sys

from .cli import main

sys.exit(main())
