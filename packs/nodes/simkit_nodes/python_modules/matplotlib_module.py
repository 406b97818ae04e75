"""Modules `matplotlib` and `matplotlib.pyplot` of a program: figures are drawn but not shown."""

from __future__ import annotations

import sys
from types import ModuleType
from typing import TYPE_CHECKING

from simkit_nodes.host import current_host
from simkit_nodes.python_modules.time_module import sleep

if TYPE_CHECKING:
    from simkit_nodes.programs import NodeProgram


def adapt(module: ModuleType, program: NodeProgram) -> None:
    """Draw in memory, and let the functions that wait for a window wait in simulated time."""
    if module.__name__ == "matplotlib":
        if "matplotlib.pyplot" not in sys.modules:  # a change closes the figures of the process
            module.original.use("Agg")
        module.use = lambda *args, **options: None  # type: ignore[attr-defined]
        return

    def show(*args: object, block: bool | None = None, **options: object) -> None:
        if block is not False and not module.isinteractive():
            current_host().wait()  # a window that nobody closes

    def pause(interval: float) -> None:
        sleep(interval)

    vars(module).update(show=show, pause=pause, switch_backend=lambda backend: None)
