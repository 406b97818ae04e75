"""Home folder of the user, also in a container whose user has none."""

from __future__ import annotations

import os
from pathlib import Path


def home_folder() -> Path:
    """Return the user's home folder, or `/` for a user who has none.

    A container may run under a user number without an account. Docker then sets `HOME=/`; other programs set no `HOME`,
    and `Path.home` raises an error.
    """
    try:
        return Path.home()
    except RuntimeError:
        return Path(os.sep)
