"""Checks of ZIP archives from untrusted sources. They read only the list of files, before a file is unpacked."""

from __future__ import annotations

import os
import re
import stat
import struct
import zipfile
from collections.abc import Callable, Iterable
from pathlib import PurePosixPath
from typing import BinaryIO, Final

MAX_FILES: Final = 20_000
MAX_INDEX_BYTES: Final = 16 << 20  # limit for the list of files at the end of the archive
# A small archive may unpack to 64 MiB. A larger one may unpack to at most 200 times its size on disk.
_ALWAYS_ALLOWED_BYTES, _MAX_RATIO = 64 << 20, 200
_NAME: Final = re.compile(r"[^\x00-\x1f\x7f\\:*?\"<>|]+")
_END: Final = struct.Struct("<4s4H2LH")


def index_fault(file: BinaryIO) -> tuple[str, bool]:
    """Check the size of an archive's list of files before the list is read.

    Returns:
        Reason for refusing the archive, empty if there is none, and true if the archive has too many files.

    Raises:
        OSError: the file cannot be read.
    """
    size = file.seek(0, os.SEEK_END)
    file.seek(max(0, size - (1 << 16) - _END.size))
    tail = file.read()
    at = tail.rfind(b"PK\5\6")
    if at < 0 or len(tail) - at < _END.size:
        return "not a ZIP archive, or truncated", False
    _, _, _, _, count, length, offset, _ = _END.unpack_from(tail, at)
    is_large = count > MAX_FILES or length > MAX_INDEX_BYTES or offset == 0xFFFFFFFF
    return (f"more than {MAX_FILES} files" if is_large else ""), is_large


def size_fault(infos: Iterable[zipfile.ZipInfo], archive_size: int, most: int) -> str:
    """Return the reason why an archive would unpack to too much; empty if it may be unpacked.

    Args:
        infos: files of the archive.
        archive_size: size of the archive [bytes].
        most: largest sum of the unpacked sizes [bytes].
    """
    sizes = [info.file_size for info in infos]
    total = sum(sizes)
    if len(sizes) > MAX_FILES:
        return f"has {len(sizes)} files; the limit is {MAX_FILES}"
    if total > most:
        return f"would unpack to {total >> 20} MiB; the limit is {most >> 20} MiB"
    if total > max(_ALWAYS_ALLOWED_BYTES, _MAX_RATIO * archive_size):
        return f"would unpack to {total >> 20} MiB, more than {_MAX_RATIO} times its size"
    return ""


def name_fault(name: str) -> str:
    """Return the reason why an archive must not contain a file of this name; empty if the name is allowed."""
    parts = name.split("/")
    if name.startswith("/") or not name:
        return "is an absolute path" if name else "is empty"
    if not _NAME.fullmatch(name):
        return "has characters that are not allowed in file names"
    if any(part in ("", ".", "..") for part in parts):
        return "leads out of its folder"
    if len(name) > 1000 or any(len(part.encode(errors="replace")) > 240 for part in parts):
        return "is too long"
    return ""


def kind_fault(info: zipfile.ZipInfo) -> str:
    """Return the reason why an archive must not contain an entry of this kind; empty if the kind is allowed."""
    kind = stat.S_IFMT(info.external_attr >> 16)
    if kind not in (0, stat.S_IFREG):
        return "is a link or not a regular file"
    if info.flag_bits & 1:
        return "is encrypted"
    if info.compress_type not in (zipfile.ZIP_STORED, zipfile.ZIP_DEFLATED):
        return "uses an unsupported compression method"
    return ""


def files_fault(infos: Iterable[zipfile.ZipInfo], check_name: Callable[[str], str] = name_fault) -> str:
    """Return the first file of an archive that is not allowed, with the reason; empty if all are allowed.

    Names that differ only in upper and lower case are duplicates, because some file systems do not distinguish them.
    """
    seen: dict[str, str] = {}
    folders: set[str] = set()
    for info in infos:
        problem = check_name(info.filename) or kind_fault(info)
        folded = info.filename.casefold()
        if not problem and folded in seen:
            problem = f"is a duplicate (of {seen[folded]!r:.80})"
        if problem:
            return f"the file {info.filename!r:.80} {problem}"
        seen[folded] = info.filename
        folders.update(str(parent).casefold() for parent in PurePosixPath(info.filename).parents)
    both = sorted(folders & seen.keys())
    return f"{both[0]!r:.80} is both a file and a folder" if both else ""
