"""Module `os` of a program: it cannot end the process of the simulation, and random bytes follow the run's seed."""

from __future__ import annotations

import os as _python
from collections.abc import Callable, Iterable
from typing import Any, NoReturn

from simkit_nodes.host import current_program
from simkit_nodes.python_modules.signal_module import deliver
from simkit_nodes.tasks import ProgramEnd

__all__ = ["_exit", "abort", "isatty", "kill", "popen", "read", "register_at_fork", "system", "urandom"]

_STANDARD_INPUT = 0


def _exit(status: int) -> NoReturn:
    """End the program at once."""
    program = current_program()
    program.note_exit(status)
    program.is_exiting = True
    raise ProgramEnd


def abort() -> NoReturn:
    """End the program at once, as after an error."""
    _exit(134)


def kill(pid: int, number: int) -> None:
    """Send a signal; one to the present process goes to the program alone."""
    if pid == _python.getpid():
        deliver(number)
    else:
        _python.kill(pid, number)


def urandom(size: int) -> bytes:
    """Return bytes that follow from the run's seed."""
    program = current_program()
    program.tell("SK-NODE-050")
    return program.random.randbytes(size)


def read(file: int, size: int) -> bytes:
    """Read bytes of a file; those of the standard input are the program's."""
    if file == _STANDARD_INPUT:
        return current_program().stdin.read_some(size).encode()
    return _python.read(file, size)


def isatty(file: int) -> bool:
    """Return whether a file is a terminal."""
    return current_program().stdin.isatty() if file == _STANDARD_INPUT else _python.isatty(file)


def system(command: str) -> int:
    """Run a command of the shell, while simulated time stands still."""
    current_program().tell("SK-NODE-052")
    return _python.system(command)


def popen(command: str, mode: str = "r", buffering: int = -1) -> Any:
    """Run a command of the shell, and return a file with its output or for its input."""
    current_program().tell("SK-NODE-052")
    return _python.popen(command, mode, buffering)


def register_at_fork(**functions: Callable[[], object] | Iterable[Any]) -> None:
    """Do nothing: the process of the simulation is not copied for a program."""
