"""Descriptions of parameters: a value with a type, a name with a value, a file."""

from __future__ import annotations

import os
from pathlib import Path
from typing import TYPE_CHECKING, Any

import yaml

from simkit.input_file import read_input_text
from simkit_launch.launch_modules.launch.substitution import Substitution
from simkit_launch.launch_modules.launch.substitutions import SubstitutionFailure
from simkit_launch.launch_modules.launch.utilities import (
    ensure_argument_type,
    normalize_to_list_of_substitutions,
    perform_substitutions,
)
from simkit_launch.launch_modules.launch.utilities.type_utils import (
    normalize_typed_substitution,
    perform_typed_substitution,
)

if TYPE_CHECKING:
    from simkit_launch.launch_modules.launch.launch_context import LaunchContext
    from simkit_launch.launch_modules.launch.some_substitutions_type import SomeSubstitutionsType

__all__ = ["Parameter", "ParameterFile", "ParameterValue"]


class ParameterValue:
    """Value of a parameter.

    Args:
        value: value, or substitutions for it.
        value_type: type to which a substitution is converted; None for the rules of YAML.
    """

    def __init__(self, value: Any, *, value_type: Any = None) -> None:
        self._value, self._type = normalize_typed_substitution(value, value_type), value_type

    @property
    def value(self) -> Any:
        """Value, or substitutions for it."""
        return self._value

    @property
    def value_type(self) -> Any:
        """Type to which a substitution is converted."""
        return self._type

    def evaluate(self, context: LaunchContext) -> Any:
        """Return the value."""
        return perform_typed_substitution(context, self._value, self._type)


class Parameter:
    """Name and value of a parameter.

    Args:
        name: name.
        value: value, or substitutions for it.
        value_type: type to which a substitution is converted; None for the rules of YAML.
    """

    def __init__(self, name: SomeSubstitutionsType, value: Any, *, value_type: Any = None) -> None:
        self._name = normalize_to_list_of_substitutions(name)
        self._value = ParameterValue(value, value_type=value_type)

    @property
    def name(self) -> list[Substitution]:
        """Name."""
        return self._name

    @property
    def value(self) -> Any:
        """Value, or substitutions for it."""
        return self._value.value

    @property
    def value_type(self) -> Any:
        """Type to which a substitution is converted."""
        return self._value.value_type

    def evaluate(self, context: LaunchContext) -> tuple[str, Any]:
        """Return the name and the value."""
        return perform_substitutions(context, self._name), self._value.evaluate(context)


class ParameterFile:
    """File of parameters.

    Args:
        param_file: path.
        allow_substs: True to replace substitutions such as `$(var NAME)` in the file.
    """

    def __init__(
        self, param_file: SomeSubstitutionsType, *, allow_substs: bool | SomeSubstitutionsType = False
    ) -> None:
        ensure_argument_type(
            param_file, (str, os.PathLike, bytes, Substitution, list, tuple), "param_file", "ParameterFile()"
        )
        self._file = normalize_to_list_of_substitutions(param_file)
        self._allow_substs = normalize_typed_substitution(allow_substs, bool)
        self._path: Path | None = None

    @property
    def param_file(self) -> Any:
        """Path."""
        return self._path if self._path is not None else self._file

    @property
    def allow_substs(self) -> Any:
        """True to replace substitutions in the file."""
        return self._allow_substs

    def evaluate(self, context: LaunchContext) -> Path:
        """Return the path of the file; with substitutions, that of a file in which they are replaced."""
        if self._path is not None:
            return self._path
        path: Path = context.planner.source_of(Path(perform_substitutions(context, self._file)))
        if perform_typed_substitution(context, self._allow_substs, bool) and path.is_file():
            text = context.planner.replace_substitutions(read_input_text(path), context)
            try:
                yaml.safe_load(text)
            except yaml.YAMLError:
                raise SubstitutionFailure("The substituted parameter file is not a valid yaml file") from None
            path = context.planner.write_file(f"launch_params_{path.stem}", ".yaml", text)
        self._path = path
        return path

    def cleanup(self) -> None:
        """Do nothing: the run reads the file."""
