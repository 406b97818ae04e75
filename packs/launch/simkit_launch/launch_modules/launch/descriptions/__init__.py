"""Description of an executable: command line, folder and environment."""

from __future__ import annotations

import os
import shlex
from collections.abc import Iterable, Mapping
from typing import TYPE_CHECKING, Any

from simkit_launch.launch_modules.launch.substitution import Substitution
from simkit_launch.launch_modules.launch.utilities import normalize_to_list_of_substitutions, perform_substitutions

if TYPE_CHECKING:
    from simkit_launch.launch_modules.launch.action import Action
    from simkit_launch.launch_modules.launch.launch_context import LaunchContext
    from simkit_launch.launch_modules.launch.some_substitutions_type import SomeSubstitutionsType

__all__ = ["Executable"]

_Variables = list[tuple[list[Substitution], list[Substitution]]]


class Executable:
    """Command line, folder and environment of a process.

    Args:
        cmd: words of the command line.
        prefix: words before the command line; None for those of the launch configuration `launch-prefix`.
        name: name for messages.
        cwd: working directory.
        env: all variables of the environment.
        additional_env: variables that are added to the environment.
        arguments: more words of the command line.

    Attributes:
        final_name: name for messages, after `prepare`.
        final_cmd: words of the command line, after `prepare`.
        final_prefix: words before them, after `prepare`.
        final_cwd: working directory, after `prepare`.
        final_env: variables of the environment, after `prepare`.
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
        arguments: Iterable[SomeSubstitutionsType] | None = None,
    ) -> None:
        self._cmd = [normalize_to_list_of_substitutions(word) for word in cmd]
        self._cmd += [normalize_to_list_of_substitutions(word) for word in arguments or ()]
        self._prefix = None if prefix is None else normalize_to_list_of_substitutions(prefix)
        self._name = None if name is None else normalize_to_list_of_substitutions(name)
        self._cwd = None if cwd is None else normalize_to_list_of_substitutions(cwd)
        self._env, self._additional_env = _variables(env), _variables(additional_env)
        self.final_name: str | None = None
        self.final_cmd: list[str] | None = None
        self.final_prefix: list[str] = []
        self.final_cwd: str | None = None
        self.final_env: dict[str, str] | None = None

    @property
    def name(self) -> list[Substitution] | None:
        """Name for messages."""
        return self._name

    @property
    def prefix(self) -> list[Substitution] | None:
        """Words before the command line."""
        return self._prefix

    @property
    def cmd(self) -> list[list[Substitution]]:
        """Words of the command line."""
        return self._cmd

    @property
    def cwd(self) -> list[Substitution] | None:
        """Working directory."""
        return self._cwd

    @property
    def env(self) -> _Variables | None:
        """All variables of the environment."""
        return self._env

    @property
    def additional_env(self) -> _Variables | None:
        """Variables that are added to the environment."""
        return self._additional_env

    def prepare(self, context: LaunchContext, action: Action) -> None:
        """Compute the final values."""
        del action
        self.final_cmd = [perform_substitutions(context, word) for word in self._cmd]
        prefix = self._prefix
        text = context.launch_configurations.get("launch-prefix", "") if prefix is None else ""
        self.final_prefix = shlex.split(text if prefix is None else perform_substitutions(context, prefix))
        first = os.path.basename(self.final_cmd[0]) if self.final_cmd else ""  # noqa: PTH119 - a text
        name = first if self._name is None else perform_substitutions(context, self._name)
        self.final_name = f"{name}-{context.planner.next_number}"
        self.final_cwd = None if self._cwd is None else perform_substitutions(context, self._cwd)
        environment = dict(os.environ) if self._env is None else _performed(context, self._env)
        self.final_env = {**environment, **_performed(context, self._additional_env or [])}


def _variables(values: Mapping[Any, SomeSubstitutionsType] | None) -> _Variables | None:
    if values is None:
        return None
    return [
        (normalize_to_list_of_substitutions(name), normalize_to_list_of_substitutions(value))
        for name, value in values.items()
    ]


def _performed(context: LaunchContext, variables: _Variables) -> dict[str, str]:
    return {perform_substitutions(context, name): perform_substitutions(context, value) for name, value in variables}
