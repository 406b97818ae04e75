"""Which topics somebody means."""

from __future__ import annotations

import fnmatch
from collections.abc import Iterable


def fits(topic: str, patterns: Iterable[str]) -> bool:
    """Whether a topic is meant by one of the shell patterns; `scan` and `/scan` are the same."""
    return any(fnmatch.fnmatchcase(topic, p if p.startswith(("/", "*")) else f"/{p}") for p in patterns)
