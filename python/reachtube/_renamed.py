"""Arguments that had another name in earlier versions."""

from __future__ import annotations

import functools
from collections.abc import Callable
from typing import ParamSpec, TypeVar

Given = ParamSpec("Given")
Result = TypeVar("Result")


def renamed(**names: str) -> Callable[[Callable[Given, Result]], Callable[Given, Result]]:
    """Name the new argument in the error about an old one.

    The function is called one frame further down, which levels of warnings count.
    """

    def named(function: Callable[Given, Result]) -> Callable[Given, Result]:
        @functools.wraps(function)
        def call(*args: Given.args, **kwargs: Given.kwargs) -> Result:
            for old, new in names.items():
                if old in kwargs:
                    raise TypeError(f"{function.__name__}(): {old} is now {new}")
            return function(*args, **kwargs)

        return call

    return named
