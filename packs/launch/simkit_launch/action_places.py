"""Places in launch files: the line that made an action, for messages."""

from __future__ import annotations

import os
import sys
from collections.abc import Iterator
from contextlib import contextmanager
from functools import cache
from types import FrameType
from typing import Final

from simkit.diagnostics import NOWHERE, Where
from simkit.packs import is_shipped_file

_PLACES: Final[list[Where]] = []
_LIBRARY: Final = os.path.dirname(os.__file__) + os.sep  # noqa: PTH120 - it may be a zip file


@contextmanager
def made_at(where: Where) -> Iterator[None]:
    """Give all actions that are made inside a place, such as an element of an XML file."""
    _PLACES.append(where)
    try:
        yield
    finally:
        _PLACES.pop()


def calling_place() -> Where:
    """Return the place of `made_at`, else the line of the innermost frame outside simkit and Python's library."""
    if _PLACES:
        return _PLACES[-1]
    frame: FrameType | None = sys._getframe(1)
    while frame is not None:
        file = frame.f_code.co_filename
        if not _is_internal(file):
            return Where(file, frame.f_lineno)
        frame = frame.f_back
    return NOWHERE


@cache
def _is_internal(file: str) -> bool:
    return file.startswith((_LIBRARY, "<")) or (is_shipped_file(file) and not file.endswith(".launch.py"))
