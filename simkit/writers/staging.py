"""Output of several files that is there as a whole or not at all."""

from __future__ import annotations

import os
import shutil
import tempfile
from pathlib import Path
from types import TracebackType

from simkit.errors import InputError


def check_target(path: Path, folder: str, *, overwrite: bool) -> None:
    """Whether a file and the folder beside it may be written.

    Raises:
        InputError: SK-CLI-016 something is there already, or there is no folder to write into.
    """
    whole = path.absolute()
    if not whole.parent.is_dir():
        raise InputError(f"SK-CLI-016 there is no folder {whole.parent}", "SK-CLI-016")
    if whole.is_dir():
        raise InputError(f"SK-CLI-016 cannot write {path}: it is a folder", "SK-CLI-016")
    for target in (path, path.with_name(folder)):
        if target.exists() and not overwrite:
            raise InputError(
                f"SK-CLI-016 {target} exists already and is not overwritten\n    help: --force replaces it",
                "SK-CLI-016",
            )


class Staging:
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

    def __enter__(self) -> Staging:
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
