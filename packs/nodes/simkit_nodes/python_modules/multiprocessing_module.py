"""Module `multiprocessing` of a program: its processes are threads, as in `multiprocessing.dummy`."""

from __future__ import annotations

from types import ModuleType
from typing import TYPE_CHECKING, Any, Final

from simkit_nodes.python_modules import program_module

if TYPE_CHECKING:
    from simkit_nodes.programs import NodeProgram

_NAMES: Final = (
    "Array",
    "Barrier",
    "BoundedSemaphore",
    "Condition",
    "Event",
    "JoinableQueue",
    "Lock",
    "Manager",
    "Pipe",
    "Pool",
    "Queue",
    "RLock",
    "Semaphore",
    "Value",
    "active_children",
    "current_process",
    "freeze_support",
)


def adapt(module: ModuleType, program: NodeProgram) -> None:
    """Replace all that would start a process."""
    dummy = program_module(program, "multiprocessing.dummy")

    class Process(dummy.Process):  # type: ignore[misc, name-defined]
        """Thread with the methods of a process."""

        pid = property(lambda self: self.ident)

        def start(self) -> None:
            """Start the thread, and tell that it is no process."""
            program.tell("SK-NODE-058")
            super().start()

        def terminate(self) -> None:
            """Do nothing: threads cannot be ended from outside."""

        kill = close = terminate

    names: dict[str, Any] = {name: getattr(dummy, name) for name in _NAMES}
    names.update(Process=Process, SimpleQueue=dummy.Queue, RawValue=dummy.Value, RawArray=dummy.Array)
    names.update(
        get_context=lambda method=None: module,
        set_start_method=lambda method, force=False: None,
        get_start_method=lambda allow_none=False: "fork",
        get_all_start_methods=lambda: ["fork"],
        parent_process=lambda: None,
    )
    vars(module).update(names)
