"""Checks that two model files hold the same numbers, apart from the names and digests of files.

    python tools/logs/compare.py ONE.json OTHER.json
"""

import json
import sys

# What names recordings, and what a log does not have: motions, which `basis` mentions, and the mark
# of a simulation.
NAMES = {"sha256", "file", "run", "motion", "basis", "simulated"}


def numbers(value):
    """Returns a value without names."""
    if isinstance(value, dict):
        return {key: numbers(inner) for key, inner in value.items() if key not in NAMES}
    if isinstance(value, list):
        return [numbers(inner) for inner in value]
    return value


def differences(one, other, path=""):
    """Yields the places at which two values differ. Python reads a number to its last bit."""
    if isinstance(one, dict) and isinstance(other, dict) and one.keys() == other.keys():
        for key in one:
            yield from differences(one[key], other[key], f"{path}.{key}")
    elif isinstance(one, list) and isinstance(other, list) and len(one) == len(other):
        for index, pair in enumerate(zip(one, other)):
            yield from differences(*pair, f"{path}[{index}]")
    elif one != other:
        yield f"{path}: {one} and {other}"


def main():
    models = []
    for path in sys.argv[1:3]:
        with open(path) as file:
            models.append(numbers(json.load(file)))
    found = list(differences(*models))
    print("\n".join(found[:20]) or f"{models[0]['cost']!r}: the models are equal")
    return 1 if found else 0


sys.exit(main())
