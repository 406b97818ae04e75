"""Home folder of the user, also in a container whose user has none."""

from __future__ import annotations

import os
from pathlib import Path


def expand_home(path: str | os.PathLike[str]) -> Path:
    """Return a path whose leading `~` or `~user` is replaced; a path of an unknown user stays as it is."""
    try:
        return Path(path).expanduser()
    except RuntimeError:
        return Path(path)


def home_folder() -> Path:
    """Return the user's home folder, or `/` for a user who has none.

    A container may run under a user number without an account. Docker then sets `HOME=/`; other programs set no `HOME`,
    and `Path.home` raises an error.
    """
    try:
        return Path.home()
    except RuntimeError:
        return Path(os.sep)
