"""Module `concurrent.futures` of a program: all executors use threads, which are tasks."""

from __future__ import annotations

from types import ModuleType
from typing import TYPE_CHECKING, Any

if TYPE_CHECKING:
    from simkit_nodes.programs import NodeProgram

from simkit_nodes.python_modules.threading_module import counted


def adapt(module: ModuleType, program: NodeProgram) -> None:
    """Let the executor of processes start threads, and count questions to futures that do not wait."""

    def process_executor(max_workers: int | None = None, *args: object, **options: object) -> Any:
        program.tell("SK-NODE-058")
        names = ("initializer", "initargs")
        return module.ThreadPoolExecutor(max_workers, **{key: options[key] for key in names if key in options})

    module.ProcessPoolExecutor = process_executor  # type: ignore[attr-defined]
    for name in ("done", "running"):
        setattr(module.Future, name, counted(getattr(module.Future, name)))
