"""Files of a lab: which of them the student hands in, and a copy of the lab with these files."""

from __future__ import annotations

import shutil
from collections.abc import Iterator, Sequence
from itertools import islice
from pathlib import Path
from typing import Final

from simkit.errors import InputError
from simkit.input_file import read_input
from simkit.trusted_folders import TrustedFolders

SOLUTION: Final = "solution"
_CACHE: Final = "__pycache__"
_MOST_MODULES: Final = 200  # further Python modules of a hand-in
_LARGEST: Final = 16 << 20  # bytes of a file of a hand-in
_MOST_FILES: Final = 2000  # files of a lab, and files of a student's folder that are looked at
_DEEPEST: Final = 3  # levels of folders with further Python modules


def hand_in_files(lab: Path, named: Sequence[str]) -> list[str]:
    """Return the files that a student of a lab completes, relative to its folder.

    They are those that the solution replaces; without a solution, those that the exercises name.

    Args:
        lab: Folder of the lab.
        named: Files that the exercises name.
    """
    solution = lab / SOLUTION
    return sorted({*named, *(_relative(file, solution) for file in _files_below(solution))} - {""})


def changed_files(lab: Path, folder: Path, hand_in: Sequence[str]) -> list[str]:
    """Return the files that a student changed and that are not part of the hand-in, except texts and pictures."""
    changed = []
    for file in _files_below(lab):
        name = _relative(file, lab)
        student_file = folder / name
        is_graded = name not in hand_in and not name.startswith(SOLUTION) and file.suffix not in (".md", ".png", ".svg")
        if (
            is_graded
            and student_file.is_file()
            and TrustedFolders([folder]).allows(student_file)
            and not _are_equal(file, student_file)
        ):
            changed.append(name)
    return changed


def replaced_modules(hand_in: Path, folders: Sequence[Path]) -> list[str]:
    """Return the modules beside a plugin that have the name of a module of the exercise, but another content.

    Args:
        hand_in: File of the plugin.
        folders: Folders of the exercise's modules.
    """
    beside = [file for file in hand_in.parent.glob("*.py") if file.name != hand_in.name]
    pairs = [(file, folder / file.name) for file in beside for folder in folders]
    return [file.name for file, student_file in pairs if student_file.is_file() and not _are_equal(student_file, file)]


def copy_lab(lab: Path, folder: Path, hand_in: Sequence[str], target: Path) -> list[Path]:
    """Copy a lab to a new folder with the files of a hand-in; return the files of the hand-in in the copy.

    Further Python modules of the student's folder are copied too, unless the lab has a module of the same name.

    Args:
        lab: Folder of the lab.
        folder: Folder of the student.
        hand_in: Files that the student completes, relative to the folder.
        target: New folder.

    Raises:
        InputError: SK-URI-003 a file of the hand-in is a symbolic link out of the folder; SK-SCEN-007 the folder of the
            lab has too many files; or a file is too large.
    """
    if sum(1 for _ in _files_below(lab)) >= _MOST_FILES:
        raise InputError(
            "SK-SCEN-007", f"{lab} has more than {_MOST_FILES} files", help="give the lab a folder of its own"
        )
    shutil.copytree(lab, target, ignore=shutil.ignore_patterns(SOLUTION, _CACHE, ".*"))
    names = [name for name in hand_in if (folder / name).is_file()]
    copied = []
    for name in dict.fromkeys((*names, *_further_modules(lab, folder))):
        file = target / name
        file.parent.mkdir(parents=True, exist_ok=True)
        file.write_bytes(_content(folder, name))
        copied.append(file)
    return copied


def _content(folder: Path, name: str) -> bytes:
    """Return the content of a file of the hand-in."""
    file, trusted = folder / name, TrustedFolders([folder])
    if not trusted.allows(file):
        message = f"{trusted.refusal(file)}"
        raise InputError("SK-URI-003", message, help=f"copy the file into {folder}")
    return read_input(file, _LARGEST)


def _further_modules(lab: Path, folder: Path) -> Iterator[str]:
    """Yield the Python modules that a student added; none of them replaces a module of the lab."""
    lab_modules = {_module(_relative(file, lab)) for file in _files_below(lab)}
    count, trusted = 0, TrustedFolders([folder])
    for file in _files_below(folder, _DEEPEST):
        name = _relative(file, folder)
        parents = {_module(parent.as_posix()) for parent in Path(name).parents}
        is_new = file.suffix == ".py" and _module(name) not in lab_modules and not parents & lab_modules
        if is_new and file.is_file() and trusted.allows(file):
            count += 1
            if count > _MOST_MODULES:
                return
            yield name


def _module(name: str) -> str:
    """Return the path of a file without the suffixes of its name, as an import finds it."""
    path = Path(name)
    return path.with_name(path.name.partition(".")[0] or path.name).as_posix() if path.name else ""


def _files_below(folder: Path, depth: int = 10) -> Iterator[Path]:
    """Yield the files below a folder, sorted, at most 2000; hidden folders and links to folders are left out."""
    return islice(_all_files_below(folder, depth), _MOST_FILES)


def _all_files_below(folder: Path, depth: int) -> Iterator[Path]:
    entries = sorted(folder.iterdir()) if folder.is_dir() else []
    for entry in entries:
        if entry.is_dir():
            if depth > 0 and not entry.is_symlink() and not entry.name.startswith((".", _CACHE)):
                yield from _all_files_below(entry, depth - 1)
        else:
            yield entry


def _relative(file: Path, folder: Path) -> str:
    return file.relative_to(folder).as_posix()


def _are_equal(file: Path, other: Path) -> bool:
    """Compare two files, except the ends of their lines."""
    first, second = (read_input(path, _LARGEST).replace(b"\r\n", b"\n") for path in (file, other))
    return first == second
