"""Sources of launch descriptions: files of any kind, and descriptions that a script makes."""

from __future__ import annotations

from typing import TYPE_CHECKING

from simkit_launch.launch_modules.launch.substitution import Substitution
from simkit_launch.launch_modules.launch.utilities import normalize_to_list_of_substitutions, perform_substitutions
from simkit_launch.planner import current_planner

if TYPE_CHECKING:
    from simkit_launch.launch_modules.launch.launch_context import LaunchContext
    from simkit_launch.launch_modules.launch.launch_description import LaunchDescription
    from simkit_launch.launch_modules.launch.some_substitutions_type import SomeSubstitutionsType

__all__ = [
    "AnyLaunchDescriptionSource",
    "FrontendLaunchDescriptionSource",
    "LaunchDescriptionSource",
    "PythonLaunchDescriptionSource",
    "XMLLaunchDescriptionSource",
    "YAMLLaunchDescriptionSource",
]


class LaunchDescriptionSource:
    """Source of a launch description.

    Args:
        launch_description: launch description; None for that of the file.
        location: path of the file.
        method: description of how the file is read.
    """

    def __init__(
        self,
        launch_description: LaunchDescription | None = None,
        location: SomeSubstitutionsType = "<string>",
        method: str = "unspecified mechanism from a script",
    ) -> None:
        self._description = launch_description
        self._location = normalize_to_list_of_substitutions(location)
        self._path: str | None = None
        self._method = method

    def try_get_launch_description_without_context(self) -> LaunchDescription | None:
        """Return the launch description; None if its path depends on arguments, or if it cannot be read."""
        if self._description is not None:
            return self._description
        planner = current_planner()
        try:
            description: LaunchDescription = planner.description_of(
                perform_substitutions(planner.language.new_context(), self._location)
            )
            return description
        except Exception:  # noqa: BLE001 - a file may raise anything
            return None

    def get_launch_description(self, context: LaunchContext) -> LaunchDescription:
        """Return the launch description."""
        if self._path is None:
            self._path = perform_substitutions(context, self._location)
        if self._description is None:
            self._description = context.planner.description_of(self._path)
        return self._description

    @property
    def location(self) -> str:
        """Path of the file, or a description of it before the path is known."""
        return self._path if self._path is not None else " + ".join(str(each) for each in self._location)

    @property
    def substitutions(self) -> list[Substitution]:
        """Substitutions for the path of the file."""
        return self._location

    @property
    def is_file(self) -> bool:
        """True if a file has the launch description."""
        return isinstance(self, _FileSource)

    @property
    def method(self) -> str:
        """Description of how the file is read."""
        return self._method


class _FileSource(LaunchDescriptionSource):
    def __init__(self, launch_file_path: SomeSubstitutionsType, **options: object) -> None:
        del options
        super().__init__(None, launch_file_path, "interpreted launch file")


class PythonLaunchDescriptionSource(_FileSource):
    """Launch file in Python.

    Args:
        launch_file_path: path of the file.
    """


class AnyLaunchDescriptionSource(_FileSource):
    """Launch file in Python, XML or YAML.

    Args:
        launch_file_path: path of the file.
    """


class FrontendLaunchDescriptionSource(_FileSource):
    """Launch file in XML or YAML.

    Args:
        launch_file_path: path of the file.
    """


class XMLLaunchDescriptionSource(_FileSource):
    """Launch file in XML.

    Args:
        launch_file_path: path of the file.
    """


class YAMLLaunchDescriptionSource(_FileSource):
    """Launch file in YAML.

    Args:
        launch_file_path: path of the file.
    """
