"""Imports of modules that a program shares with the process."""

from __future__ import annotations

from collections.abc import Iterator
from contextlib import contextmanager
from importlib import import_module
from types import ModuleType


class SharedImports:
    """Imports of modules of the process or of simkit, whose own imports are not the program's.

    A folder of a program may contain the packages of the process too, as a project with a virtual environment does.

    Attributes:
        are_active: True during such an import.
    """

    are_active = False

    @classmethod
    @contextmanager
    def active(cls) -> Iterator[None]:
        """Mark imports within the context as those of the process."""
        before, cls.are_active = cls.are_active, True
        try:
            yield
        finally:
            cls.are_active = before


def import_shared(name: str) -> ModuleType:
    """Import and return a module of the process or of simkit by its dotted name."""
    with SharedImports.active():
        return import_module(name)
