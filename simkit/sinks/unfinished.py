"""Hidden folders in which something is made that is moved to its place at the end."""

from __future__ import annotations

import os
import shutil
import tempfile
from collections.abc import Iterator
from pathlib import Path
from typing import Final

_MARK: Final = ".unfinished-"


def unfinished_folder(parent: Path, name: str) -> Path:
    """A new folder, which says whose it is: what a killed process left is found by that.

    Args:
        parent: where it is made, beside what it is made for.
        name: of what it is made for.

    Raises:
        OSError: nothing can be written there.
    """
    return Path(tempfile.mkdtemp(prefix=f"{_prefix(name)}{os.getpid()}-", dir=parent))


def left_folders(parent: Path, name: str) -> Iterator[Path]:
    """Folders made for a name by processes that are no more."""
    prefix = _prefix(name)
    for path in sorted(parent.iterdir()) if parent.is_dir() else ():
        if path.name.startswith(prefix) and _is_over(path.name[len(prefix) :].partition("-")[0]):
            yield path


def tidy(parent: Path, name: str) -> None:
    """Takes away what killed processes left, where that is possible."""
    for path in left_folders(parent, name):
        shutil.rmtree(path, ignore_errors=True)


def _prefix(name: str) -> str:
    return f".{name[:80]}{_MARK}"


def _is_over(process: str) -> bool:
    """Whether there is no process of a number any more."""
    if os.name == "nt":  # os.kill would end it there
        return False
    try:
        os.kill(int(process), 0)
    except ProcessLookupError:
        return True
    except (ValueError, OSError, OverflowError):
        return False
    return False
