"""Module `_queue` of a program: the exception of an empty queue; the queue in C would wait in wall time."""

from __future__ import annotations

from types import ModuleType
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from simkit_nodes.programs import NodeProgram


def adapt(module: ModuleType, program: NodeProgram) -> None:
    """Remove the queue in C, so that `queue` uses its queue in Python."""
    del module.SimpleQueue
    module.original = None  # type: ignore[attr-defined]
