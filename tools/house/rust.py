"""Reads Rust sources as far as `check.py` needs: modules, their imports, and their functions."""

import re
from pathlib import Path

NOISE = re.compile(
    r"""//[^\n]* | /\*.*?\*/ | \bb?r(\#*)".*?"\1 | \bb?"(?:\\.|[^"\\])*" | "(?:\\.|[^"\\])*"
    | \bb?'(?:\\[^'\n]+|\\'|[^\\'\n])' | '(?:\\[^'\n]+|\\'|[^\\'\n])'""",
    re.X | re.S,
)
ITEM = re.compile(r"\b(?:struct|enum|union|trait|fn|type|const|static|macro_rules!)\s+(\w+)")
USE = re.compile(r"\b(pub(?:\([^)]*\))?\s+)?use\s+([^;]+);")
CHILD = re.compile(r"\bmod\s+(\w+)\s*;")
INLINE = re.compile(r"(?<![\w:])[A-Za-z_]\w*(?:\s*::\s*[A-Za-z_]\w*)+")


def blank(text, pattern=NOISE):
    """Replaces what `pattern` finds by spaces; lines stay where they are."""
    return pattern.sub(lambda found: re.sub(r"[^\n]", " ", found[0]), text)


def end_of_block(text, start):
    """Returns the end of the item from `start` on: its `;`, or the brace that closes its body."""
    depth = 0
    for at in range(start, len(text)):
        if text[at] in "([{":
            depth += 1
        elif text[at] in ")]}":
            depth -= 1
            if depth == 0 and text[at] == "}":
                return at + 1
        elif text[at] == ";" and depth == 0:
            return at + 1
    return len(text)


def code(text):
    """Returns a file without its comments, strings and tests, line by line where it was."""
    text = blank(text)
    while found := re.search(r"#\[cfg\(test\)\]", text):
        end = end_of_block(text, found.end())
        tests = blank(text[found.start() : end], re.compile(".+"))
        text = text[: found.start()] + tests + text[end:]
    return text


def functions(text):
    """Yields the name, line and length in lines of each function with a body."""
    for found in re.finditer(r"\bfn\s+(\w+)", text):
        end = end_of_block(text, found.end())
        if text[end - 1] == "}":
            length = text.count("\n", found.start(), end) + 1
            yield found[1], text.count("\n", 0, found.start()) + 1, length


def paths_of(tree):
    """Yields the path and the name in scope of each leaf of a `use`, its groups taken apart."""
    head, brace, group = tree.partition("{")
    if not brace:
        path, _, name = tree.strip().partition(" as ")
        path = [part.strip() for part in path.split("::")]
        path = path[:-1] if path[-1] == "self" and len(path) > 1 else path
        yield path, name.strip() or path[-1]
        return
    depth, part = 0, ""
    for letter in group[: group.rindex("}")] + ",":
        depth += (letter == "{") - (letter == "}")
        if letter == "," and depth == 0:
            yield from paths_of(head + part) if part.strip() else ()
            part = ""
        else:
            part += letter


class Module:
    """A file of a crate. `uses` are names in scope with their paths, `globs` the paths of
    `use x::*`, and `paths` all paths in it with their lines."""

    def __init__(self, file, folder, parent=None):
        self.file, self.parent = file, parent
        self.root = parent.root if parent else self
        self.text = code(file.read_text())
        self.items = set(ITEM.findall(self.text))
        self.uses, self.globs, self.paths = {}, [], []
        for found in USE.finditer(self.text):
            line = self.text.count("\n", 0, found.start()) + 1
            for path, name in paths_of(found[2]):
                self.paths.append((line, path))
                if path[-1] == "*":
                    self.globs.append(path[:-1])
                else:
                    self.uses[name] = path
        body = blank(self.text, USE)
        for found in INLINE.finditer(body):
            line = body.count("\n", 0, found.start()) + 1
            self.paths.append((line, re.split(r"\s*::\s*", found[0])))
        self.children = {}
        for name in CHILD.findall(self.text):
            for file in (folder / f"{name}.rs", folder / name / "mod.rs"):
                if file.exists():
                    self.children[name] = Module(file, folder / name, self)
        # A file that only declares and re-exports is no node.
        rest = re.sub(r"(pub(\([^)]*\))?\s+)?mod\s+\w+\s*;", "", body)
        self.holds_code = bool(re.sub(r"#!?\[[^\]]*\]|pub(\([^)]*\))?|\s", "", rest))

    def all(self):
        return [self] + [module for child in self.children.values() for module in child.all()]

    def find(self, path, seen=()):
        """Returns the module that defines what `path` names here, or `None` outside the crate."""
        if not path:
            return self
        head, rest = path[0], path[1:]
        known = {"crate": self.root, "self": self, "super": self.parent, **self.children}
        if head in known:
            return known[head] and known[head].find(rest, seen)
        if (self, head) in seen:
            return self
        seen += ((self, head),)
        if head in self.uses:
            return self.find(self.uses[head] + rest, seen)
        if head in self.items:
            return self
        for glob in self.globs:
            other = self.find(glob, seen)
            if other and other is not self and (found := other.find(path, seen)):
                return found
        return None

    def imports(self):
        """Returns the modules that this one imports, each with the line of the first import."""
        found = {}
        for line, path in self.paths:
            if path[-1] == "*":
                other = self.find(path[:-1])
                others = [other] + [other.find(p) for p in other.uses.values()] if other else []
            else:
                others = [self.find(path)]
            for other in others:
                if other and other is not self and other.holds_code:
                    found.setdefault(other, line)
        return found


def crate(folder):
    """Returns the modules of the crate in `folder`, of a library and a program together."""
    roots = (folder / "src/lib.rs", folder / "src/main.rs")
    return [m for root in roots if root.exists() for m in Module(root, Path(folder / "src")).all()]
