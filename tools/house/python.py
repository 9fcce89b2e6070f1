"""Reads the imports of a Python package as far as `check.py` needs."""

import ast


class Module:
    """A file of a package, with the names of the files that it imports by a relative import."""

    holds_code = True

    def __init__(self, file):
        self.file, self.package = file, {}
        self.lines = {}
        for node in ast.walk(ast.parse(file.read_text())):
            if isinstance(node, ast.ImportFrom) and node.level == 1:
                names = [node.module] if node.module else [alias.name for alias in node.names]
                for name in names:
                    self.lines.setdefault(name, node.lineno)

    def imports(self):
        """Returns the modules that this one imports, each with the line of the first import."""
        return {self.package[name]: line for name, line in self.lines.items()
                if name in self.package}


def package(folder):
    """Returns the modules of the package in `folder`; `__init__.py` imports all of them."""
    modules = {file.stem: Module(file) for file in sorted(folder.glob("*.py"))}
    for module in modules.values():
        module.package = modules
    return list(modules.values())
