"""Folders that a loaded file may write to: the working directory and the folders of `SIMKIT_SAVE_PATH`."""

from __future__ import annotations

import os
from pathlib import Path
from typing import Final

SAVE_PATH_VARIABLE: Final = "SIMKIT_SAVE_PATH"
"""Environment variable with further folders that worlds may write to, separated as in PATH."""


def allowed_folder(path: str) -> Path | None:
    """Return the folder with all symbolic links resolved; None if writing to it is not allowed."""
    try:
        folder = Path(path).resolve()
        roots = [Path.cwd(), *(Path(root) for root in os.environ.get(SAVE_PATH_VARIABLE, "").split(os.pathsep) if root)]
        if any(folder.is_relative_to(root.resolve()) for root in roots):
            return folder
    except (OSError, RuntimeError, ValueError):  # invalid path, such as a loop of links or a name with a zero byte
        pass
    return None
