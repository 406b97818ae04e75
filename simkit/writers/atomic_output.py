"""Output of files and folders that appear completely or not at all."""

from __future__ import annotations

import os
import re
import shutil
import tempfile
from collections.abc import Iterator
from contextlib import suppress
from pathlib import Path
from types import TracebackType
from typing import Final

from simkit.errors import InputError
from simkit.output_file import open_special
from simkit.process_control import has_ended

_MARK: Final = ".unfinished-"
_MODE = 0o666  # as `open`: the process's umask is subtracted


def check_file(path: Path, *, overwrite: bool) -> None:
    """Check that a file may be written. Only a file can be replaced, and only with `overwrite`.

    Raises:
        InputError: SK-CLI-016 the path exists.
    """
    if path.exists() and not path.is_file():
        reason = "it is a folder" if path.is_dir() else "it is not a regular file"
        raise InputError("SK-CLI-016", f"cannot write {path}: {reason}")
    if path.exists() and not overwrite:
        raise _report_existing(path)


def write_obstacle(path: Path) -> str:
    """Return the reason why a path cannot be created, or an empty text. Missing parent folders are not a reason."""
    parent = path.absolute().parent
    while not parent.exists():
        parent = parent.parent
    if not parent.is_dir():
        return f"{parent} is not a folder"
    return "" if os.access(parent, os.W_OK) else f"the folder {parent} is not writable"


def check_folder(path: Path) -> None:
    """Check that files can be written to a folder, which need not exist yet.

    Raises:
        InputError: SK-CLI-016 the path is not a folder, or is not writable.
    """
    try:
        reason = "it is not a folder" if path.exists() and not path.is_dir() else write_obstacle(path / "file")
    except (OSError, ValueError) as error:
        reason = getattr(error, "strerror", None) or str(error)
    if reason:
        raise InputError("SK-CLI-016", f"cannot write to {path}: {reason}")


def check_target(path: Path, folder: str, *, overwrite: bool) -> None:
    """Check that a file and its asset folder can be written; missing parent folders are no obstacle.

    Raises:
        InputError: SK-CLI-016 a path exists, or no folder can be made for the file.
    """
    if not path.absolute().parent.is_dir() and (reason := write_obstacle(path)):
        raise InputError("SK-CLI-016", f"cannot write {path}: {reason}")
    check_file(path, overwrite=overwrite)
    asset_folder = path.with_name(folder)
    if asset_folder.exists() and not overwrite:
        remedy = "give the output another name; --force replaces the folder, also for another file that uses it"
        raise InputError("SK-CLI-016", f"{asset_folder} already exists", help=remedy)


def _report_existing(path: Path) -> InputError:
    return InputError("SK-CLI-016", f"{path} already exists", help="replace it with --force")


class AtomicOutput:
    """File with an asset folder, written to a hidden folder and moved to its path at the end.

    Missing parent folders are made, and removed again if nothing was written.

    Args:
        path: file to write.
        folder: name of the asset folder next to the file; it need not be created.
        overwrite: replace existing files.

    Attributes:
        file, folder: temporary paths to write to inside the context; the folder is not created.

    Raises:
        InputError: SK-CLI-016 a path exists, or is not writable.
    """

    def __init__(self, path: Path, folder: str, *, overwrite: bool = False) -> None:
        check_target(path, folder, overwrite=overwrite)
        self._path, self._asset_folder = path.absolute(), path.absolute().with_name(folder)

    def __enter__(self) -> AtomicOutput:
        parent = self._path.parent
        self._new_folders = [each for each in (parent, *parent.parents) if not each.exists()]
        try:
            parent.mkdir(parents=True, exist_ok=True)
            self._stage = Path(tempfile.mkdtemp(prefix=f".{self._path.stem}.", dir=parent))
        except OSError as error:
            self._remove_empty_folders()
            raise self._failed(error) from None
        self.file, self.folder = self._stage / self._path.name, self._stage / self._asset_folder.name
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
            self._remove_empty_folders()
        if isinstance(error, OSError):
            raise self._failed(error) from None

    def _remove_empty_folders(self) -> None:
        """Remove the folders that were made for the output, if nothing is in them."""
        for folder in self._new_folders:
            with suppress(OSError):
                folder.rmdir()

    def _move(self) -> None:
        """Move the folder first, because the file refers to it."""
        old = self._stage / "old"
        if self._asset_folder.exists():
            self._asset_folder.rename(old)
        try:
            if self.folder.exists():
                self.folder.rename(self._asset_folder)
            os.replace(self.file, self._path)  # noqa: PTH105 - atomic on every platform
        except OSError:
            if old.exists():
                shutil.rmtree(self._asset_folder, ignore_errors=True)
                old.rename(self._asset_folder)
            raise

    def _failed(self, error: OSError) -> InputError:
        return InputError("SK-CLI-016", f"cannot write {self._path}: {error.strerror or error}")


def unfinished_folder(parent: Path, name: str) -> Path:
    """Create a temporary folder whose name holds the process number, so that folders of killed processes can be found.

    Args:
        parent: parent folder.
        name: name of the final file or folder.

    Raises:
        OSError: the parent is not writable.
    """
    return Path(tempfile.mkdtemp(prefix=f"{_prefix(name)}{os.getpid()}-", dir=parent))


def abandoned_folders(parent: Path, name: str) -> Iterator[Path]:
    """Yield the temporary folders of a name whose processes have ended."""
    prefix = _prefix(name)
    for path in sorted(parent.iterdir()) if parent.is_dir() else ():
        if path.name.startswith(prefix) and _has_ended(path.name[len(prefix) :].partition("-")[0]):
            yield path


def remove_abandoned(parent: Path, name: str) -> None:
    """Remove the temporary folders of killed processes, as far as possible."""
    for path in abandoned_folders(parent, name):
        shutil.rmtree(path, ignore_errors=True)


def copy_failure(error: OSError) -> str:
    """Return the reason why files could not be copied; `shutil` lists one reason for each file."""
    if isinstance(error, shutil.Error) and error.args and isinstance(error.args[0], list) and error.args[0]:
        first = str(error.args[0][0][2])
        return re.sub(r"^\[Errno \d+\] |: '.*", "", first)
    return error.strerror or str(error)


def _prefix(name: str) -> str:
    return f".{name[:80]}{_MARK}"


def _has_ended(process: str) -> bool:
    """Check whether the process with a number has ended."""
    return process.isdecimal() and has_ended(int(process))


def check_writable(path: str | os.PathLike[str] | None) -> None:
    """Check that `write_atomically` can write a file, before its content is computed.

    Args:
        path: file to write; None if no file is written.

    Raises:
        InputError: SK-CLI-016 the path is not writable.
    """
    if path is None:
        return
    target = Path(path)
    try:
        reason = "it is a folder" if target.is_dir() else "" if target.exists() else write_obstacle(target)
    except (OSError, ValueError) as error:
        reason = getattr(error, "strerror", None) or str(error)
    if reason:
        raise InputError("SK-CLI-016", f"cannot write {path}: {reason}")


def write_atomically(path: str | os.PathLike[str], data: bytes, *, follow_link: bool = True) -> None:
    """Write a file completely, or keep the old one. A reader always sees the old or the new content.

    Missing parent folders are created. A special file (`/dev/stdout`, a pipe) is written directly.

    Args:
        path: file to write.
        data: its content.
        follow_link: writes the target of a symbolic link; else the file replaces the link, and a pipe too. Used where
            the folder may come from somebody else.

    Raises:
        InputError: SK-CLI-016 the path is not writable.
    """
    target = Path(path)
    try:
        if follow_link and target.exists() and not target.is_file() and not target.is_dir():
            with open_special(target) as pipe:
                pipe.write(data)
            return
        target = target.resolve() if follow_link and target.is_symlink() else target
        target.parent.mkdir(parents=True, exist_ok=True)
        handle, temporary = tempfile.mkstemp(prefix=f".{target.name[:40]}.", dir=target.parent)
        try:
            with os.fdopen(handle, "wb") as file:
                file.write(data)
                file.flush()
                os.fsync(file.fileno())
            with suppress(OSError):  # FAT file systems have no permissions
                Path(temporary).chmod(_MODE & ~current_umask())
            os.replace(temporary, target)  # noqa: PTH105 - atomic on every platform
        except BaseException:
            Path(temporary).unlink(missing_ok=True)
            raise
    except (OSError, ValueError) as error:
        reason = (error.strerror or str(error)) if isinstance(error, OSError) else str(error)
        raise InputError("SK-CLI-016", f"cannot write {path}: {reason}") from None


def current_umask() -> int:
    """Return the umask of the process. The system can only report the umask by setting a new one."""
    mask = os.umask(0o022)
    os.umask(mask)
    return mask
