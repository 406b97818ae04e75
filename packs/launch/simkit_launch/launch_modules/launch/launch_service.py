"""Execution of launch descriptions by a script."""

from __future__ import annotations

from collections.abc import Iterable
from typing import TYPE_CHECKING

from simkit_launch.planner import current_planner

if TYPE_CHECKING:
    from simkit_launch.launch_modules.launch.event import Event
    from simkit_launch.launch_modules.launch.launch_context import LaunchContext
    from simkit_launch.launch_modules.launch.launch_description import LaunchDescription

__all__ = ["LaunchService"]


class LaunchService:
    """Execution of launch descriptions.

    Args:
        argv: command line.
        noninteractive: True without a terminal.
        debug: accepted.
    """

    def __init__(self, *, argv: Iterable[str] | None = None, noninteractive: bool = False, debug: bool = False) -> None:
        del debug, noninteractive
        self._context: LaunchContext = current_planner().service_context(list(argv or ()))
        self._descriptions: list[LaunchDescription] = []

    @property
    def context(self) -> LaunchContext:
        """State of the execution."""
        return self._context

    @property
    def event_loop(self) -> None:
        """None: nothing runs in the background while a launch file is executed."""
        return

    @property
    def task(self) -> None:
        """None: nothing runs in the background while a launch file is executed."""
        return

    def emit_event(self, event: Event) -> None:
        """Emit an event."""
        self._context.emit_event_sync(event)

    def include_launch_description(self, launch_description: LaunchDescription) -> None:
        """Add a launch description, which `run` executes."""
        self._descriptions.append(launch_description)

    def run(self, *, shutdown_when_idle: bool = True) -> int:
        """Execute the launch descriptions; return the exit code 0."""
        del shutdown_when_idle
        descriptions, self._descriptions = self._descriptions, []
        for each in descriptions:
            current_planner().execute(each, self._context)
        return 0

    async def run_async(self, *, shutdown_when_idle: bool = True) -> int:
        """Execute the launch descriptions; return the exit code 0."""
        return self.run(shutdown_when_idle=shutdown_when_idle)

    def shutdown(self, force_sync: bool = False) -> None:
        """Do nothing: the launch ends with the run."""
