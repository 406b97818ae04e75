"""Deprecated names: one kind of warning, which says what replaces a name and when the name goes."""

from __future__ import annotations

import warnings
from typing import Final

_MINOR_VERSIONS: Final = 2  # how many minor versions a deprecated name still works for, the first one included


class SimkitDeprecationWarning(DeprecationWarning):
    """Warning about a name of simkit that a later version will not have."""


def removal_version(since: str) -> str:
    """Return the first version without a name that is deprecated since a version, both as `MAJOR.MINOR`."""
    major, minor = map(int, since.split("."))
    return f"{major}.{minor + _MINOR_VERSIONS}"


def warn_deprecated(old: str, new: str, *, since: str, stacklevel: int = 2) -> None:
    """Warn that a name is deprecated.

    Args:
        old: deprecated name or call.
        new: what to write instead.
        since: version that deprecated it, as `MAJOR.MINOR`.
        stacklevel: frame that the warning names; 2 is the caller of the function that calls this one.
    """
    text = f"{old} is deprecated since simkit {since} and will be removed in {removal_version(since)}: use {new}"
    warnings.warn(text, SimkitDeprecationWarning, stacklevel=stacklevel + 1)
