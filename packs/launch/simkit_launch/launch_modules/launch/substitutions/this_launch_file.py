"""Substitutions for files: the launch file, the content of a file, an executable, the folder of logs."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING

from simkit.input_file import read_input_text
from simkit_launch.launch_modules.launch.substitution import Substitution
from simkit_launch.launch_modules.launch.substitutions.path_join_substitution import PathSubstitution
from simkit_launch.launch_modules.launch.substitutions.substitution_failure import SubstitutionFailure
from simkit_launch.launch_modules.launch.utilities import normalize_to_list_of_substitutions, perform_substitutions

if TYPE_CHECKING:
    from simkit_launch.launch_modules.launch.launch_context import LaunchContext
    from simkit_launch.launch_modules.launch.some_substitutions_type import SomeSubstitutionsType

__all__ = ["AnonName", "FileContent", "FindExecutable", "LaunchLogDir", "ThisLaunchFile", "ThisLaunchFileDir"]


class ThisLaunchFile(Substitution):
    """Path of the launch file that is executed."""

    def perform(self, context: LaunchContext) -> str:
        """Return the path."""
        return _launch_file(context, "current_launch_file_path")


class ThisLaunchFileDir(PathSubstitution):
    """Folder of the launch file that is executed."""

    def __init__(self) -> None:
        super().__init__("")

    def perform(self, context: LaunchContext) -> str:
        """Return the path."""
        return _launch_file(context, "current_launch_file_directory")


def _launch_file(context: LaunchContext, name: str) -> str:
    values = context.get_locals_as_dict()
    if name not in values:
        raise SubstitutionFailure("ThisLaunchFile used outside of a launch file (in a script)")
    return str(values[name])


class LaunchLogDir(Substitution):
    """Folder of the logs."""

    def perform(self, context: LaunchContext) -> str:
        """Return the path."""
        return str(context.planner.folder / "log")


class FileContent(Substitution):
    """Text of a file.

    Args:
        path: path of the file.
    """

    def __init__(self, path: SomeSubstitutionsType) -> None:
        self._path = normalize_to_list_of_substitutions(path)

    @property
    def path(self) -> list[Substitution]:
        """Path of the file."""
        return self._path

    def perform(self, context: LaunchContext) -> str:
        """Return the text of the file."""
        file = Path(perform_substitutions(context, self.path))
        try:
            return read_input_text(file)
        except OSError as error:
            raise SubstitutionFailure(f"Failed to open substitution file '{file}': {error}") from None


class FindExecutable(Substitution):
    """Executable; nothing is searched here, because no command is run: the path is the name.

    Args:
        name: name.
    """

    def __init__(self, *, name: SomeSubstitutionsType) -> None:
        self._name = normalize_to_list_of_substitutions(name)

    @property
    def name(self) -> list[Substitution]:
        """Name."""
        return self._name

    def perform(self, context: LaunchContext) -> str:
        """Return the name."""
        return perform_substitutions(context, self.name)


class AnonName(Substitution):
    """Name that no other node has; the same in every run.

    Args:
        name: begin of the name; the same begin gives the same name.
    """

    def __init__(self, name: SomeSubstitutionsType) -> None:
        self._name = normalize_to_list_of_substitutions(name)

    @property
    def name(self) -> list[Substitution]:
        """Begin of the name."""
        return self._name

    def perform(self, context: LaunchContext) -> str:
        """Return the name."""
        name = perform_substitutions(context, self.name)
        anonymous: str = context.launch_configurations.setdefault("anon" + name, self.compute_name(name))
        return anonymous

    def compute_name(self, id_value: str) -> str:
        """Return a name for the begin of a name."""
        return f"{id_value}_simkit_1".replace(".", "_").replace("-", "_").replace(":", "_")
