"""Substitution that is the output of a command."""

from __future__ import annotations

import shlex
from typing import TYPE_CHECKING

from simkit_launch.launch_modules.launch.substitution import Substitution
from simkit_launch.launch_modules.launch.utilities import normalize_to_list_of_substitutions, perform_substitutions

if TYPE_CHECKING:
    from simkit_launch.launch_modules.launch.launch_context import LaunchContext
    from simkit_launch.launch_modules.launch.some_substitutions_type import SomeSubstitutionsType

__all__ = ["Command"]


class Command(Substitution):
    """Output of a command: `xacro`, `cat` and `echo` are computed here, and no other command is run.

    Args:
        command: command line.
        on_stderr: accepted: what ROS does with the error output.
    """

    def __init__(self, command: SomeSubstitutionsType, *, on_stderr: SomeSubstitutionsType = "fail") -> None:
        self._command = normalize_to_list_of_substitutions(command)
        self._on_stderr = normalize_to_list_of_substitutions(on_stderr)

    @property
    def command(self) -> list[Substitution]:
        """Command line."""
        return self._command

    @property
    def on_stderr(self) -> list[Substitution]:
        """Treatment of the error output in ROS."""
        return self._on_stderr

    def describe(self) -> str:
        """Return a description of the substitution."""
        return f"Command({' + '.join(sub.describe() for sub in self.command)})"

    def perform(self, context: LaunchContext) -> str:
        """Return the output of the command."""
        return context.planner.command_output(shlex.split(perform_substitutions(context, self.command)))
