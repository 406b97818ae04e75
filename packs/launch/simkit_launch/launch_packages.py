"""ROS packages that a launch file names: their folders, and one warning for each package that is not there."""

from __future__ import annotations

from functools import cached_property
from pathlib import Path
from typing import Final

from simkit.diagnostics import Diagnostics, Where, did_you_mean
from simkit.run_files import PackagePaths
from simkit_launch.environment_hooks import workspace_variables
from simkit_nodes.workspace import Workspace

MISSING_PACKAGE: Final = "SK-LAUNCH-020"

MISSING_FOLDER: Final = Path("/no_such_ros_package")
"""Folder without content; the placeholders of missing packages are below it, so that a path can still be joined."""


_PACKAGES_OF_COMMANDS: Final = ("xacro",)
"""Packages whose commands simkit runs itself (`$(find xacro)/xacro.py`); they need not be there."""


_BUILT: Final = ("build", "install", "log", "devel")
"""Folders of a workspace that a build makes."""

_NO_PATTERN: Final = str.maketrans({"*": "[*]", "?": "[?]", "[": "[[]"})


_LEAST_COMMON: Final = 2
"""Number of names at the ends of two paths of the same file: its own name, and that of its folder."""


class LaunchPackages:
    """Packages of the workspace around a launch file.

    Args:
        folder: folder of the launch file.
        package_paths: folders of packages by name, or workspaces.
        diagnostics: collection that receives the warnings.
    """

    def __init__(self, folder: Path, package_paths: PackagePaths | None, diagnostics: Diagnostics) -> None:
        self.workspace = Workspace(folder, package_paths)
        self._diagnostics = diagnostics
        self._folders: dict[str, Path] = {}
        self._reported: dict[str, Where] = {}

    def folder(self, name: str, where: Where) -> Path:
        """Return the folder of a package; a placeholder, with a warning, for a package that is not there."""
        known = self._folders.get(name)
        if known is None:
            found = self.workspace.package(name)
            if found is None and name not in _PACKAGES_OF_COMMANDS:
                self._report_missing(name, where)
            known = self._folders[name] = found or MISSING_FOLDER / name
        return known

    def source_of(self, path: Path) -> Path:
        """Return the file of the source tree that a build would install at a path.

        A package may install its folder `launch` as `share/NAME`, for example. The file is the one of this name in the
        package; a path that exists, and one with no or several such files, stays as it is.
        """
        if path.exists() or not path.suffix:
            return path
        folder = next((each for each in self._folders.values() if each in path.parents and each.is_dir()), None)
        if folder is None:
            return path
        below = path.relative_to(folder).parts
        files = [file for file in _files(folder, path.name) if _is_source(file.relative_to(folder))]
        common = [_common_end(file.relative_to(folder).parts, below) for file in files]
        best = [file for file, count in zip(files, common, strict=True) if count == max(common)]
        return best[0] if len(best) == 1 else path

    def moved_file(self, path: Path) -> Path | None:
        """Return the only file of the workspace with the same name in a folder of the same name; None without one.

        Many launch files have paths of the computer of their author, such as `/mnt/ros2_ws/src/robot/urdf/r.urdf`.
        """
        is_topic = "@" in str(path)  # such as /scan@sensor_msgs/msg/LaserScan@gz.msgs.LaserScan
        if not path.is_absolute() or not path.suffix or is_topic or len(path.parts) < _LEAST_COMMON + 1:
            return None
        packages = list(self.workspace.packages().values())
        files = [
            file for folder in packages for file in _files(folder, path.name) if _is_source(file.relative_to(folder))
        ]
        common = {file: _common_end(file.parts, path.parts) for file in dict.fromkeys(files)}
        best = [file for file, count in common.items() if count == max(common.values()) and count >= _LEAST_COMMON]
        return best[0] if len(best) == 1 else None

    @cached_property
    def variables(self) -> dict[str, str]:
        """Environment variables that the packages set when the workspace is sourced."""
        return workspace_variables(self.workspace.packages())

    def is_reported(self, name: str, where: Where) -> bool:
        """Check whether the warning of a missing package has the same place as another one about the package."""
        return self._reported.get(name) == where

    def _report_missing(self, name: str, where: Where) -> None:
        self._reported[name] = where
        near = did_you_mean(name, sorted(self.workspace.packages()))
        message = f"there is no ROS package {name!r}; what the launch file takes from it is left out"
        message += near and f"; {near}"
        hint = "put the package into the workspace, or name its workspace with --package-path"
        self._diagnostics.warning(MISSING_PACKAGE, message, where, hint)


def missing_package_of(path: str | Path) -> str:
    """Return the package of a path below a placeholder; empty for any other path."""
    parts = Path(path).parts
    at = len(MISSING_FOLDER.parts)
    return parts[at] if parts[:at] == MISSING_FOLDER.parts and len(parts) > at else ""


def _files(folder: Path, name: str) -> list[Path]:
    return [file for file in sorted(folder.rglob(name.translate(_NO_PATTERN))) if file.is_file()]


def _is_source(path: Path) -> bool:
    return not any(part in _BUILT or part.startswith(".") for part in path.parts[:-1])


def _common_end(parts: tuple[str, ...], other: tuple[str, ...]) -> int:
    """Return how many names at the ends of two paths are the same."""
    count = 0
    for one, two in zip(reversed(parts), reversed(other), strict=False):
        if one != two:
            break
        count += 1
    return count
