"""Write files and folders that appear as a whole or not at all."""

from __future__ import annotations

import os
import shutil
import tempfile
from collections.abc import Iterator
from pathlib import Path
from types import TracebackType
from typing import Final

from simkit.errors import InputError

_MARK: Final = ".unfinished-"
_MODE = 0o666  # less the process's mask: what `open` would give


def check_file(path: Path, *, overwrite: bool) -> None:
    """Check that a file may be written: it replaces a file only where that is wanted, and anything else never.

    Raises:
        InputError: SK-CLI-016 something is there already.
    """
    if path.exists() and not path.is_file():
        what = "it is a folder" if path.is_dir() else "it is no plain file"
        raise InputError(f"SK-CLI-016 cannot write {path}: {what}", "SK-CLI-016")
    if path.exists() and not overwrite:
        raise _report_existing(path)


def write_obstacle(path: Path) -> str:
    """Why nothing can come to be at a path, whose folders may have to be made; empty where it can."""
    parent = path.absolute().parent
    while not parent.exists():
        parent = parent.parent
    if not parent.is_dir():
        return f"{parent} is no folder"
    return "" if os.access(parent, os.W_OK) else f"the folder {parent} is not writable"


def check_folder(path: Path) -> None:
    """Check that files may be written into a folder, which need not exist yet.

    Raises:
        InputError: SK-CLI-016 it is none, or nothing can be written there.
    """
    try:
        why = "it is no folder" if path.exists() and not path.is_dir() else write_obstacle(path / "file")
    except (OSError, ValueError) as error:
        why = getattr(error, "strerror", None) or str(error)
    if why:
        raise InputError(f"SK-CLI-016 cannot write to {path}: {why}", "SK-CLI-016")


def check_target(path: Path, folder: str, *, overwrite: bool) -> None:
    """Check that a file and the folder beside it may be written.

    Raises:
        InputError: SK-CLI-016 something is there already, or there is no folder to write into.
    """
    whole = path.absolute()
    if not whole.parent.is_dir():
        raise InputError(f"SK-CLI-016 there is no folder {whole.parent}", "SK-CLI-016")
    check_file(path, overwrite=overwrite)
    beside = path.with_name(folder)
    if beside.exists() and not overwrite:
        raise _report_existing(beside)


def _report_existing(path: Path) -> InputError:
    said = f"SK-CLI-016 {path} exists already and is not overwritten\n    help: --force replaces it"
    return InputError(said, "SK-CLI-016")


class AtomicOutput:
    """A file with a folder beside it, made in a hidden folder and moved into place at the end.

    Args:
        path: the file.
        folder: name of the folder beside it, which need not come to be.
        overwrite: replaces what is there.

    Attributes:
        file, folder: where to write while it is open; the folder is not made.

    Raises:
        InputError: SK-CLI-016 something is there already, or the place cannot be written.
    """

    def __init__(self, path: Path, folder: str, *, overwrite: bool = False) -> None:
        check_target(path, folder, overwrite=overwrite)
        self._path, self._beside = path.absolute(), path.absolute().with_name(folder)

    def __enter__(self) -> AtomicOutput:
        try:
            self._stage = Path(tempfile.mkdtemp(prefix=f".{self._path.stem}.", dir=self._path.parent))
        except OSError as error:
            raise self._failed(error) from None
        self.file, self.folder = self._stage / self._path.name, self._stage / self._beside.name
        return self

    def __exit__(
        self, kind: type[BaseException] | None, error: BaseException | None, _trace: TracebackType | None
    ) -> None:
        try:
            if kind is None:
                self._move()
        except OSError as problem:
            raise self._failed(problem) from None
        finally:
            shutil.rmtree(self._stage, ignore_errors=True)
        if isinstance(error, OSError):
            raise self._failed(error) from None

    def _move(self) -> None:
        """The folder first: the file that speaks of it comes when it is there."""
        old = self._stage / "old"
        if self._beside.exists():
            self._beside.rename(old)
        try:
            if self.folder.exists():
                self.folder.rename(self._beside)
            os.replace(self.file, self._path)  # noqa: PTH105 - atomic on every platform
        except OSError:
            if old.exists():
                shutil.rmtree(self._beside, ignore_errors=True)
                old.rename(self._beside)
            raise

    def _failed(self, error: OSError) -> InputError:
        return InputError(f"SK-CLI-016 cannot write {self._path}: {error.strerror or error}", "SK-CLI-016")


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
    """Check whether the process of a number has ended."""
    if os.name == "nt":  # os.kill would end it there
        return False
    try:
        os.kill(int(process), 0)
    except ProcessLookupError:
        return True
    except (ValueError, OSError, OverflowError):
        return False
    return False


def check_writable(path: str | os.PathLike[str] | None) -> None:
    """Check that `write_atomically` can write a file, before the work whose result goes into it.

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
            Path(temporary).chmod(_MODE & ~current_umask())
            os.replace(temporary, target)  # noqa: PTH105 - atomic on every platform
        except BaseException:
            Path(temporary).unlink(missing_ok=True)
            raise
    except (OSError, ValueError) as error:
        said = (error.strerror or str(error)) if isinstance(error, OSError) else str(error)
        raise InputError(f"SK-CLI-016 cannot write {path}: {said}", "SK-CLI-016") from None


def current_umask() -> int:
    """Return the permissions that a new file is not given; there is no way to ask without setting them."""
    mask = os.umask(0o022)
    os.umask(mask)
    return mask
