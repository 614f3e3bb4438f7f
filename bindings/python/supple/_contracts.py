"""The documentation of functions: that of the C++ headers, with what is different in Python."""

from __future__ import annotations

import inspect
import textwrap
from typing import Callable, TypeVar

from ._generated import CONTRACTS

Function = TypeVar("Function", bound=Callable[..., object])


def contract(name: str, in_python: str = "") -> Callable[[Function], Function]:
    """Gives a function the contract of the C++ function `name` and marks it as its twin."""

    def document(function: Function) -> Function:
        paragraphs = [textwrap.fill(part, 100) for part in CONTRACTS[name].split("\n\n")]
        if in_python:
            paragraphs.append(textwrap.fill("In Python: " + " ".join(in_python.split()), 100))
        function.__doc__ = "\n\n".join(paragraphs)
        function.__dict__["cpp"] = name
        return function

    return document


def twins(namespace: object) -> dict[str, str]:
    """The C++ functions that the functions of a class or module stand for, with their Python names."""
    return {
        each.__dict__["cpp"]: name
        for name, each in inspect.getmembers(namespace, inspect.isfunction)
        if "cpp" in each.__dict__
    }
