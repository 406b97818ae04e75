"""Replacement of gz-common's Python module: only the verbosity, which sets the level of simkit's log."""

from __future__ import annotations

import logging
from typing import Final, NoReturn

from simkit_gz_python.math.missing_names import missing_name_error

_LEVELS: Final = (logging.CRITICAL, logging.ERROR, logging.WARNING, logging.INFO, logging.DEBUG)
_level = 1

__all__ = ["set_verbosity", "verbosity"]


def set_verbosity(level: int) -> None:
    """Set the verbosity: 0 logs critical errors only, 1 also errors, 2 also warnings, 3 also messages, 4 everything."""
    global _level
    _level = max(0, min(4, int(level)))
    logging.getLogger("simkit").setLevel(_LEVELS[_level])


def verbosity() -> int:
    """Return the verbosity, from 0 to 4."""
    return _level


def __getattr__(name: str) -> NoReturn:
    raise missing_name_error("gz.common", name, __all__)
