#!/usr/bin/env python3
"""Checks how the Rust sources are laid out, and prints their size.

    tools/house/check.py [CHECKOUT]

Fails on files of one crate that import each other in a circle, on functions of more than 60 lines,
and on Rust or Python files of more than 400 lines. Prints one line per crate: lines, public items
(those declared `pub`, which the compiler refuses for what cannot be reached from outside), names
that the crate exports, and the median length of a function. Tests are left out.
"""

import re
import statistics
import subprocess
import sys
from pathlib import Path

LONGEST_FUNCTION = 60
LONGEST_FILE = 400
# Number of circles that a crate still has. No entry may be added or raised.
KNOWN_CIRCLES = {}

ITEM = re.compile(r"^\s*pub (?:const |async |unsafe )*(?:fn|struct|enum|trait|const|static|type|mod"
                  r"|use) ", re.MULTILINE)
FUNCTION = re.compile(r"^( *)(?:pub(?:\([^)]*\))? )?(?:const |async )*fn (\w+)", re.MULTILINE)
PATH = re.compile(r"\b((?:crate|self|super)(?:::(?:super|[a-z]\w*|[A-Z]\w*))+)")


def main():
    root = Path(sys.argv[1] if len(sys.argv) > 1 else Path(__file__).parents[2]).resolve()
    folders = sorted(path.parent for path in root.glob("crates/*/src"))
    crates = [folder for folder in [*folders, root / "python"] if (folder / "src").is_dir()]
    faults = [fault for crate in crates for fault in faults_of(crate)] + long_files(root)
    print(f"{'crate':12} {'lines':>6} {'public':>6} {'names':>6} {'median function':>16}")
    rows = [size(crate) for crate in crates]
    for name, *numbers in [*rows, ("all", *(sum(row[i] for row in rows) for i in (1, 2, 3)), "")]:
        print("{:12} {:>6} {:>6} {:>6} {:>16}".format(name, *numbers))
    print("\n".join(faults) or "no circles of imports, no function or file that is too long")
    return 1 if faults else 0


def faults_of(crate):
    """Yields the circles and long functions of a crate, as text."""
    sources = read(crate / "src")
    found = circles(imports(sources))
    for circle in found if len(found) > KNOWN_CIRCLES.get(crate.name, 0) else []:
        files = ", ".join(str(file.relative_to(crate)) for file in sorted(circle))
        yield f"{crate.name}: these files import each other in a circle: {files}"
    for file, text in sources.items():
        for name, line, length in functions(text):
            if length > LONGEST_FUNCTION:
                yield f"{file}:{line}: function {name} has {length} lines, more than " \
                      f"{LONGEST_FUNCTION}"


def read(folder):
    """Returns the text of each source file, without its tests, comments and strings."""
    files = [file for file in sorted(folder.rglob("*.rs")) if file.name != "tests.rs"]
    tests = re.compile(r"^\s*#\[cfg\(test\)\]\s*mod (\w+);", re.MULTILINE)
    only_tests = {file.parent / f"{name}.rs" for file in files
                  for name in tests.findall(file.read_text())}
    return {file: plain(file.read_text()) for file in files if file not in only_tests}


def plain(text):
    text = re.sub(r'r#".*?"#|"(?:\\.|[^"\\])*"', lambda m: '"' + "\n" * m[0].count("\n") + '"',
                  re.sub(r"^\s*//.*$", "", text, flags=re.MULTILINE), flags=re.DOTALL)
    return re.split(r"^#\[cfg\(test\)\]\nmod \w+ \{", text, flags=re.MULTILINE)[0]


def functions(text):
    """Yields name, line and length of each function that has a body."""
    for match in FUNCTION.finditer(text):
        body = re.compile(r"[{;]").search(text, match.end())
        if body and body[0] == "{":
            line = text.find("\n", body.start())
            # A body on one line ends there; any other ends at the brace under its `fn`.
            one = text[body.start():line].rstrip().endswith("}")
            last = line if one else re.compile(rf"^{match[1]}\}}", re.MULTILINE).search(
                text, body.start()).end()
            length = text.count("\n", match.start(), last) + 1
            yield match[2], text.count("\n", 0, match.start()) + 1, length


def imports(sources):
    """Returns the files that each file imports."""
    root = min(sources, key=lambda file: len(file.parts)).parent
    modules = {module_of(file, root): file for file in sources}
    exports = {module: reexports(sources[file], module) for module, file in modules.items()}
    graph = {}
    for module, file in modules.items():
        # A file that only declares modules and exports their names imports nothing.
        text = re.sub(r"^\s*pub(?:\([^)]*\))? use [^;]*;", "", sources[file], flags=re.MULTILINE)
        paths = {path for used in uses(text) for path in [absolute(used, module)] if path}
        targets = {modules[target] for path in paths
                   for target in [resolve(path, modules, exports)] if target is not None}
        graph[file] = targets - {file}
    return graph


def module_of(file, root):
    parts = file.relative_to(root).with_suffix("").parts
    return tuple(part for part in parts if part not in ("mod", "lib", "main"))


def uses(text):
    """Yields each path of a file, with the groups of its `use` declarations taken apart."""
    for declaration in re.findall(r"\buse ((?:crate|self|super)[^;]*);", text):
        yield from expand("".join(declaration.split()))
    yield from PATH.findall(text)


def expand(path):
    before, brace, rest = path.partition("{")
    if not brace:
        yield path
        return
    depth, start, inner = 0, 0, rest[: rest.rindex("}")]
    for place, character in enumerate(inner + ","):
        depth += (character == "{") - (character == "}")
        if character == "," and depth == 0:
            if inner[start:place]:
                yield from expand(before + inner[start:place])
            start = place + 1


def absolute(path, module):
    """Returns a path from the root of the crate."""
    first, *rest = re.sub(r"as\w+$|::\*$", "", path).split("::")
    place = () if first == "crate" else module if first == "self" else module[:-1]
    while rest and rest[0] == "super":
        place, rest = place[:-1], rest[1:]
    return (*place, *rest)


def reexports(text, module):
    """Returns where the names come from that a module exports and does not define."""
    found = {}
    for declaration in re.findall(r"^\s*pub(?:\([^)]*\))? use ([^;]*);", text, re.MULTILINE):
        for path in expand("".join(declaration.split())):
            parts = path.split("::")
            if parts[0] in ("crate", "self", "super"):
                found[parts[-1]] = absolute(path, module)
            else:
                found[parts[-1]] = (*module, *parts)
    return found


def resolve(path, modules, exports, depth=0):
    """Returns the module that defines what a path names."""
    for length in range(len(path), -1, -1):
        module = path[:length]
        if module in modules:
            name = path[length] if length < len(path) else None
            target = exports[module].get(name)
            if target and target != path and depth < 8:
                return resolve((*target, *path[length + 1:]), modules, exports, depth + 1)
            return module
    return None


def circles(graph):
    """Returns the strongly connected components of two files or more (Tarjan's algorithm)."""
    order, low, stack, found = {}, {}, [], []

    def visit(file):
        order[file] = low[file] = len(order)
        stack.append(file)
        for other in graph.get(file, ()):
            if other not in order:
                visit(other)
            if other in stack:
                low[file] = min(low[file], low[other])
        if low[file] == order[file]:
            component = stack[stack.index(file):]
            del stack[stack.index(file):]
            found.extend([component] if len(component) > 1 else [])

    sys.setrecursionlimit(10_000)
    for file in graph:
        if file not in order:
            visit(file)
    return found


def long_files(root):
    command = ["git", "-C", root, "ls-files", "*.rs", "*.py"]
    listed = subprocess.run(command, check=True, capture_output=True, text=True).stdout.split()
    lines = {file: (root / file).read_text().count("\n") for file in listed}
    return [f"{file}: {count} lines, more than {LONGEST_FILE}" for file, count in lines.items()
            if count > LONGEST_FILE]


def size(crate):
    """Returns name, lines, public items, exported names and the median length of a function."""
    texts = [file.read_text() for file in sorted((crate / "src").rglob("*.rs"))]
    sources = read(crate / "src")
    library = crate / "src/lib.rs"
    exported = reexports(library.read_text(), ()) if library.exists() else {}
    lengths = [length for text in sources.values() for _, _, length in functions(text)]
    items = sum(len(ITEM.findall(text)) for text in texts)
    return (crate.name, sum(text.count("\n") for text in texts), items, len(exported),
            statistics.median(lengths))


if __name__ == "__main__":
    sys.exit(main())
