"""Reader for bundles from untrusted sources: the whole archive is validated before any file in it is used.

Opening a bundle runs none of its code. Files are written only by `Bundle.extract`, and only below the given folder.
"""

from __future__ import annotations

import hashlib
import os
import zipfile
import zlib
from collections.abc import Callable, Iterator
from pathlib import Path, PurePosixPath
from typing import IO, Final

from simkit.errors import InputError
from simkit.input_file import open_input, read_failure
from simkit.json_reader import parse_json
from simkit.run_spec import JsonObject
from simkit.writers import zip_archive
from simkit.writers.zip_archive import RefusedArchiveError, open_archive
from simkit_verification.testing.bundles.manifest import (
    BAG,
    BROKEN,
    COMMANDS,
    PAGE,
    Manifest,
    packed_fields,
    packed_folder,
    read_manifest,
)

MAX_BYTES: Final = 2 << 30
_MAX_PAGE_BYTES: Final = 64 << 20  # limit for bundle.json
_MAX_LINE_BYTES: Final = 256 << 20  # limit for one entry of the journal
FOLDERS: Final = (
    *("world", "models", "code", "interfaces"),
    *(packed_folder(name) for name, one in packed_fields().items() if one.kind.has_files),
)
_BAD_NAME, _TOO_LARGE = "SK-BUNDLE-003", "SK-BUNDLE-004"


def name_fault(name: str) -> str:
    """Return the reason why a bundle must not contain a file of this name; empty if the name is allowed."""
    problem = zip_archive.name_fault(name)
    if problem:
        return problem
    parts = name.split("/")
    if name not in (PAGE, COMMANDS, BAG, "error.txt") and (parts[0] not in FOLDERS or len(parts) < 2):
        return "is not a file that a bundle can contain"
    return ""


class Bundle:
    """Open bundle; a context manager.

    Attributes:
        path: File that was opened.
        manifest: Contents of the file `bundle.json`.

    Raises:
        InputError: SK-BUNDLE-001 the file is not a bundle or is damaged; SK-BUNDLE-002 a newer simkit wrote the bundle;
            SK-BUNDLE-003 a file in the bundle has a name that is not allowed; SK-BUNDLE-004 the bundle is too large.
    """

    def __init__(self, path: str | os.PathLike[str]) -> None:
        self.path = Path(path)
        try:
            self._file = open_input(self.path)
        except (OSError, ValueError) as error:  # a ValueError means that the path contains a null character
            raise InputError(BROKEN, f"cannot read {self.path}: {read_failure(error)}") from None
        try:
            self._zip = self._open_zip()
            self.manifest: Manifest = read_manifest(self._whole(PAGE, _MAX_PAGE_BYTES), str(self.path))
            self._check_manifest()
        except BaseException:
            self._file.close()
            raise

    def __enter__(self) -> Bundle:
        return self

    def __exit__(self, *_: object) -> None:
        self.close()

    def close(self) -> None:
        """Close the archive."""
        self._zip.close()
        self._file.close()

    @property
    def brings_code(self) -> bool:
        """True if the bundle contains Python code of plugins."""
        return bool(self.manifest.code)

    def read(self, name: str) -> bytes:
        """Return the content of one file in the bundle.

        Raises:
            InputError: SK-BUNDLE-001 the file is damaged or missing.
        """
        if name not in self.manifest.files:
            raise self._broken(f"there is no {name}")
        data = self._whole(name, MAX_BYTES)
        self._compare(name, len(data), hashlib.sha256(data).hexdigest())
        return data

    def commands(self) -> Iterator[JsonObject]:
        """Iterate over the journal entries in their recorded order.

        Raises:
            InputError: SK-BUNDLE-001 the journal is damaged.
        """
        yield from map(self._entry, self._pieces(COMMANDS, lines=True))

    def extract(self, folder: Path, *, with_code: bool = False) -> None:
        """Write the files of the bundle below a folder.

        Args:
            folder: Existing, empty folder.
            with_code: Include the code of plugins. This method does not run the code.

        Raises:
            InputError: SK-BUNDLE-001 a file is damaged.
        """
        for name in self.manifest.files:
            if name.startswith("code/") and not with_code:
                continue
            target = folder.joinpath(*PurePosixPath(name).parts)
            target.parent.mkdir(parents=True, exist_ok=True)
            file = target.open("xb")
            try:
                with file:
                    file.writelines(self._pieces(name))
            except InputError:
                target.unlink()
                raise

    # ------------------------------------------------------------------ validation

    def _open_zip(self) -> zipfile.ZipFile:
        try:
            return open_archive(self._file, MAX_BYTES, name_fault)
        except RefusedArchiveError as error:
            if error.kind == "damaged":
                raise InputError(BROKEN, f"{self.path} is not a simkit bundle: it {error}") from None
            if error.kind == "large":
                raise self._too_large(str(error)) from None
            raise InputError(_BAD_NAME, f"{self.path}: {error}") from None

    def _check_manifest(self) -> None:
        manifest, there = self.manifest, {info.filename for info in self._zip.infolist()} - {PAGE}
        if there != manifest.files.keys():
            missing = sorted(there ^ manifest.files.keys())[0]
            raise self._broken(f"{missing!r:.80} is missing in the archive or in {PAGE}")
        named: dict[str, list[str]] = {
            "world": [manifest.run.world],
            "models": list(manifest.models.values()),
            "code": list(manifest.code),
        }
        for file_name in manifest.run.files():
            named.setdefault(packed_folder(str(file_name.keys[0])), []).append(file_name.text)
        for folder, files in named.items():
            for file in files:
                if file not in there or not file.startswith(f"{folder}/"):
                    raise self._broken(f"{PAGE} names {file!r:.80}, which is not a file in {folder}/")
        if {f for f in there if f.startswith("code/")} != set(manifest.code):
            raise self._broken(f"{PAGE} does not list all files in code/")
        if not {COMMANDS, BAG} <= there:
            raise self._broken(f"{COMMANDS} or {BAG} is missing")

    # ------------------------------------------------------------------ reading

    def _opened(self, name: str) -> IO[bytes]:
        try:
            return self._zip.open(name)
        except (zipfile.BadZipFile, KeyError, OSError, NotImplementedError, RuntimeError, ValueError) as error:
            raise self._broken(str(error)) from None

    def _pieces(self, name: str, *, lines: bool = False) -> Iterator[bytes]:
        """Read a file in pieces or lines, then compare its size and hash with the manifest."""
        digest, size = hashlib.sha256(), 0
        with self._opened(name) as file:
            while piece := self._piece(file.readline, _MAX_LINE_BYTES) if lines else self._piece(file.read, 1 << 20):
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
            entry = parse_json(line)
        except ValueError as error:
            raise self._broken(f"{COMMANDS}: {error}") from None
        is_entry = isinstance(entry, dict) and isinstance(entry.get("do"), str)
        if not is_entry or type(entry.get("steps")) is not int or not 0 <= entry["steps"] < 1 << 62:
            raise self._broken(f"{COMMANDS}: {entry!r:.80} is not a mapping with 'steps' and 'do'")
        place, numbers = entry.get("in", [0, 0]), [entry.get("number", 0), entry.get("goal", 0)]
        if entry["do"] == "send_goal":
            numbers = [0]
        if not isinstance(place, list) or len(place) != 2 or not all(type(n) is int for n in (*place, *numbers)):
            raise self._broken(f"{COMMANDS}: {entry!r:.80} has an invalid number")
        checked_entry: JsonObject = entry
        return checked_entry

    def _compare(self, name: str, size: int, digest: str) -> None:
        listed = self.manifest.files[name]
        if (listed["size"], listed["sha256"]) != (size, digest):
            raise self._broken(f"{name} does not have the size and hash that {PAGE} lists")

    def _broken(self, reason: str) -> InputError:
        return InputError(BROKEN, f"{self.path} is not a simkit bundle or is damaged: {reason:.300}")

    def _too_large(self, reason: str) -> InputError:
        return InputError(_TOO_LARGE, f"{self.path} {reason}")


def open_bundle(path: str | os.PathLike[str]) -> Bundle:
    """Open a bundle without running anything in it.

    Raises:
        InputError: SK-BUNDLE-001 to SK-BUNDLE-004, see `Bundle`.
    """
    return Bundle(path)
