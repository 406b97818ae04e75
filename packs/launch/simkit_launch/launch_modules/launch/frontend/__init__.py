"""Names of the package that reads XML and YAML; extensions of it have no effect here."""

from __future__ import annotations

from collections.abc import Callable
from typing import TypeVar

__all__ = ["Entity", "Parser", "expose_action", "expose_substitution"]

_Class = TypeVar("_Class")


class Entity:
    """Element of an XML or YAML file."""


class Parser:
    """Reader of an XML or YAML file."""


def expose_action(name: str) -> Callable[[_Class], _Class]:
    """Return a decorator that returns its class."""
    del name
    return lambda cls: cls


def expose_substitution(name: str) -> Callable[[_Class], _Class]:
    """Return a decorator that returns its class."""
    del name
    return lambda cls: cls
