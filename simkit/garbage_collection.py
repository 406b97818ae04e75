"""Pauses of Python's garbage collector while many objects are created that stay."""

from __future__ import annotations

import gc
import sys
from collections.abc import Iterator
from contextlib import contextmanager


@contextmanager
def no_collection() -> Iterator[None]:
    """Disable the garbage collector during a load or an import.

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


@contextmanager
def permanent_imports() -> Iterator[None]:
    """Import modules of a command; the garbage collector never scans their objects.

    A run imports 700 modules. To scan their functions and classes took 0.05 s while they were imported and 0.07 s at
    the end of the process. Only the command line may use this function: in a program of the user, garbage of other
    code would stay too. Without a new module, nothing is kept.
    """
    count = len(sys.modules)
    with no_collection():
        try:
            yield
        finally:
            if len(sys.modules) > count:
                gc.freeze()
