"""Docstrings: one entry for each argument, so that the reference has the type of each."""

from __future__ import annotations

import inspect
import re
from collections.abc import Iterator
from typing import Any

import pytest

import reachtube as rt

#: A section of arguments or attributes, up to the heading of the next.
SECTION = re.compile(
    r"^(Parameters|Attributes)\n-+\n((?:(?!^[^\s][^\n]*\n-+$)[^\n]*\n?)*)", re.MULTILINE
)
ENTRY = re.compile(r"^(\S.*)$", re.MULTILINE)


def public() -> Iterator[tuple[str, Any]]:
    """Yield the name and the object of everything that the reference shows."""
    from reachtube import plot

    for module in (rt, rt.errors, rt.fleet, rt.io, plot):
        # Modules without __all__ show what they define.
        names = getattr(module, "__all__", None) or [n for n in vars(module) if n[0] != "_"]
        for name in names:
            value = getattr(module, name)
            if inspect.ismodule(value) or not str(getattr(value, "__module__", "")).startswith(
                "reachtube"
            ):
                continue
            yield f"{module.__name__}.{name}", value
            if inspect.isclass(value):
                for own, member in vars(value).items():
                    if not own.startswith("_") and callable(getattr(value, own)):
                        yield f"{module.__name__}.{name}.{own}", getattr(value, own)


def entries(value: Any) -> dict[str, list[str]]:
    """Return the names before the colon of each entry, by section."""
    text = inspect.cleandoc(value.__doc__ or "")
    sections = {}
    for section, body in SECTION.findall(text):
        sections[section] = [line.split(" : ")[0].strip() for line in ENTRY.findall(body)]
    return sections


@pytest.mark.parametrize("name, value", [pytest.param(*item, id=item[0]) for item in public()])
def test_each_argument_has_an_entry_of_its_own(name: str, value: Any) -> None:
    sections = entries(value)
    for entry in [entry for section in sections.values() for entry in section]:
        assert re.fullmatch(r"\w+", entry), f"{name}: {entry!r} is not one name"
    if "Parameters" in sections:
        arguments = list(inspect.signature(value).parameters)
        assert sections["Parameters"] == [own for own in arguments if own not in ("self", "cls")]


def test_a_grouped_argument_is_found() -> None:
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

    assert entries(grouped) == {"Parameters": ["a, b", "c"]}
