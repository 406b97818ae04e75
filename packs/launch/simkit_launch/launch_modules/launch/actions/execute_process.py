"""Actions that start a process."""

from __future__ import annotations

import os
from collections.abc import Iterable, Mapping
from pathlib import Path
from typing import TYPE_CHECKING, Any

from simkit_launch.any_output import AnyOutput
from simkit_launch.command_line import started_commands
from simkit_launch.launch_modules.launch.action import Action
from simkit_launch.launch_modules.launch.actions.group_action import GroupAction, IncludeLaunchDescription
from simkit_launch.launch_modules.launch.descriptions import Executable
from simkit_launch.launch_modules.launch.event_handlers import OnProcessExit
from simkit_launch.launch_modules.launch.events import ExecutionComplete
from simkit_launch.launch_modules.launch.events.process import ProcessExited, ProcessStarted, ProcessStdout
from simkit_launch.launch_modules.launch.launch_description_entity import LaunchDescriptionEntity
from simkit_launch.launch_modules.launch.substitution import Substitution
from simkit_launch.launch_modules.launch.utilities.type_utils import (
    normalize_typed_substitution,
    perform_typed_substitution,
)
from simkit_launch.launch_prefix import prefix_delay

if TYPE_CHECKING:
    from simkit_launch.launch_modules.launch.launch_context import LaunchContext
    from simkit_launch.launch_modules.launch.some_substitutions_type import SomeSubstitutionsType

__all__ = ["ExecuteLocal", "ExecuteProcess"]


class ExecuteLocal(Action):
    """Start of a process.

    Args:
        process_description: command line, folder and environment.
        shell: True for a command line of a shell.
        on_exit: items that are executed after the end of the process.
        respawn: True to start the process again after its end.
        respawn_delay: time after which it starts again [s].
        options: what decides about output, signals and terminals; it has no effect here.
    """

    def __init__(
        self,
        *,
        process_description: Executable,
        shell: bool = False,
        on_exit: Any = None,
        respawn: bool | SomeSubstitutionsType = False,
        respawn_delay: float | None = None,
        condition: Any = None,
        output: Any = "log",
        **options: Any,
    ) -> None:
        super().__init__(condition=condition)
        unknown = [name for name in options if name not in _OPTIONS]
        if unknown:
            raise TypeError(f"{type(self).__name__}.__init__() got an unexpected keyword argument {unknown[0]!r}")
        self._description, self._shell, self._on_exit, self._output = process_description, shell, on_exit, output
        self._respawn = normalize_typed_substitution(respawn, bool)
        self._respawn_delay = respawn_delay
        self._details: dict[str, Any] | None = None

    @property
    def process_description(self) -> Executable:
        """Command line, folder and environment."""
        return self._description

    @property
    def shell(self) -> bool:
        """True for a command line of a shell."""
        return self._shell

    @property
    def output(self) -> Any:
        """Destination of the output."""
        return self._output

    @property
    def process_details(self) -> dict[str, Any] | None:
        """Name, command line, folder and environment after the start; None before it."""
        return self._details

    @property
    def return_code(self) -> int | None:
        """Exit code of the process; None: it has not ended while the launch file is executed."""
        return None

    def get_sub_entities(self) -> list[LaunchDescriptionEntity]:
        """Return the items that are executed after the end of the process."""
        if isinstance(self._on_exit, LaunchDescriptionEntity):
            return [self._on_exit]
        return list(self._on_exit) if isinstance(self._on_exit, (list, tuple)) else []

    def prepare(self, context: LaunchContext) -> None:
        """Compute the command line, the folder and the environment."""
        description = self.process_description
        description.prepare(context, self)
        self._details = {
            "action": self,
            "name": description.final_name,
            "cmd": description.final_cmd,
            "cwd": description.final_cwd,
            "env": description.final_env,
        }

    def process_fields(self, context: LaunchContext) -> dict[str, Any]:
        """Return the fields of the process in the plan that are those of a command."""
        del context
        return {"kind": "command", "arguments": tuple(self.process_description.final_cmd or ())}

    def execute(self, context: LaunchContext) -> Iterable[LaunchDescriptionEntity] | None:
        """Add the process to the plan."""
        if self._details is not None:
            raise RuntimeError(f"ExecuteLocal action '{self._details['name']}': executed more than once")
        self.prepare(context)
        respawn = perform_typed_substitution(context, self._respawn, bool)
        planner = context.planner
        details: dict[str, Any] = self._details or {}
        prefix = " ".join(self.process_description.final_prefix)
        moment = planner.moment.after(prefix_delay(prefix, planner.shown_place(self.where), planner.plan.diagnostics))
        started, ended = None, moment
        includes: list[LaunchDescriptionEntity] = []
        for fields, variables in self._all_fields(context):
            include = self._nested_launch(fields, context)
            if include is not None:
                includes.append(include)
                continue
            with planner.at(ended if started else moment):
                fields["respawn_delay"] = float(self._respawn_delay or 0.0) if respawn else None
                process = planner.add(fields, self.where, {**(details["env"] or {}), **variables})
                details.setdefault("pid", process.number)
                started, ended = started or planner.started(process), planner.ended(process)
        details.setdefault("pid", 0)
        if self._on_exit is not None:
            context.register_event_handler(OnProcessExit(target_action=self, on_exit=self._on_exit))
        started = started or moment
        planner.handle(ProcessStarted(**details), context, started)
        planner.handle(ProcessStdout(text=AnyOutput(), **details), context, started)
        planner.handle(ProcessExited(returncode=0, **details), context, ended)
        planner.handle(ExecutionComplete(action=self), context, ended)
        return includes or None

    def _nested_launch(self, fields: Mapping[str, Any], context: LaunchContext) -> LaunchDescriptionEntity | None:
        """Return the inclusion of the launch file that `ros2 launch` starts; None for another command."""
        words = [word for word in fields.get("arguments", ()) if word]
        if fields["kind"] != "command" or [os.path.basename(word) for word in words[:2]] != ["ros2", "launch"]:  # noqa: PTH119
            return None
        files = [word for word in words[2:] if ":=" not in word and not word.startswith("-")]
        if not files:
            return None
        path = Path(files[0])
        if len(files) > 1:
            share = context.planner.share_folder(files[0])
            path = context.planner.source_of(share / "launch" / files[1])
        arguments = [(name, value) for word in words[2:] for name, is_set, value in [word.partition(":=")] if is_set]
        nested = IncludeLaunchDescription(str(path), launch_arguments=arguments)
        nested.where = self.where
        return GroupAction([nested], forwarding=False)

    def _all_fields(self, context: LaunchContext) -> list[tuple[dict[str, Any], dict[str, str]]]:
        """Return the fields of each process of the action, and the variables of the environment that it has more."""
        fields = self.process_fields(context)
        folder = self.process_description.final_cwd
        if fields["kind"] == "node":
            return [({**fields, "folder": None if folder is None else Path(folder)}, {})]
        found = []
        for command in started_commands(fields["arguments"], is_shell=self.shell):
            text = os.path.join(folder or "", command.folder)  # noqa: PTH118 - both may be empty
            place = Path(text) if text else None
            found.append(({**fields, "arguments": command.words, "folder": place}, command.variables))
        return found

    def complete(self, context: LaunchContext) -> None:
        """Do nothing: the action is complete when the process has ended."""

    def get_stdout(self) -> bytes:
        """Return an empty output: the process does not run yet."""
        return b""

    def get_stderr(self) -> bytes:
        """Return an empty output: the process does not run yet."""
        return b""


_OPTIONS = frozenset(
    (
        "sigterm_timeout",
        "sigkill_timeout",
        "emulate_tty",
        "output_format",
        "cached_output",
        "log_cmd",
        "respawn_max_retries",
    )
)


class ExecuteProcess(ExecuteLocal):
    """Start of a command.

    Args:
        cmd: words of the command line.
        prefix: words before the command line.
        name: name for messages.
        cwd: working directory.
        env: all variables of the environment.
        additional_env: variables that are added to the environment.
        kwargs: arguments of `ExecuteLocal`.
    """

    def __init__(
        self,
        *,
        cmd: Iterable[SomeSubstitutionsType],
        prefix: SomeSubstitutionsType | None = None,
        name: SomeSubstitutionsType | None = None,
        cwd: SomeSubstitutionsType | None = None,
        env: Mapping[Any, SomeSubstitutionsType] | None = None,
        additional_env: Mapping[Any, SomeSubstitutionsType] | None = None,
        **kwargs: Any,
    ) -> None:
        executable = Executable(cmd=cmd, prefix=prefix, name=name, cwd=cwd, env=env, additional_env=additional_env)
        super().__init__(process_description=executable, **kwargs)

    @property
    def name(self) -> Any:
        """Name for messages."""
        details = self.process_details
        return details["name"] if details is not None else self.process_description.name

    @property
    def cmd(self) -> list[list[Substitution]]:
        """Words of the command line."""
        return self.process_description.cmd

    @property
    def cwd(self) -> Any:
        """Working directory."""
        return self.process_description.cwd

    @property
    def env(self) -> Any:
        """All variables of the environment."""
        return self.process_description.env

    @property
    def additional_env(self) -> Any:
        """Variables that are added to the environment."""
        return self.process_description.additional_env
