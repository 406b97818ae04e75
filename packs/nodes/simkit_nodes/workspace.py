"""ROS packages that a program can use: of the workspace around it, of other workspaces and of simkit."""

from __future__ import annotations

import os
from collections.abc import Iterator
from itertools import islice
from pathlib import Path
from typing import Final

from simkit.diagnostics import did_you_mean
from simkit.errors import InputError
from simkit.loaders.resources.bundled_models import bundled_folders
from simkit.loaders.resources.ros_packages import PackageIndex, enclosing_package
from simkit.project_folder import is_top_folder
from simkit.run_files import PackagePaths, split_package_paths
from simkit.trusted_folders import TrustedFolders
from simkit_nodes.interfaces.workspaces import add_workspace
from simkit_nodes.packages import (
    Executable,
    compiled_executables_of,
    executables_of,
    module_folders,
    package_name,
    python_folders,
)

_REPOSITORY_LEVELS: Final = 8  # folders above a package that are searched for `.git`

PREFIX_VARIABLES: Final = ("AMENT_PREFIX_PATH", "COLCON_PREFIX_PATH", "CMAKE_PREFIX_PATH")
"""Environment variables with folders in which packages are installed."""

UNKNOWN_PACKAGE: Final = "SK-NODE-060"
UNKNOWN_EXECUTABLE: Final = "SK-NODE-061"


class Workspace:
    """ROS packages, found by the rules of `package://` in world files.

    Packages of `package_paths` come first, then those around the folder, those of the environment variables
    `ROS_PACKAGE_PATH` and `AMENT_PREFIX_PATH`, those elsewhere in the Git repository of the package around the folder,
    the models that simkit ships, and the packages of packs (`packages` in the folder of a pack) with launch files.

    Args:
        folder: folder of a program, or present folder.
        package_paths: folders of packages by name, or workspaces.
    """

    def __init__(self, folder: Path, package_paths: PackagePaths | None = None) -> None:
        named, workspaces = split_package_paths(package_paths)
        self._around = (folder,)
        self._own = enclosing_package(folder)
        paths = (*_search_paths(), *_repository(self._own), *bundled_folders("assets"), *bundled_folders("packages"))
        trusted = TrustedFolders((folder, *named.values(), *workspaces))
        self._index = PackageIndex(named, workspaces, paths, trusted)
        self._has_interfaces = False
        self._folders_by_package: dict[Path, tuple[list[Path], list[Path]]] = {}

    @property
    def install_folder(self) -> Path:
        """Folder in which colcon would install the package around the folder; nothing is built there."""
        package = self._own or self._around[0]
        sources = next((folder for folder in package.parents[:4] if folder.name == "src"), package)
        return sources.parent / "install" / package_name(package)

    def package(self, name: str) -> Path | None:
        """Return the folder of the package with a name, the nearest one to the program; None without one."""
        folders = self._index.named_exactly(name, self._around)
        return next((folder for folder in folders if folder.is_dir()), None)

    def required_package(self, name: str) -> Path:
        """Return the folder of the package with a name.

        Raises:
            InputError: SK-NODE-060 there is no such package.
        """
        folder = self.package(name)
        if folder is not None:
            return folder
        near = did_you_mean(name, sorted(self.packages()))
        hint = "run in the folder of the workspace, or name the workspace with --package-path"
        raise InputError(UNKNOWN_PACKAGE, f"no ROS package {name!r}" + (f"; {near}" if near else ""), help=hint)

    def packages(self) -> dict[str, Path]:
        """Return the folders of all packages by name, sorted."""
        folders: dict[str, Path] = {}
        for folder in self._index.packages(self._around):
            folders.setdefault(package_name(folder), folder)
        return dict(sorted(folders.items()))

    def executable(self, package: str, name: str) -> Executable:
        """Return a Python executable of a package.

        Raises:
            InputError: SK-NODE-060 there is no such package; SK-NODE-061 the package has no such executable in Python.
        """
        folder = self.required_package(package)
        executables = executables_of(folder)
        if name in executables:
            return executables[name]
        if name in compiled_executables_of(folder):
            text = f"{package}/{name} is written in C++ ({folder})"
            raise InputError(UNKNOWN_EXECUTABLE, text, help="only programs in Python run without ROS")
        near = did_you_mean(name, list(executables))
        known = near or (f"it has {', '.join(executables)}" if executables else "it has none in Python")
        text = f"package {package!r} has no executable {name!r}; {known} ({folder})"
        raise InputError(UNKNOWN_EXECUTABLE, text, help=f"list them with: simkit pkg executables {package}")

    def entry_function(self, file: Path) -> str:
        """Return the function of a file that an executable of the package around the folder calls, else `main`."""
        executables = {} if self._own is None else executables_of(self._own)
        functions = (each.function for each in executables.values() if each.function and each.file == file)
        return next(functions, "main")

    def add_interfaces(self) -> None:
        """Make the messages, services and actions of all packages known."""
        if not self._has_interfaces:
            self._has_interfaces = True
            for package in self._index.packages(self._around):
                add_workspace(package)

    def module_folder(self, name: str) -> Path | None:
        """Return the folder from which a workspace that is built would import a top-level module; None without one.

        The program's own package comes first, then the package of the same name, then all others.
        """
        for package in self._candidates(name):
            packages, modules = self._import_folders(package)
            for folder in packages:
                if (folder / name / "__init__.py").is_file():
                    return folder
            for folder in modules:
                if (folder / f"{name}.py").is_file():
                    return folder
        return None

    def _import_folders(self, package: Path) -> tuple[list[Path], list[Path]]:
        """Return the folders from which packages of Python are imported, and those from which modules are.

        They are read once: a program imports many modules that no package has, and each would read all `setup.py`.
        """
        folders = self._folders_by_package.get(package)
        if folders is None:
            folders = self._folders_by_package[package] = (python_folders(package), module_folders(package))
        return folders

    def _candidates(self, name: str) -> Iterator[Path]:
        if self._own is not None:
            yield self._own
        yield from (folder for folder in self._index.named_exactly(name, self._around) if folder.is_dir())
        yield from self._index.packages(self._around)


def _repository(package: Path | None) -> list[Path]:
    """Return the Git repository around a package: one repository may have several workspaces."""
    parents = () if package is None else (package, *package.parents[:_REPOSITORY_LEVELS])
    roots = (folder for folder in parents if not is_top_folder(folder) and (folder / ".git").exists())
    return list(islice(roots, 1))


def _search_paths() -> list[Path]:
    """Return the folders of the environment variables in which packages are searched."""
    paths = [Path(text) for text in os.environ.get("ROS_PACKAGE_PATH", "").split(os.pathsep) if text]
    for variable in PREFIX_VARIABLES:
        prefixes = (Path(text) for text in os.environ.get(variable, "").split(os.pathsep) if text)
        paths += [folder for prefix in prefixes for folder in (prefix / "share", *prefix.glob("*/share"))]
    return [folder for folder in dict.fromkeys(paths) if folder.is_dir()]
