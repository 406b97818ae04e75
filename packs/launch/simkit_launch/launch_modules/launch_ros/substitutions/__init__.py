"""Substitutions for packages, executables and parameters."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING

from simkit_launch.launch_modules.launch.substitution import Substitution
from simkit_launch.launch_modules.launch.substitutions import PathSubstitution, SubstitutionFailure
from simkit_launch.launch_modules.launch.utilities import normalize_to_list_of_substitutions, perform_substitutions
from simkit_launch.planner import current_planner

if TYPE_CHECKING:
    from simkit_launch.launch_modules.launch.launch_context import LaunchContext
    from simkit_launch.launch_modules.launch.some_substitutions_type import SomeSubstitutionsType

__all__ = ["ExecutableInPackage", "FindPackage", "FindPackagePrefix", "FindPackageShare", "Parameter"]


class FindPackage(PathSubstitution):
    """Folder of a package.

    Args:
        package: name of the package.
    """

    def __init__(self, package: SomeSubstitutionsType) -> None:
        super().__init__("")
        self._package = normalize_to_list_of_substitutions(package)

    @property
    def package(self) -> list[Substitution]:
        """Name of the package."""
        return self._package

    def find(self, package_name: str) -> str:
        """Return the folder of a package."""
        raise NotImplementedError("This method should be implemented by a subclass")

    def perform(self, context: LaunchContext) -> str:
        """Return the folder of the package."""
        return self.find(perform_substitutions(context, self.package))


class FindPackagePrefix(FindPackage):
    """Folder in which a package is installed.

    Args:
        package: name of the package.
    """

    def find(self, package_name: str) -> str:
        """Return the folder of a package."""
        share = current_planner().share_folder(package_name)
        return str(share.parents[1] if share.parent.name == "share" else share)


class FindPackageShare(FindPackage):
    """Folder with the files of a package.

    Args:
        package: name of the package.
    """

    def find(self, package_name: str) -> str:
        """Return the folder of a package."""
        return str(current_planner().share_folder(package_name))


class ExecutableInPackage(FindPackagePrefix):
    """Executable of a package.

    Args:
        executable: name of the executable.
        package: name of the package.
    """

    def __init__(self, executable: SomeSubstitutionsType, package: SomeSubstitutionsType) -> None:
        super().__init__(package)
        self._executable = normalize_to_list_of_substitutions(executable)

    @property
    def executable(self) -> list[Substitution]:
        """Name of the executable."""
        return self._executable

    def perform(self, context: LaunchContext) -> str:
        """Return the path of the executable, which need not exist."""
        package = perform_substitutions(context, self.package)
        return str(Path(super().perform(context), "lib", package, perform_substitutions(context, self.executable)))


class Parameter(Substitution):
    """Value of a parameter that `SetParameter` has set.

    Args:
        name: name of the parameter.
        default: value without such a parameter; None for an error.
    """

    def __init__(self, name: SomeSubstitutionsType, *, default: SomeSubstitutionsType | None = None) -> None:
        self._name = normalize_to_list_of_substitutions(name)
        self._default = None if default is None else normalize_to_list_of_substitutions(default)

    @property
    def name(self) -> list[Substitution]:
        """Name of the parameter."""
        return self._name

    def perform(self, context: LaunchContext) -> str:
        """Return the value."""
        name = perform_substitutions(context, self.name)
        for param in reversed(context.launch_configurations.get("global_params", [])):
            if isinstance(param, tuple) and param[0] == name:
                return str(param[1])
        if self._default is None:
            raise SubstitutionFailure(f"parameter '{name}' not found")
        return perform_substitutions(context, self._default)
