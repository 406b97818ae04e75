"""Pause of Python's garbage collector during a load."""

from __future__ import annotations

import gc
from collections.abc import Iterator
from contextlib import contextmanager


@contextmanager
def no_collection() -> Iterator[None]:
    """Disable the garbage collector during a load.

    A load creates hundreds of thousands of objects and keeps nearly all of them. Scanning them repeatedly took one
    seventh of the load time of 3000 models.
    """
    was_on = gc.isenabled()
    gc.disable()
    try:
        yield
    finally:
        if was_on:
            gc.enable()
