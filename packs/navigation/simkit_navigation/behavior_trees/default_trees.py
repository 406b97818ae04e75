"""Files of the default trees, by the names that `nav2_bt_navigator` gives them."""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path
from typing import Final

FOLDER: Final = Path(__file__).parent / "default_trees"
"""Folder with a folder for each version of ROS 2."""
TO_POSE: Final = "navigate_to_pose_w_replanning_and_recovery.xml"
THROUGH_POSES: Final = "navigate_through_poses_w_replanning_and_recovery.xml"
_VERSION: Final = "jazzy"
_FOXY_NAMES: Final = {"navigate_w_replanning_and_recovery.xml": TO_POSE}
"""Names in Foxy, which turtlebot3_navigation2/param/humble still has; Humble reads no parameter with this name."""
_OLD_VERSIONS: Final = ("foxy", "galactic", "humble")


def default_tree_names() -> list[str]:
    """Return the names of the files of all default trees."""
    return sorted({path.name for path in FOLDER.glob("*/*.xml")})


def find_tree_file(text: str, folders: Sequence[Path]) -> Path | None:
    """Return the file of a tree.

    Args:
        text: file; a name in a folder `behavior_trees`, or without a folder, is also one of the default trees. They are
            those of Humble if the text names Humble or an older version, and those of Jazzy otherwise.
        folders: folders of relative files.
    """
    path = Path(text)
    for candidate in (path,) if path.is_absolute() else tuple(folder / path for folder in (Path(), *folders)):
        if candidate.is_file():
            return candidate
    parts = text.replace("\\", "/").split("/")
    if len(parts) == 1 or parts[-2] == "behavior_trees":
        is_old = parts[-1] in _FOXY_NAMES or any(version in parts for version in _OLD_VERSIONS)
        for version in ("humble", _VERSION) if is_old else (_VERSION, "humble"):
            shipped = FOLDER / version / _FOXY_NAMES.get(parts[-1], parts[-1])
            if shipped.is_file():
                return shipped
    return None
