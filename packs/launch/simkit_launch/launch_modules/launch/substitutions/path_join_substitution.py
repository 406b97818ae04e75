"""Substitutions that are paths, and those that join texts."""

from __future__ import annotations

import os
from collections.abc import Iterable
from typing import TYPE_CHECKING

from simkit_launch.launch_modules.launch.substitution import Substitution
from simkit_launch.launch_modules.launch.utilities import normalize_to_list_of_substitutions, perform_substitutions

if TYPE_CHECKING:
    from simkit_launch.launch_modules.launch.launch_context import LaunchContext
    from simkit_launch.launch_modules.launch.some_substitutions_type import SomeSubstitutionsType

__all__ = ["PathJoinSubstitution", "PathSubstitution", "StringJoinSubstitution"]


class PathSubstitution(Substitution):
    """Path: the operator `/` joins it with further parts.

    Args:
        path: path.
    """

    def __init__(self, path: SomeSubstitutionsType) -> None:
        self._path = normalize_to_list_of_substitutions(path)

    @property
    def path(self) -> list[Substitution]:
        """Path."""
        return self._path

    def __truediv__(self, additional_path: SomeSubstitutionsType) -> PathJoinSubstitution:
        return PathJoinSubstitution([self, additional_path])

    def perform(self, context: LaunchContext) -> str:
        """Return the path."""
        return perform_substitutions(context, self.path)


class PathJoinSubstitution(PathSubstitution):
    """Path of several parts.

    Args:
        substitutions: parts; a part that is a sequence is joined without a slash.
    """

    def __init__(self, substitutions: Iterable[SomeSubstitutionsType]) -> None:
        self._substitutions = [normalize_to_list_of_substitutions(each) for each in substitutions]

    @property
    def substitutions(self) -> list[list[Substitution]]:
        """Parts."""
        return self._substitutions

    def __truediv__(self, additional_path: SomeSubstitutionsType) -> PathJoinSubstitution:
        return PathJoinSubstitution([*self._substitutions, additional_path])

    def describe(self) -> str:
        """Return a description of the substitution."""
        return " / ".join("".join(sub.describe() for sub in part) for part in self._substitutions)

    def perform(self, context: LaunchContext) -> str:
        """Return the path."""
        parts = [perform_substitutions(context, part) for part in self._substitutions]
        return os.path.join(*parts) if parts else ""  # noqa: PTH118 - a text, as in ROS


class StringJoinSubstitution(Substitution):
    """Text of several parts with a delimiter between them.

    Args:
        substitutions: parts.
        delimiter: text between them.
    """

    def __init__(self, substitutions: Iterable[SomeSubstitutionsType], delimiter: SomeSubstitutionsType = "") -> None:
        self._substitutions = [normalize_to_list_of_substitutions(each) for each in substitutions]
        self._delimiter = normalize_to_list_of_substitutions(delimiter)

    def perform(self, context: LaunchContext) -> str:
        """Return the text."""
        parts = (perform_substitutions(context, part) for part in self._substitutions)
        return perform_substitutions(context, self._delimiter).join(parts)
