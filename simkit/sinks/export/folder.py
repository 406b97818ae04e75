"""A folder that is there as a whole or not at all."""

from __future__ import annotations

import json
import os
import shutil
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path
from typing import Final

from simkit.errors import InputError
from simkit.sinks.unfinished import left_folders, unfinished_folder
from simkit.writers.staging import why_unwritable

INDEX: Final = "index.json"
_MARK: Final = "simkit bag export"
_OLD: Final = "old"


def check_folder(path: Path, *, overwrite: bool) -> None:
    """Says before anything is read that an export cannot go there.

    Raises:
        InputError: SK-BAG-013 something is there that may not be replaced, or nothing can be written there.
    """
    try:
        if path.is_symlink() or (path.exists() and not path.is_dir()):
            raise _taken(f"{path} is there and is no folder")
        if path.is_dir() and any(path.iterdir()):
            if not _is_export(path):
                raise _taken(f"{path} is no export of simkit and is left alone")
            if not overwrite:
                raise _taken(f"{path} exists already and is not overwritten\n    help: --force replaces it")
        why = why_unwritable(path)
        if why:
            raise _taken(f"cannot write {path}: {why}")
    except (OSError, ValueError) as error:
        raise _taken(f"cannot write {path}: {getattr(error, 'strerror', None) or error}") from None


def _is_export(path: Path) -> bool:
    try:
        return bool(json.loads((path / INDEX).read_text(encoding="utf-8"))["made_by"] == _MARK)
    except (OSError, ValueError, KeyError, TypeError):
        return False


@contextmanager
def whole_folder(path: Path, *, overwrite: bool) -> Iterator[Path]:
    """A folder beside `path` to write to, which takes its place at the end; what a killed one left is tidied away.

    Raises:
        InputError: SK-BAG-013.
    """
    path = path.absolute()
    _tidy(path)
    check_folder(path, overwrite=overwrite)
    path.parent.mkdir(parents=True, exist_ok=True)
    draft = unfinished_folder(path.parent, path.name)
    try:
        draft.chmod(0o777 & ~_mask())
        yield draft
        if path.exists():
            old = unfinished_folder(path.parent, path.name)
            path.rename(old / _OLD)
            draft.rename(path)
            shutil.rmtree(old, ignore_errors=True)
        else:
            draft.rename(path)
    except OSError as error:
        raise _taken(f"cannot write {path}: {error.strerror or error}") from None
    finally:
        shutil.rmtree(draft, ignore_errors=True)


def _tidy(path: Path) -> None:
    """Takes away what killed exports left; one that was moved aside and never replaced goes back."""
    try:
        for left in left_folders(path.parent, path.name):
            if not path.exists() and _is_export(left / _OLD):
                (left / _OLD).rename(path)
            shutil.rmtree(left, ignore_errors=True)
    except OSError as error:
        raise _taken(f"cannot write {path}: {error.strerror or error}") from None


def write_index(folder: Path, rows: dict[str, object]) -> None:
    """The page that says what is where."""
    text = json.dumps({"made_by": _MARK, **rows}, indent=1, ensure_ascii=False)
    (folder / INDEX).write_text(text + "\n", encoding="utf-8", errors="replace")


def _mask() -> int:
    mask = os.umask(0o022)
    os.umask(mask)
    return mask


def _taken(text: str) -> InputError:
    return InputError(f"SK-BAG-013 {text}", "SK-BAG-013")
