"""Docstrings: one entry for each argument, so that the reference has the type of each."""

from __future__ import annotations

import ast
import dataclasses
import inspect
import re
import textwrap
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import pytest

import reachtube as rt

#: A section, up to the heading of the next.
SECTION = re.compile(r"^(\w+)\n-+\n((?:(?!^[^\s][^\n]*\n-+$)[^\n]*\n?)*)", re.MULTILINE)
ENTRY = re.compile(r"^(\S.*)$", re.MULTILINE)

#: Classes that functions return, and that users do not make.
RETURNED = {
    "Abstraction", "BuiltModel", "Check", "Identification", "Model", "Monitor", "Report", "Robot",
    "StopStudy", "SystemCheck", "SystemModel", "TrackingCheck", "TrackingModel", "Verification",
}


def public() -> Iterator[tuple[str, Any]]:
    """Yield names and objects: all that the reference shows, and what classes inherit."""
    from reachtube import plot

    for module in (rt, rt.errors, rt.fleet, rt.io, plot):
        # Modules without __all__ show what they define.
        names = getattr(module, "__all__", None) or [n for n in vars(module) if n[0] != "_"]
        for name in names:
            value = getattr(module, name)
            if inspect.ismodule(value) or not is_own(value):
                continue
            yield f"{module.__name__}.{name}", value
            if inspect.isclass(value):
                for own in dir(value):
                    if not own.startswith("_") and callable(getattr(value, own)):
                        if is_own(getattr(value, own)):
                            yield f"{module.__name__}.{name}.{own}", getattr(value, own)


def is_own(value: Any) -> bool:
    """Return whether a value is defined in the package."""
    return str(getattr(value, "__module__", "")).startswith("reachtube")


def sections(value: Any) -> dict[str, str]:
    """Return the body of each section of a docstring by its heading."""
    return dict(SECTION.findall(inspect.cleandoc(value.__doc__ or "")))


def entries(value: Any) -> dict[str, list[str]]:
    """Return the names before the colon of each argument or attribute, by section."""
    return {
        section: [line.split(" : ")[0].strip() for line in ENTRY.findall(body)]
        for section, body in sections(value).items()
        if section in ("Parameters", "Attributes")
    }


def arguments(value: Any) -> list[str]:
    """Return the names of the arguments that a caller gives."""
    return [own for own in inspect.signature(value).parameters if own not in ("self", "cls")]


def is_made_of_fields(value: Any) -> bool:
    """Return whether a class is a dataclass or a named tuple."""
    return dataclasses.is_dataclass(value) or issubclass(value, tuple)


def fields_of(value: Any) -> list[str]:
    """Return the public fields of a dataclass or a named tuple."""
    fields = getattr(value, "_fields", None) or [own.name for own in dataclasses.fields(value)]
    return [name for name in fields if not name.startswith("_")]


def described_below(value: Any) -> list[str]:
    """Return the fields of a class that have a docstring of their own below them."""
    [tree] = ast.parse(textwrap.dedent(inspect.getsource(value))).body
    assert isinstance(tree, ast.ClassDef)
    return [
        field.target.id
        for field, text in zip(tree.body, tree.body[1:], strict=False)
        if isinstance(field, ast.AnnAssign)
        and isinstance(field.target, ast.Name)
        and isinstance(text, ast.Expr)
        and isinstance(text.value, ast.Constant)
    ]


def needed(value: Any) -> list[str]:
    """Return the sections that a docstring needs. A function without arguments needs none: its
    first line has what it returns."""
    if inspect.isclass(value):
        is_made = not is_made_of_fields(value) and not issubclass(value, Exception)
        return ["Parameters"] if is_made and value.__name__ not in RETURNED else []
    if not arguments(value):
        return []
    is_procedure = inspect.signature(value).return_annotation in ("None", None)
    return ["Parameters"] if is_procedure else ["Parameters", "Returns"]


EVERYTHING = [pytest.param(*item, id=item[0]) for item in public()]


@pytest.mark.parametrize("name, value", EVERYTHING)
def test_each_argument_has_an_entry_of_its_own(name: str, value: Any) -> None:
    found = entries(value)
    for entry in [entry for section in found.values() for entry in section]:
        assert re.fullmatch(r"\w+", entry), f"{name}: {entry!r} is not one name"
    if "Parameters" in found:
        assert found["Parameters"] == arguments(value)


@pytest.mark.parametrize("name, value", EVERYTHING)
def test_arguments_and_results_are_described(name: str, value: Any) -> None:
    found = sections(value)
    missing = [section for section in needed(value) if not found.get(section, "").strip()]
    assert not missing, f"{name} has no section {' and no section '.join(missing)}"


@pytest.mark.parametrize("name, value", EVERYTHING)
def test_fields_are_described(name: str, value: Any) -> None:
    if inspect.isclass(value) and is_made_of_fields(value):
        described = entries(value).get("Attributes") or described_below(value)
        assert described == fields_of(value), name


def test_everything_public_is_in_the_reference() -> None:
    page = (Path(__file__).parents[2] / "docs/python-api.md").read_text(encoding="utf-8")
    shown = set(re.findall(r"^::: reachtube\.(\w+)$", page, re.MULTILINE))
    # The module of the errors shows all of them.
    assert {"errors", "model"} <= shown
    assert [name for name in rt.__all__ if name not in shown | set(vars(rt.errors))] == []


def test_what_is_missing_is_found() -> None:
    def grouped(a: int, b: int, c: int) -> None:
        """Do it.

        Parameters
        ----------
        a, b : int
            Both.
        c
            Another.

        Returns
        -------
        None
        """

    def bare(a: int) -> int:
        """Return a."""
        return a

    @dataclasses.dataclass
    class Pair:
        """A pair."""

        first: int
        """The first."""
        second: int

    assert entries(grouped) == {"Parameters": ["a, b", "c"]}
    assert set(sections(grouped)) == {"Parameters", "Returns"}
    assert needed(grouped) == ["Parameters"] and sections(bare) == {}
    assert needed(bare) == ["Parameters", "Returns"]
    assert described_below(Pair) == ["first"] and fields_of(Pair) == ["first", "second"]
