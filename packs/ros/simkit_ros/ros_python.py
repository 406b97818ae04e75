"""Find the Python that has rclpy: the given one, the one of the sourced ROS, or the one that runs simkit."""

from __future__ import annotations

import importlib.util
import os
import re
import shutil
import sys
from pathlib import Path

from simkit.errors import InputError

INSTALL_HELP = (
    "source a ROS 2 installation (`source /opt/ros/jazzy/setup.bash`), or make an environment with rclpy:\n"
    "          python3 -m venv rosenv && rosenv/bin/pip install "
    "ros-jazzy-rclpy ros-jazzy-rmw-fastrtps-cpp ros-jazzy-common-interfaces\n"
    "          and add --ros-python rosenv/bin/python"
)
"""Remedy for a missing rclpy."""
_PACKAGES = re.compile(r"/python(3\.\d+)/(site|dist)-packages/?$")


def find_python(interpreter: Path | None) -> Path:
    """Return the Python for the bridge process.

    Args:
        interpreter: interpreter, or folder of a virtual environment, that the user names; None for the first of the
            sourced ROS's Python, and the Python of this process if it has rclpy.

    Raises:
        InputError: SK-ROS-001 no Python with rclpy is found.
    """
    if interpreter is not None:
        return _given_python(interpreter)
    for folder in _ros_folders():
        version = _PACKAGES.search(folder.as_posix())
        if version is None or not (folder / "rclpy").is_dir():
            continue
        if version[1] == f"{sys.version_info.major}.{sys.version_info.minor}":
            return Path(sys.executable)
        python = shutil.which(f"python{version[1]}")
        if python is not None:
            return Path(python)
    if importlib.util.find_spec("rclpy") is not None:
        return Path(sys.executable)
    raise InputError("SK-ROS-001", "no Python with rclpy is found", help=INSTALL_HELP)


def _given_python(interpreter: Path) -> Path:
    """Return the interpreter that the user names; a relative path stays a link into its virtual environment."""
    python = interpreter / "bin" / "python" if interpreter.is_dir() else interpreter
    if python.parent == Path() and not python.is_file():
        python = Path(shutil.which(str(python)) or python)
    if not python.is_file() or not os.access(python, os.X_OK):
        text = f"--ros-python: found {str(interpreter)!r}, which is no Python interpreter or virtual environment"
        raise InputError("SK-ROS-001", text, help=INSTALL_HELP)
    return python.absolute()


def _ros_folders() -> list[Path]:
    """Return the folders for Python packages of the sourced ROS."""
    folders = [Path(path) for path in os.environ.get("PYTHONPATH", "").split(os.pathsep) if path]
    for prefix in os.environ.get("AMENT_PREFIX_PATH", "").split(os.pathsep):
        if prefix:
            folders += sorted(Path(prefix).glob("lib/python3.*/*-packages"))
    return folders
