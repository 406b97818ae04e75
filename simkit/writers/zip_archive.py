"""ZIP archives from untrusted sources: the list of files is bounded and checked before a file is unpacked."""

from __future__ import annotations

import os
import re
import stat
import struct
import zipfile
from collections.abc import Callable, Iterable
from typing import IO, BinaryIO, Final, Literal, cast

from simkit.number_text import counted

MAX_FILES: Final = 20_000
"""Limit for the files of an archive, and for its folders."""
MAX_INDEX_BYTES: Final = 16 << 20
"""Limit for the list of files at the end of an archive."""
# A small archive may unpack to 64 MiB. A larger one may unpack to at most 200 times its size on disk.
_ALWAYS_ALLOWED_BYTES, _MAX_RATIO = 64 << 20, 200
_NAME: Final = re.compile(r"[^\x00-\x1f\x7f\\:*?\"<>|]+")
_ENTRY_MARK: Final = b"PK\1\2"  # at the beginning of each entry in the list of files
_LOCAL_HEADER_BYTES: Final = 30  # without the name, which follows


class RefusedArchiveError(Exception):
    """The archive is not opened.

    Attributes:
        kind: `damaged` if it is not a ZIP archive or is truncated, `large` if it exceeds a limit, `name` if it contains
            a file that is not allowed.
    """

    def __init__(self, kind: Literal["damaged", "large", "name"], reason: str) -> None:
        super().__init__(reason)
        self.kind = kind


def open_archive(file: BinaryIO, most: int, check_name: Callable[[str], str] | None = None) -> zipfile.ZipFile:
    """Open a ZIP archive whose number of files, names and sizes are within the limits. Nothing is unpacked.

    Args:
        file: the archive, which stays open when the returned object is closed.
        most: largest sum of the unpacked sizes [bytes].
        check_name: function that returns the reason why a file must not have a name; `name_fault` by default.

    Raises:
        RefusedArchiveError: the archive is damaged, too large or dangerous.
    """
    bounded = _BoundedIndex(file)
    try:
        archive = zipfile.ZipFile(cast("IO[bytes]", bounded))
    except (zipfile.BadZipFile, OSError, ValueError, OverflowError, NotImplementedError, struct.error) as error:
        raise RefusedArchiveError("damaged", f"is not a ZIP archive, or is damaged: {error}") from None
    bounded.is_index_read = True
    infos = archive.infolist()
    if problem := size_fault(infos, file.seek(0, os.SEEK_END), most):
        raise RefusedArchiveError("large", problem)
    if problem := _overlap_fault(infos, archive.start_dir):
        raise RefusedArchiveError("damaged", problem)
    if problem := files_fault(infos, check_name or name_fault):
        raise RefusedArchiveError("name", problem)
    return archive


class _BoundedIndex:
    """File of an archive that refuses to read too long a list of files.

    `zipfile` reads the list as a whole and keeps an object of about 700 bytes for each entry. It finds the list by the
    end record or by the ZIP64 end record, and ignores the numbers of files in both. The list is therefore checked in
    the moment in which `zipfile` reads it.
    """

    def __init__(self, file: BinaryIO) -> None:
        self.is_index_read = False
        self._file = file

    def read(self, size: int = -1) -> bytes:
        if self.is_index_read:
            return self._file.read(size)
        data = self._file.read(size if 0 <= size <= MAX_INDEX_BYTES else MAX_INDEX_BYTES + 1)
        if len(data) > MAX_INDEX_BYTES or data.count(_ENTRY_MARK) > MAX_FILES:
            raise RefusedArchiveError("large", f"has more than {MAX_FILES} files")
        return data

    def __getattr__(self, name: str) -> object:
        return getattr(self._file, name)


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
        return f"has {counted(len(sizes), 'file')}; the limit is {MAX_FILES}"
    if total > most:
        return f"would unpack to {total >> 20} MiB; the limit is {most >> 20} MiB"
    if total > max(_ALWAYS_ALLOWED_BYTES, _MAX_RATIO * archive_size):
        return f"would unpack to {total >> 20} MiB, more than {_MAX_RATIO} times its size"
    return ""


def _overlap_fault(infos: Iterable[zipfile.ZipInfo], end: int) -> str:
    """Return the reason if two files share bytes of the archive, or reach into the list of files at `end`."""
    for info in sorted(infos, key=lambda info: info.header_offset, reverse=True):
        length = _LOCAL_HEADER_BYTES + len(info.orig_filename) + info.compress_size
        if info.header_offset < 0 or info.header_offset + length > end:
            return f"is damaged: the content of {info.filename!r:.80} overlaps another file"
        end = info.header_offset
    return ""


def name_fault(name: str) -> str:
    """Return the reason why an archive must not contain a file of this name; empty if the name is allowed."""
    parts = name.split("/")
    if name.startswith("/") or not name:
        return "is an absolute path" if name else "has no name"
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
    if kind not in (0, stat.S_IFDIR if info.is_dir() else stat.S_IFREG):
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
        name = info.filename.removesuffix("/")
        is_folder = info.filename.endswith("/")  # `ZipInfo.is_dir` fails on an empty name
        problem = check_name(name) or kind_fault(info)
        folded = name.casefold()
        if not problem and folded in seen and not is_folder:
            problem = f"is a duplicate (of {seen[folded]!r:.80})"
        if problem:
            return f"the {'folder' if is_folder else 'file'} {name!r:.80} {problem}"
        if is_folder:
            folders.add(folded)
        else:
            seen[folded] = name
        at = folded.rfind("/")
        while at > 0 and folded[:at] not in folders:
            folders.add(folded[:at])
            at = folded.rfind("/", 0, at)
        if len(folders) > MAX_FILES:  # a name of 1000 characters can hold 500 of them
            return f"the file {name!r:.80} is in one of more than {MAX_FILES} folders"
    both = sorted(folders & seen.keys())
    return f"{both[0]!r:.80} is both a file and a folder" if both else ""
