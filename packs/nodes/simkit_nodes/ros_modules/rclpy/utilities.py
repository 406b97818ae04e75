"""Default context, and functions about contexts and arguments."""

from __future__ import annotations

import sys
from collections.abc import Sequence

from simkit_nodes.host import current_program
from simkit_nodes.ros_modules.rclpy.constants import S_TO_NS
from simkit_nodes.ros_modules.rclpy.context import Context, parse_arguments

__all__ = [
    "get_available_rmw_implementations",
    "get_default_context",
    "get_rmw_implementation_identifier",
    "ok",
    "remove_ros_args",
    "shutdown",
    "timeout_sec_to_nsec",
    "try_shutdown",
]

_KEY = "rclpy.default_context"


def get_default_context(*, shutting_down: bool = False) -> Context:
    """Return the default context of the program.

    Args:
        shutting_down: True if the next call shall return a new context.
    """
    data = current_program().data
    context: Context | None = data.get(_KEY)
    if context is None:
        context = data[_KEY] = Context()
    if shutting_down:
        del data[_KEY]
    return context


def remove_ros_args(args: Sequence[str] | None = None) -> list[str]:
    """Return the arguments that are not for ROS; those of `sys.argv` for None."""
    return parse_arguments(sys.argv if args is None else args).others


def ok(*, context: Context | None = None) -> bool:
    """Check whether a context, or else the default context, has begun and has not ended."""
    return (get_default_context() if context is None else context).ok()


def shutdown(*, context: Context | None = None) -> None:
    """End a context, or else the default context."""
    (get_default_context(shutting_down=True) if context is None else context).shutdown()


def try_shutdown(*, context: Context | None = None) -> None:
    """End a context, or else the default context, unless it has ended before."""
    if context is not None:
        context.try_shutdown()
        return
    get_default_context().try_shutdown()
    get_default_context(shutting_down=True)


def get_rmw_implementation_identifier() -> str:
    """Return the name of the middleware; there is none but simkit."""
    return "rmw_simkit"


def get_available_rmw_implementations() -> set[str]:
    """Return the names of the middlewares."""
    return {get_rmw_implementation_identifier()}


def timeout_sec_to_nsec(timeout_sec: float | None) -> int:
    """Convert a timeout from s to ns; -1 for None and for negative timeouts, which never end."""
    return -1 if timeout_sec is None or timeout_sec < 0 else int(float(timeout_sec) * S_TO_NS)
