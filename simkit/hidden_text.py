"""Files whose text no message shows, because a symbolic link leads to them out of the folders that the user chose.

A person who sends a folder could put a link to a private file of the user into it. A message about that file would
print its content, for example in the public log of a CI system. Every error and diagnostic about such a file has only
its code and its place. In a command, this holds for each message after the file was read, because a later message can
quote it too. This module imports nothing of simkit, so errors can use it.
"""

from __future__ import annotations

import os
import re
from collections.abc import Iterator
from contextlib import contextmanager
from typing import Final

_CODE: Final = re.compile(r"SK-[A-Z]+-\d{3}")
_files: dict[str, str] = {}  # path as messages show it -> folder of the file that the link leads to
_is_everywhere = False


def hide(path: str, folder: str) -> None:
    """Hide the text of a file from now on.

    Args:
        path: path of the file or folder, as messages show it.
        folder: folder that the link leads to, or folder of the file that it leads to.
    """
    for shown in (os.path.realpath(path), path):  # a reader can resolve the path
        _files.pop(shown, None)
        _files[shown] = folder


def show(path: str) -> None:
    """Show the text of a file again, because the user has chosen its folder since."""
    for shown in (os.path.realpath(path), path):
        _files.pop(shown, None)


def hide_everywhere() -> None:
    """Hide the text in every message of this process, not only in messages that name a hidden file."""
    global _is_everywhere
    _is_everywhere = True


@contextmanager
def hidden_in_command() -> Iterator[None]:
    """Hide the text of the files that a command reads in every message of the command."""
    global _is_everywhere
    if _is_everywhere:
        yield
        return
    before = dict(_files)  # a file that this process read before the command says nothing about the command
    _files.clear()
    _is_everywhere = True
    try:
        yield
    finally:
        _is_everywhere = False
        _files.clear()
        _files.update(before)


def is_hiding() -> bool:
    """Check whether the text of any file is hidden."""
    return bool(_files)


def hides(text: str, file: str | None = None) -> bool:
    """Check whether a message may show text of a hidden file.

    Args:
        text: message.
        file: file that the message is about; None if it is unknown.
    """
    if not _files:
        return False
    return _is_everywhere or any(path in text or path in (file or "") for path in _files)


def place_without_text(file: str | None, line: int | None) -> tuple[str | None, int | None]:
    """Return the place of a problem; a name that is no file can be text of a hidden file, and is replaced."""
    if file is None or file in _files or os.path.exists(file):  # noqa: PTH110 (a long name is no error)
        return file, line
    return next(reversed(_files)), None


def message_without_text(code: str) -> tuple[str, str]:
    """Return the message and the help of a problem that is shown without text of files."""
    path, folder = next(reversed(_files.items()))
    message = f"the text of {path} is not shown, because a symbolic link leads from it out of the chosen folders"
    hint = f"set SIMKIT_RESOURCE_PATH={folder} to choose its folder and to see the text"
    return message, f"{hint}; `simkit explain {code}` describes the problem" if code else hint


def error_without_text(text: str) -> str:
    """Return the text of an error with its code and, if the error is in a hidden file, with its line."""
    match = _CODE.search(text)
    code = match[0] if match else ""
    lines = (re.search(re.escape(path) + r":(\d+)", text) for path in reversed(_files))
    place = next((line[0] for line in lines if line is not None), "")
    message, hint = message_without_text(code)
    return f"{place + ': ' if place else ''}{code + ' ' if code else ''}{message}\n    help: {hint}"
