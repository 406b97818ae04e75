"""A file that is there as a whole or not at all."""

from __future__ import annotations

import os
import tempfile
from pathlib import Path

from simkit.errors import InputError
from simkit.writers.staging import why_unwritable

_MODE = 0o666  # less the process's mask: what `open` would give


def check_whole(path: str | os.PathLike[str] | None) -> None:
    """Whether `write_whole` can write a file: to be asked before the work whose outcome goes into it.

    Args:
        path: the file; None for none.

    Raises:
        InputError: SK-CLI-016 the place cannot be written.
    """
    if path is None:
        return
    target = Path(path)
    try:
        why = "it is a folder" if target.is_dir() else "" if target.exists() else why_unwritable(target)
    except (OSError, ValueError) as error:
        why = getattr(error, "strerror", None) or str(error)
    if why:
        raise InputError(f"SK-CLI-016 cannot write {path}: {why}", "SK-CLI-016")


def write_whole(path: str | os.PathLike[str], data: bytes) -> None:
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
            Path(temporary).chmod(_MODE & ~_mask())
            os.replace(temporary, target)  # noqa: PTH105 - atomic on every platform
        except BaseException:
            Path(temporary).unlink(missing_ok=True)
            raise
    except (OSError, ValueError) as error:
        said = (error.strerror or str(error)) if isinstance(error, OSError) else str(error)
        raise InputError(f"SK-CLI-016 cannot write {path}: {said}", "SK-CLI-016") from None


def _mask() -> int:
    """What a new file is not given; there is no way to ask without setting it."""
    mask = os.umask(0o022)
    os.umask(mask)
    return mask
