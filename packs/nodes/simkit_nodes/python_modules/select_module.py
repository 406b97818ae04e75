"""Module `select` of a program: it waits for files in simulated time, and knows the program's standard input."""

from __future__ import annotations

import math
import select as _python
from collections.abc import Callable, Iterable
from types import ModuleType
from typing import TYPE_CHECKING, Any

from simkit_nodes.host import current_program
from simkit_nodes.python_modules import unbound
from simkit_nodes.python_modules.thread_module import wait_for
from simkit_nodes.tasks import current_task

if TYPE_CHECKING:
    from simkit_nodes.program_streams import ProgramInput
    from simkit_nodes.programs import NodeProgram

__all__ = ["select"]


def _wait(ask: Callable[[], object], timeout: float | None, stdin: ProgramInput | None = None) -> Any:
    """Wait until a question to the operating system has an answer that is not empty, and return the answer.

    Args:
        ask: function that returns the answer without waiting.
        timeout: longest duration [s] of simulated time; None for no limit.
        stdin: standard input, if the answer depends on it.
    """
    task = current_task()
    answer = ask()
    if not answer and timeout == 0 and task is not None:
        task.poll()
    left = math.inf if timeout is None else timeout
    while not answer and left > 0:
        pause = min(left, math.inf if stdin is None else stdin.seconds_to_key)
        wait_for(lambda: bool(ask()), -1.0 if pause == math.inf else pause)
        answer, left = ask(), left - pause
    return answer


def _is_standard_input(file: Any) -> bool:
    return file == 0 or (current_task() is not None and file is current_program().stdin)


def select(
    readable: Iterable[Any], writable: Iterable[Any], exceptional: Iterable[Any], timeout: float | None = None
) -> tuple[list[Any], list[Any], list[Any]]:
    """Wait until files are ready, at most for a duration [s] of simulated time."""
    readable, writable, exceptional = list(readable), list(writable), list(exceptional)
    inputs = [file for file in readable if _is_standard_input(file)]
    others = [file for file in readable if file not in inputs]
    stdin = current_program().stdin if inputs else None

    def ask() -> tuple[list[Any], list[Any], list[Any]] | None:
        ready = inputs if stdin is not None and stdin.has_input else []
        real = _python.select(others, writable, exceptional, 0.0) if others or writable or exceptional else ([], [], [])
        result = ready + real[0], real[1], real[2]
        return result if any(result) else None

    return _wait(ask, timeout, stdin) or ([], [], [])


class _Poller:
    """Object of the operating system that waits for files; here it waits in simulated time."""

    def __init__(self, poller: Any, unit: float) -> None:
        self._poller, self._unit = poller, unit

    def poll(self, timeout: float | None = None, *args: Any) -> Any:
        """Wait until files are ready; the unit of the time is that of the object in Python."""
        seconds = None if timeout is None or timeout < 0 else timeout * self._unit
        return _wait(lambda: self._poller.poll(0, *args), seconds)

    def control(self, changes: Any, max_events: int, timeout: float | None = None) -> Any:
        """Change the events of a queue of the kernel, and wait for events."""
        if changes is not None:
            self._poller.control(changes, 0, 0)
        return _wait(lambda: self._poller.control(None, max_events, 0), timeout) if max_events else []

    def __enter__(self) -> _Poller:
        return self

    def __exit__(self, *_: object) -> None:
        self._poller.close()

    def __getattr__(self, name: str) -> Any:
        return getattr(self._poller, name)


def adapt(module: ModuleType, program: NodeProgram) -> None:
    """Replace the objects of the operating system that wait."""
    for name, unit in (("poll", 1e-3), ("epoll", 1.0), ("devpoll", 1e-3), ("kqueue", 1.0)):
        make = getattr(_python, name, None)
        if make is not None:
            setattr(module, name, unbound(_maker(make, unit)))


def _maker(make: Callable[..., object], unit: float) -> Callable[..., _Poller]:
    return lambda *args, **options: _Poller(make(*args, **options), unit)
