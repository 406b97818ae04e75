"""Module `atexit` of a program: its functions are called at the end of the program."""

from __future__ import annotations

from collections.abc import Callable

from simkit_nodes.host import current_program

__all__ = ["_clear", "_ncallbacks", "_run_exitfuncs", "register", "unregister"]


def register(function: Callable[..., object], /, *args: object, **kwargs: object) -> Callable[..., object]:
    """Register a function that is called at the end of the program, and return the function."""
    current_program().exit_functions.append((function, args, kwargs))
    return function


def unregister(function: Callable[..., object], /) -> None:
    """Remove a function from those that are called at the end of the program."""
    functions = current_program().exit_functions
    functions[:] = [entry for entry in functions if entry[0] != function]


def _run_exitfuncs() -> None:
    current_program().call_exit_functions()


def _clear() -> None:
    current_program().exit_functions.clear()


def _ncallbacks() -> int:
    return len(current_program().exit_functions)
