"""Entry points of all installed distributions.

`importlib.metadata` takes 10 ms to import, and `simkit.packs` does without: a command for a running simulation imports
packs, but needs no other entry points.
"""

from __future__ import annotations

import sys
from functools import lru_cache
from importlib.metadata import EntryPoint, entry_points
from pathlib import Path
from typing import Any


def entry_points_of(group: str) -> list[EntryPoint]:
    """Return the entry points of a group.

    Reading all entry points takes 20 ms, so they are cached until a folder of `sys.path` changes.
    """
    state = tuple((folder, _folder_time(Path(folder))) for folder in sys.path)
    return list(_all_entry_points(state).select(group=group))


@lru_cache(maxsize=1)
def _all_entry_points(_state: tuple[tuple[str, int], ...]) -> Any:  # its type differs between Python 3.11 and 3.12
    return entry_points()


def _folder_time(folder: Path) -> int:
    """Return the time at which an entry of a folder was last added or removed [ns]; 0 if there is no folder."""
    try:
        return folder.stat().st_mtime_ns
    except OSError:
        return 0
