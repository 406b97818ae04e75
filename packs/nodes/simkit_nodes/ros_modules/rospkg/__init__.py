"""Package `rospkg`: folders of the ROS packages around a program."""

from __future__ import annotations

import os
from pathlib import Path

from simkit_nodes.host import current_program

__all__ = ["ResourceNotFound", "RosPack", "get_ros_home", "get_ros_package_path", "get_ros_root"]


class ResourceNotFound(Exception):
    """There is no such package.

    Args:
        msg: name of the package.
        ros_paths: folders that were searched.
    """

    def __init__(self, msg: str, ros_paths: list[str] | None = None) -> None:
        super().__init__(msg)
        self.ros_paths = ros_paths


class RosPack:
    """Packages of the workspace around the program.

    Args:
        ros_paths: accepted as in ROS.
    """

    def __init__(self, ros_paths: list[str] | None = None) -> None:
        self._workspace = current_program().workspace

    @classmethod
    def get_instance(cls, ros_paths: list[str] | None = None) -> RosPack:
        """Return the packages."""
        return cls(ros_paths)

    def get_path(self, name: str) -> str:
        """Return the folder of a package.

        Raises:
            ResourceNotFound: there is no such package.
        """
        folder = self._workspace.package(name)
        if folder is None:
            raise ResourceNotFound(name)
        return str(folder)

    def list(self) -> list[str]:
        """Return the names of the packages of the workspace."""
        return list(self._workspace.packages())


def get_ros_root(env: object = None) -> str | None:
    """Return the folder of ROS; simkit has none."""
    return None


def get_ros_package_path(env: object = None) -> str | None:
    """Return the value of ROS_PACKAGE_PATH of the environment."""
    return os.environ.get("ROS_PACKAGE_PATH")


def get_ros_home(env: object = None) -> str:
    """Return the folder of ROS's files of the user."""
    return str(Path.home() / ".ros")
