"""Ceilings of the size of the sources, kept in `ceilings.toml`, which may only fall."""

import tomllib

HEAD = """\
# Ceilings that `tools/house/check.py` compares the sources with: lines under `src` of each crate,
# `pub` items of all crates, and names of types that two files or more define. If a commit needs
# more than one of them, raise it in that commit, and say in its message why the code is worth it.
# `tools/house/check.py --write` lowers them to the present sizes and raises none.
"""
STEP = 50  # Ceilings of lines are multiples, so that a small repair does not meet one.


def read(file):
    """Returns the ceilings by their names, `lines.CRATE` for a crate; none without the file."""
    table = tomllib.loads(file.read_text()) if file.exists() else {}
    lines = table.pop("lines", {})
    return table | {f"lines.{crate}": ceiling for crate, ceiling in lines.items()}


def faults(ceilings, sizes):
    """Yields a sentence for each size that is above its ceiling, or has none."""
    for name, value in sizes.items() if ceilings else ():
        if value > ceilings.get(name, -1):
            above = f"above its ceiling {ceilings[name]}" if name in ceilings else "has no ceiling"
            yield f"{name} is {value}, {above}: remove code, or change tools/house/ceilings.toml " \
                  "in this commit and give the reason in its message"


def lowered(ceilings, sizes):
    """Returns ceilings for the present sizes: lower where possible, never higher."""
    steps = {name: -(-value // STEP) * STEP if name.startswith("lines.") else value
             for name, value in sizes.items()}
    return {name: min(value, ceilings.get(name, value)) for name, value in steps.items()}


def write(file, ceilings):
    """Writes ceilings as `read` returns them."""
    totals = [f"{name} = {value}" for name, value in ceilings.items() if "." not in name]
    lines = [f"{name.removeprefix('lines.')} = {value}" for name, value in ceilings.items()
             if "." in name]
    file.write_text("\n".join([HEAD, *totals, "", "[lines]", *lines, ""]))
