"""Folders in which packages are installed."""

from __future__ import annotations

import os

from simkit_nodes.ros_modules.ament_index_python.constants import AMENT_PREFIX_PATH_ENV_VAR

__all__ = ["get_search_paths"]


def get_search_paths() -> list[str]:
    """Return the folders in `AMENT_PREFIX_PATH` that exist; none without the variable, which is no error here."""
    paths = os.environ.get(AMENT_PREFIX_PATH_ENV_VAR, "").split(os.pathsep)
    return [path for path in paths if path and os.path.exists(path)]  # noqa: PTH110 - a text, as in ROS
