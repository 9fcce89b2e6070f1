#!/usr/bin/env python3
"""Checks how the sources are laid out, and prints their size, one line per crate.

    tools/house/check.py [CHECKOUT]           check a checkout, by default this one
    tools/house/check.py --names [CHECKOUT]   list types that several files define by one name
    tools/house/check.py --write              lower the ceilings in ceilings.toml

Fails on files of one crate or of the Python package that import each other in a circle, on
functions of more than 60 lines, on Rust or Python files of more than 400 lines, on sizes above
their ceiling, and on `conform` where it speaks of joints: it knows the parts of any system.

Public items are those declared `pub`, functions of types among them; the compiler refuses `pub` for
what cannot be reached from outside its crate. A `pub use` gives an item another path and is no
item. Exports are the names that `lib.rs` exports. `twice` counts the types of a crate whose name
stands in another file too, and for all crates the names that do. Tests are left out, but for the
lines.
"""

import re
import statistics
import subprocess
import sys
import tomllib
from pathlib import Path

import ceilings
import python
import rust

LONGEST_FUNCTION = 60
LONGEST_FILE = 400

PUBLIC = re.compile(r"^\s*pub (?:fn|struct|enum|trait|const|static|type|mod)\b", re.MULTILINE)
EXPORT = re.compile(r"^pub (?:const fn|fn|struct|enum|trait|const|static|type|mod) (\w+)", re.M)
JOINT = re.compile(r"(?<!dis)joint", re.IGNORECASE)
TYPE = re.compile(r"^\s*(?:pub(?:\([^)]*\))? )?(?:struct|enum|trait) (\w+)", re.M)
COLUMNS = "crate lines types twice public exports needs circles functions median longest".split()


def main(arguments):
    options = {argument for argument in arguments if argument.startswith("--")}
    given = [argument for argument in arguments if argument not in options]
    root = Path(given[0] if given else Path(__file__).parents[2]).resolve()
    folders = [*sorted(path.parent for path in root.glob("crates/*/src")), root / "python"]
    crates = {folder: rust.crate(folder) for folder in folders if (folder / "src").is_dir()}
    twice = names_of_several_files(crates)
    if "--names" in options:
        for name, files in sorted(twice.items(), key=lambda item: (-len(item[1]), item[0])):
            print(f"{name}: {', '.join(str(file.relative_to(root)) for file in files)}")
        return 0
    rows = [size(folder, modules, twice) for folder, modules in crates.items()]
    total = ["all", *(sum(row[i] for row in rows) for i in range(1, 9)), "", ""]
    total[COLUMNS.index("twice")] = len(twice)
    for row in [COLUMNS, *rows, total]:
        print("{:12}".format(row[0]) + "".join(f"{value:>10}" for value in row[1:]))
    file = root / "tools/house/ceilings.toml"
    sizes = {"public-items": total[4], "names-in-two-files": total[3],
             **{f"lines.{row[0]}": row[1] for row in rows}}
    if "--write" in options:
        ceilings.write(file, ceilings.lowered(ceilings.read(file), sizes))
    package = root / "python/reachtube"
    modules_of = crates | {package: python.package(package)}
    faults = [fault for item in modules_of.items() for fault in circles_of(*item)]
    faults += [fault for modules in crates.values() for fault in long_functions(root, modules)]
    faults += [*long_files(root), *joints(root), *ceilings.faults(ceilings.read(file), sizes)]
    print("\n".join(faults) or "No circle of imports, nothing too long, no joint in `conform`, no "
                               "size above its ceiling.")
    return 1 if faults else 0


def circles_of(folder, modules):
    """Yields the circles of a crate or package in words."""
    for files, steps in circles(modules):
        yield f"{folder.name}: {len(files)} files import each other in a circle:"
        yield from (f"    {file.relative_to(folder.parent)}" for file in files)
        yield "  for example:"
        for one, line, other in steps:
            one, other = one.relative_to(folder.parent), other.relative_to(folder.parent)
            yield f"    {one}:{line} imports {other}"


def long_functions(root, modules):
    for module in modules:
        for name, line, length in rust.functions(module.text):
            if length > LONGEST_FUNCTION:
                yield f"{module.file.relative_to(root)}:{line}: `{name}` has {length} lines, " \
                      f"more than {LONGEST_FUNCTION}"


def circles(modules):
    """Returns the circles of a crate: their files, and the imports of one shortest way round."""
    imports = {module: module.imports() for module in modules if module.holds_code}
    reached = {module: ways(imports, module) for module in imports}
    left, found = list(imports), []
    for module in imports:
        if module in left and module in reached[module]:
            circle = [other for other in reached[module] if module in reached[other]]
            left = [other for other in left if other not in circle]
            steps, at = [], module
            while not steps or at is not module:
                before = reached[module][at]
                steps.insert(0, (before.file, imports[before][at], at.file))
                at = before
            found.append((sorted(other.file for other in circle), steps))
    return found


def ways(imports, start):
    """Returns what `start` reaches, each with the module before it on a shortest way."""
    before, queue = {}, [start]
    for module in queue:
        for other in imports[module]:
            if other not in before:
                before[other] = module
                queue.append(other)
    return before


def long_files(root):
    command = ["git", "-C", root, "ls-files", "*.rs", "*.py"]
    listed = subprocess.run(command, check=True, capture_output=True, text=True).stdout.split()
    for file in (file for file in listed if (root / file).exists()):
        lines = (root / file).read_text().count("\n")
        if lines > LONGEST_FILE:
            yield f"{file}: {lines} lines, more than {LONGEST_FILE}; does it hold two concepts?"


def joints(root):
    """Yields the lines of `conform` that know joints."""
    for file in sorted((root / "crates/conform/src").rglob("*.rs")):
        for number, line in enumerate(file.read_text().splitlines(), 1):
            if JOINT.search(line):
                yield f"{file.relative_to(root)}:{number}: `conform` knows parts and no joints; " \
                      "take the word from `Signals::noun`, or move the code to `arm`"


def size(folder, modules, twice):
    """Returns the row of a crate."""
    lines = sum(file.read_text().count("\n") for file in (folder / "src").rglob("*.rs"))
    public = sum(len(PUBLIC.findall(module.text)) for module in modules)
    types = [name for module in modules for name in TYPE.findall(module.text)]
    needs = tomllib.loads((folder / "Cargo.toml").read_text()).get("dependencies", {})
    lengths = [length for module in modules for _, _, length in rust.functions(module.text)]
    in_circles = sum(len(files) for files, _ in circles(modules))
    return [folder.name, lines, len(types), sum(name in twice for name in types), public,
            len(exports(folder)), len(needs), in_circles, len(lengths),
            statistics.median(lengths), max(lengths)]


def exports(folder):
    """Returns the names that the library of a crate exports."""
    library = folder / "src/lib.rs"
    text = rust.code(library.read_text()) if library.exists() else ""
    declared = [found[2] for found in rust.USE.finditer(text) if found[1] and "(" not in found[1]]
    return {*EXPORT.findall(text), *(name for use in declared for _, name in rust.paths_of(use))}


def names_of_several_files(crates):
    """Returns the names of types that more than one file defines, with the files."""
    files = {}
    for module in (module for modules in crates.values() for module in modules):
        for name in TYPE.findall(module.text):
            files.setdefault(name, []).append(module.file)
    return {name: places for name, places in files.items() if len(places) > 1}


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
