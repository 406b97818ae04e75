"""Lists of names in parameters, such as `controller_plugins`."""

from __future__ import annotations

from collections.abc import Iterable


def split_names(texts: Iterable[str]) -> list[str]:
    """Return the names in repeated elements; an element may contain several names."""
    return [name for text in texts for name in text.replace(",", " ").split()]
