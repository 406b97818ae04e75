"""Write a file or folder that appears as a whole or not at all."""

from __future__ import annotations

import os
import shutil
import tempfile
from collections.abc import Iterator
from pathlib import Path
from typing import Final

from simkit.errors import InputError
from simkit.writers.atomic_output import write_obstacle

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


def abandoned_folders(parent: Path, name: str) -> Iterator[Path]:
    """Folders made for a name by processes that are no more."""
    prefix = _prefix(name)
    for path in sorted(parent.iterdir()) if parent.is_dir() else ():
        if path.name.startswith(prefix) and _has_ended(path.name[len(prefix) :].partition("-")[0]):
            yield path


def remove_abandoned(parent: Path, name: str) -> None:
    """Takes away what killed processes left, where that is possible."""
    for path in abandoned_folders(parent, name):
        shutil.rmtree(path, ignore_errors=True)


def _prefix(name: str) -> str:
    return f".{name[:80]}{_MARK}"


def _has_ended(process: str) -> bool:
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


_MODE = 0o666  # less the process's mask: what `open` would give


def check_writable(path: str | os.PathLike[str] | None) -> None:
    """Whether `write_atomically` can write a file: to be asked before the work whose outcome goes into it.

    Args:
        path: the file; None for none.

    Raises:
        InputError: SK-CLI-016 the place cannot be written.
    """
    if path is None:
        return
    target = Path(path)
    try:
        why = "it is a folder" if target.is_dir() else "" if target.exists() else write_obstacle(target)
    except (OSError, ValueError) as error:
        why = getattr(error, "strerror", None) or str(error)
    if why:
        raise InputError(f"SK-CLI-016 cannot write {path}: {why}", "SK-CLI-016")


def write_atomically(path: str | os.PathLike[str], data: bytes) -> None:
    """Writes a file, or leaves what was there: whoever reads it meanwhile sees the old one or the new one.

    Folders on the way to it are made. What is no plain file (`/dev/stdout`, a pipe) is written as it is.

    Raises:
        InputError: SK-CLI-016 the place cannot be written.
    """
    target = Path(path)
    try:
        if target.exists() and not target.is_file() and not target.is_dir():
            target.write_bytes(data)
            return
        target = target.resolve() if target.is_symlink() else target
        target.parent.mkdir(parents=True, exist_ok=True)
        handle, temporary = tempfile.mkstemp(prefix=f".{target.name[:40]}.", dir=target.parent)
        try:
            with os.fdopen(handle, "wb") as file:
                file.write(data)
                file.flush()
                os.fsync(file.fileno())
            Path(temporary).chmod(_MODE & ~_umask())
            os.replace(temporary, target)  # noqa: PTH105 - atomic on every platform
        except BaseException:
            Path(temporary).unlink(missing_ok=True)
            raise
    except (OSError, ValueError) as error:
        said = (error.strerror or str(error)) if isinstance(error, OSError) else str(error)
        raise InputError(f"SK-CLI-016 cannot write {path}: {said}", "SK-CLI-016") from None


def _umask() -> int:
    """What a new file is not given; there is no way to ask without setting it."""
    mask = os.umask(0o022)
    os.umask(mask)
    return mask
