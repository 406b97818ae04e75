"""Module `concurrent.futures` of a program: all executors use threads, which are tasks."""

from __future__ import annotations

from types import ModuleType
from typing import TYPE_CHECKING, Any

from simkit_nodes.python_modules.threading_module import counted
from simkit_nodes.tasks import ProgramEnd, ProgramStuck

if TYPE_CHECKING:
    from logging import LogRecord

    from simkit_nodes.programs import NodeProgram


def adapt(module: ModuleType, program: NodeProgram) -> None:
    """Let the executor of processes start threads, and count questions to futures that do not wait."""

    def process_executor(max_workers: int | None = None, *args: object, **options: object) -> Any:
        program.tell("SK-NODE-058")
        names = ("initializer", "initargs")
        return module.ThreadPoolExecutor(max_workers, **{key: options[key] for key in names if key in options})

    module._base.LOGGER.addFilter(_is_of_program)
    module.ProcessPoolExecutor = process_executor  # type: ignore[attr-defined]
    for name in ("done", "running"):
        setattr(module.Future, name, counted(getattr(module.Future, name)))


def _is_of_program(record: LogRecord) -> bool:
    """Return False for the end of a program, which an idle thread of an executor logs as an exception."""
    return record.exc_info is None or not isinstance(record.exc_info[1], (ProgramEnd, ProgramStuck))
