"""Where a file from somewhere else may have things written: below the working directory, and where the user says."""

from __future__ import annotations

import os
from pathlib import Path
from typing import Final

SAVE_PATH_VARIABLE: Final = "SIMKIT_SAVE_PATH"
"""Environment variable: folders, separated as in PATH, that worlds may write to, beside the working directory."""


def allowed_folder(path: str) -> Path | None:
    """The folder, with every symbolic link followed; None where it may not be written to."""
    try:
        folder = Path(path).resolve()
        roots = [Path.cwd(), *(Path(root) for root in os.environ.get(SAVE_PATH_VARIABLE, "").split(os.pathsep) if root)]
        if any(folder.is_relative_to(root.resolve()) for root in roots):
            return folder
    except (OSError, RuntimeError, ValueError):  # no such place: a loop of links, a name with a zero byte
        pass
    return None
