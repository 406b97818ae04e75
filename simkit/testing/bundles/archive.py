"""Opens a bundle that may come from anywhere: everything in it is looked at before anything of it is used.

Opening reads; it runs nothing, and writes nothing but where it is told to extract.
"""

from __future__ import annotations

import hashlib
import json
import os
import re
import stat
import struct
import zipfile
import zlib
from collections.abc import Callable, Iterable, Iterator
from pathlib import Path, PurePosixPath
from typing import IO, Final

from simkit.errors import InputError
from simkit.run_spec import JsonObject
from simkit.testing.bundles.manifest import BAG, BROKEN, COMMANDS, PAGE, Manifest, read_manifest

MAX_FILES: Final = 20_000
MAX_BYTES: Final = 2 << 30
_MOST_PAGE: Final = 64 << 20  # of bundle.json
_MOST_INDEX: Final = 16 << 20  # of the archive's own table
_MOST_LINE: Final = 256 << 20  # of one entry of the journal
_HARMLESS, _MOST_RATIO = 64 << 20, 200  # bytes that may come of anything; what is more, of so many times its size
FOLDERS: Final = ("world", "spawn", "models", "params", "code")
_BAD_NAME, _TOO_LARGE = "SK-BUNDLE-003", "SK-BUNDLE-004"
_NAME: Final = re.compile(r"[^\x00-\x1f\x7f\\:*?\"<>|]+")
_END: Final = struct.Struct("<4s4H2LH")


def name_fault(name: str) -> str:
    """Why a name may not be that of a file in a bundle; empty where it may."""
    parts = name.split("/")
    if name.startswith("/") or not name:
        return "is an absolute path" if name else "is empty"
    if not _NAME.fullmatch(name):
        return "has characters that a file of a bundle may not have"
    if any(part in ("", ".", "..") for part in parts):
        return "leaves its folder"
    if len(name) > 1000 or any(len(part.encode(errors="replace")) > 240 for part in parts):
        return "is too long"
    if name not in (PAGE, COMMANDS, BAG, "error.txt") and (parts[0] not in FOLDERS or len(parts) < 2):
        return "is no part of a bundle"
    return ""


class Bundle:
    """An open bundle; a context manager.

    Attributes:
        path: what was opened.
        manifest: what it says of itself.

    Raises:
        InputError: SK-BUNDLE-001 it is none or is damaged, SK-BUNDLE-002 a later simkit made it, SK-BUNDLE-003 a file
            in it has a name that is refused, SK-BUNDLE-004 it is too large.
    """

    def __init__(self, path: str | os.PathLike[str]) -> None:
        self.path = Path(path)
        _check_index(self.path)
        try:
            self._zip = zipfile.ZipFile(self.path)
        except (zipfile.BadZipFile, OSError, ValueError, NotImplementedError, struct.error) as error:
            raise self._broken(str(error)) from None
        try:
            self._check_files()
            self.manifest: Manifest = read_manifest(self._whole(PAGE, _MOST_PAGE), str(self.path))
            self._check_manifest()
        except BaseException:
            self._zip.close()
            raise

    def __enter__(self) -> Bundle:
        return self

    def __exit__(self, *_: object) -> None:
        self.close()

    def close(self) -> None:
        """Closes the file."""
        self._zip.close()

    @property
    def brings_code(self) -> bool:
        """Whether there is code of plugins in it."""
        return bool(self.manifest.code)

    def read(self, name: str) -> bytes:
        """One of its files, whole.

        Raises:
            InputError: SK-BUNDLE-001 it is damaged, or there is none of that name.
        """
        if name not in self.manifest.files:
            raise self._broken(f"there is no {name}")
        data = self._whole(name, MAX_BYTES)
        self._compare(name, len(data), hashlib.sha256(data).hexdigest())
        return data

    def commands(self) -> Iterator[JsonObject]:
        """The entries of its journal, in order.

        Raises:
            InputError: SK-BUNDLE-001 it is damaged.
        """
        yield from map(self._entry, self._pieces(COMMANDS, lines=True))

    def extract(self, folder: Path, *, with_code: bool = False) -> None:
        """Writes its files below a folder, which has to be there and empty.

        Args:
            with_code: whether code of plugins is written too; nothing runs it here.

        Raises:
            InputError: SK-BUNDLE-001 it is damaged.
        """
        for name in self.manifest.files:
            if name.startswith("code/") and not with_code:
                continue
            target = folder.joinpath(*PurePosixPath(name).parts)
            target.parent.mkdir(parents=True, exist_ok=True)
            with target.open("xb") as file:
                file.writelines(self._pieces(name))

    # ------------------------------------------------------------------ what is looked at before

    def _check_files(self) -> None:
        infos = self._zip.infolist()
        total = sum(info.file_size for info in infos)
        if len(infos) > MAX_FILES:
            raise self._too_large(f"has {len(infos)} files, allowed are {MAX_FILES}")
        if total > MAX_BYTES:
            raise self._too_large(f"would become {total >> 20} MiB, allowed are {MAX_BYTES >> 20}")
        if total > max(_HARMLESS, _MOST_RATIO * self.path.stat().st_size):
            raise self._too_large(f"would become {total >> 20} MiB, more than {_MOST_RATIO} times its size")
        seen: dict[str, str] = {}
        folders: set[str] = set()
        for info in infos:
            why = name_fault(info.filename) or _kind_fault(info)
            folded = info.filename.casefold()
            if not why and folded in seen:
                why = f"is there twice (as {seen[folded]!r:.80})"
            if why:
                raise InputError(f"{_BAD_NAME} {self.path}: the file {info.filename!r:.80} {why}", _BAD_NAME)
            seen[folded] = info.filename
            folders.update(str(parent).casefold() for parent in PurePosixPath(info.filename).parents)
        both = sorted(folders & seen.keys())
        if both:
            raise InputError(f"{_BAD_NAME} {self.path}: {both[0]!r:.80} is a file and a folder", _BAD_NAME)

    def _check_manifest(self) -> None:
        said, there = self.manifest, {info.filename for info in self._zip.infolist()} - {PAGE}
        if there != said.files.keys():
            other = sorted(there ^ said.files.keys())[0]
            raise self._broken(f"{other!r:.80} is in the archive or in {PAGE}, and not in both")
        named: dict[str, Iterable[str]] = {
            "world": [said.world],
            "spawn": {one.file for one in said.spawn},
            "params": {file for _, file in said.params},
            "models": said.models.values(),
            "code": said.code,
        }
        for folder, files in named.items():
            for file in files:
                if file not in there or not file.startswith(f"{folder}/"):
                    raise self._broken(f"{PAGE} names {file!r:.80}, which is not among its files in {folder}/")
        if {f for f in there if f.startswith("code/")} != set(said.code):
            raise self._broken(f"{PAGE} does not name all code that is in it")
        if not {COMMANDS, BAG} <= there:
            raise self._broken(f"{COMMANDS} or {BAG} is not in it")

    # ------------------------------------------------------------------ reading

    def _opened(self, name: str) -> IO[bytes]:
        try:
            return self._zip.open(name)
        except (zipfile.BadZipFile, KeyError, OSError, NotImplementedError, RuntimeError, ValueError) as error:
            raise self._broken(str(error)) from None

    def _pieces(self, name: str, *, lines: bool = False) -> Iterator[bytes]:
        """A file piece by piece, or line by line; at its end it is compared with what the manifest says of it."""
        digest, size = hashlib.sha256(), 0
        with self._opened(name) as file:
            while piece := self._piece(file.readline, _MOST_LINE) if lines else self._piece(file.read, 1 << 20):
                digest.update(piece)
                size += len(piece)
                yield piece
        self._compare(name, size, digest.hexdigest())

    def _piece(self, read: Callable[[int], bytes], size: int) -> bytes:
        try:
            return read(size)
        except (zipfile.BadZipFile, zlib.error, EOFError, OSError, ValueError) as error:
            raise self._broken(str(error)) from None

    def _whole(self, name: str, most: int) -> bytes:
        with self._opened(name) as file:
            data = self._piece(file.read, most + 1)
        if len(data) > most:
            raise self._too_large(f"has a {name} of more than {most >> 20} MiB")
        return data

    def _entry(self, line: bytes) -> JsonObject:
        try:
            entry = json.loads(line)
        except (ValueError, RecursionError) as error:
            raise self._broken(f"{COMMANDS}: {error}") from None
        is_entry = isinstance(entry, dict) and isinstance(entry.get("do"), str)
        if not is_entry or type(entry.get("steps")) is not int or not 0 <= entry["steps"] < 1 << 62:
            raise self._broken(f"{COMMANDS}: found {entry!r:.80}, allowed is a mapping with 'steps' and 'do'")
        place, numbers = entry.get("in", [0, 0]), [entry.get("number", 0), entry.get("goal", 0)]
        if entry["do"] == "send_goal":
            numbers = [0]
        if not isinstance(place, list) or len(place) != 2 or not all(type(n) is int for n in (*place, *numbers)):
            raise self._broken(f"{COMMANDS}: the numbers of {entry!r:.80} are none")
        found: JsonObject = entry
        return found

    def _compare(self, name: str, size: int, digest: str) -> None:
        said = self.manifest.files[name]
        if (said["size"], said["sha256"]) != (size, digest):
            raise self._broken(f"{name} is not what {PAGE} says of it")

    def _broken(self, why: str) -> InputError:
        return InputError(f"{BROKEN} {self.path} is no bundle of simkit, or is damaged: {why}", BROKEN)

    def _too_large(self, why: str) -> InputError:
        return InputError(f"{_TOO_LARGE} {self.path} {why}", _TOO_LARGE)


def open_bundle(path: str | os.PathLike[str]) -> Bundle:
    """Opens a bundle; nothing in it is run.

    Raises:
        InputError: SK-BUNDLE-001 to SK-BUNDLE-004, as of `Bundle`.
    """
    return Bundle(path)


def _kind_fault(info: zipfile.ZipInfo) -> str:
    """Why an entry may not be in a bundle, whatever its name; empty where it may."""
    kind = stat.S_IFMT(info.external_attr >> 16)
    if kind not in (0, stat.S_IFREG):
        return "is a link, or no plain file"
    if info.flag_bits & 1:
        return "is encrypted"
    if info.compress_type not in (zipfile.ZIP_STORED, zipfile.ZIP_DEFLATED):
        return "is packed in a way that a bundle's files are not"
    return ""


def _check_index(path: Path) -> None:
    """Looks at how large the archive's own table is, before it is read as a whole.

    Raises:
        InputError: SK-BUNDLE-001 or SK-BUNDLE-004.
    """
    try:
        with path.open("rb") as file:
            size = file.seek(0, os.SEEK_END)
            file.seek(max(0, size - (1 << 16) - _END.size))
            tail = file.read()
    except (OSError, ValueError) as error:  # a ValueError is of a name that no file can have
        why = getattr(error, "strerror", None) or error
        raise InputError(f"{BROKEN} cannot read {path}: {why}", BROKEN) from None
    at = tail.rfind(b"PK\5\6")
    if at < 0 or len(tail) - at < _END.size:
        raise InputError(f"{BROKEN} {path} is no bundle of simkit (no ZIP archive, or one that breaks off)", BROKEN)
    _, _, _, _, count, length, offset, _ = _END.unpack_from(tail, at)
    if count > MAX_FILES or length > _MOST_INDEX or offset == 0xFFFFFFFF:
        raise InputError(f"{_TOO_LARGE} {path} has more files than a bundle may have ({MAX_FILES})", _TOO_LARGE)
