"""Module `queue` of a program: Python's own, with a count of questions that do not wait."""

from __future__ import annotations

from types import ModuleType
from typing import TYPE_CHECKING

from simkit_nodes.python_modules.threading_module import counted

if TYPE_CHECKING:
    from simkit_nodes.programs import NodeProgram


def adapt(module: ModuleType, program: NodeProgram) -> None:
    """Count the questions of a loop that waits for a queue without a pause."""
    for cls in (module.Queue, module.SimpleQueue):
        for name in ("empty", "full", "get_nowait", "put_nowait", "qsize"):
            if name in vars(cls):
                setattr(cls, name, counted(getattr(cls, name)))
