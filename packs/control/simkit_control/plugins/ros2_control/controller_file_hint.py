"""Search for the controllers' parameter file that a robot of ROS 1 does not name, because its launch file loads it."""

from __future__ import annotations

import os
from collections.abc import Collection, Iterator
from itertools import islice
from pathlib import Path
from typing import Final

from simkit.input_file import read_input_text
from simkit.project_folder import is_top_folder

_LEVELS: Final = 4  # folders above the file of the robot
_MOST_FILES: Final = 200
_LARGEST: Final = 1 << 16  # [byte]


def find_controller_file(robot_file: str | None, joints: Collection[str]) -> Path | None:
    """Return the file that has controllers for the most joints; None if no file names controllers and a joint.

    The search is in the folders `config` of the packages around the robot's file.

    Args:
        robot_file: file that describes the robot.
        joints: plain names of its joints.
    """
    best, most = None, 0
    for path in islice(_config_files(Path(robot_file)), _MOST_FILES) if robot_file else ():
        try:
            text = read_input_text(path, _LARGEST, errors="replace", inside=path.parent)
        except (OSError, ValueError):
            continue
        words = set(text.replace(",", " ").replace("[", " ").replace("]", " ").replace('"', " ").split())
        count = len(words.intersection(joints)) if "controllers/" in text else 0
        if count > most:
            best, most = path, count
    return best


def _config_files(robot_file: Path) -> Iterator[Path]:
    """Yield the YAML files in folders `config`, those near the robot's file first."""
    seen: set[Path] = set()
    for folder in islice(robot_file.absolute().parents, _LEVELS):
        if is_top_folder(folder):
            return
        for path in sorted((*folder.glob("config/*.y*ml"), *folder.glob("*/config/*.y*ml"))):
            if path not in seen and path.is_file():
                seen.add(path)
                yield path
        if os.path.lexists(folder / ".git"):
            return
