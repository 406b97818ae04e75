"""Folders of models and worlds in the cache: unpacked, recorded with their checksum, and put in place at once."""

from __future__ import annotations

import hashlib
import json
import math
import os
import shutil
import time
import zipfile
import zlib
from collections.abc import Iterator
from contextlib import contextmanager, suppress
from dataclasses import dataclass, replace
from io import BufferedRandom
from pathlib import Path, PurePosixPath

from simkit import file_lock, progress
from simkit.extend import Diagnostics
from simkit.input_file import open_input, read_input_text
from simkit.json_reader import parse_json
from simkit.loaders.resources.bundled_models import builtin_model
from simkit.loaders.resources.fuel_cache import TIP, FuelUrl
from simkit.loaders.resources.uris import split_rest
from simkit.loaders.resources.xml_reader import parse_file
from simkit.output_file import open_regular
from simkit.trusted_folders import OutsideError, join_below
from simkit.writers.atomic_output import current_umask, remove_abandoned, unfinished_folder
from simkit.writers.vendored_folder import file_elements, replace_uris
from simkit.writers.zip_archive import RefusedArchiveError, open_archive
from simkit_fuel.download import NETWORK, DownloadError

BAD_ARCHIVE = "SK-FETCH-004"
STAGE = ".simkit-fetch"
_RECORD = ".simkit-fetch.json"
_CHUNK = 1 << 20  # [bytes]
_LOCK_INTERVAL = 0.05  # [s] between two attempts to lock a file


@dataclass(frozen=True)
class Record:
    """Checksum and size [bytes] of the ZIP archive from which a folder of the cache was unpacked."""

    sha256: str
    size: int


@contextmanager
def exclusive_file(path: Path, end: float = math.inf) -> Iterator[BufferedRandom]:
    """Open a file for reading and appending, when no other process or thread has it open this way.

    Args:
        path: file, which is created.
        end: time of `time.monotonic` at which the wait for the other process ends.

    Raises:
        DownloadError: SK-FETCH-006 the other process does not end in time.
        OSError: the file cannot be written.
    """
    while True:
        path.parent.mkdir(parents=True, exist_ok=True)
        with open_regular(path) as file:
            _wait_for_lock(file, end)
            if file_lock.is_same_file(file.fileno(), path):  # else another process has removed it
                yield file
                return


def _wait_for_lock(file: BufferedRandom, end: float) -> None:
    """Lock a file until it is closed. Some file systems have no such lock."""
    with suppress(OSError):
        if file_lock.try_lock(file.fileno()):
            return
        with progress.task("waiting for another simkit fetch"):
            while time.monotonic() < end:
                if file_lock.try_lock(file.fileno()):
                    return
                time.sleep(_LOCK_INTERVAL)
        message = "another simkit fetch downloads it and has not ended in time (--max-time)"
        raise DownloadError(NETWORK, message, "end the other one, or wait for its end")


def archive_record(file: BufferedRandom) -> Record:
    """Return the checksum and the size of an archive."""
    file.seek(0)
    digest = hashlib.file_digest(file, "sha256").hexdigest()
    return Record(digest, file.seek(0, os.SEEK_END))


def store(file: BufferedRandom, record: Record, url: FuelUrl, cache: Path, most: int) -> Path:
    """Unpack an archive and put its folder into the cache; an older folder of the same version is replaced.

    Args:
        file: the archive.
        record: its checksum and size.
        url: URL of the resource with the number of its version.
        cache: folder of the cache.
        most: largest sum of the unpacked sizes [bytes].

    Raises:
        DownloadError: SK-FETCH-004 the archive is damaged or dangerous.
        OSError: the cache is not writable.
    """
    target = url.folders(cache)[0] / url.version
    remove_abandoned(cache / STAGE, "unpacked")
    stage = unfinished_folder(cache / STAGE, "unpacked")
    try:
        new = stage / "new"
        new.mkdir()
        _unpack(file, new, most)
        _resolve_model_uris(new, url)
        content = {"sha256": record.sha256, "size": record.size, "content": _content_hash(new)}
        (new / _RECORD).write_text(json.dumps(content) + "\n", encoding="utf-8")
        new.chmod(0o777 & ~current_umask())
        target.parent.mkdir(parents=True, exist_ok=True)
        if target.exists():
            target.rename(stage / "old")
        new.rename(target)
    finally:
        shutil.rmtree(stage, ignore_errors=True)
    return target


def read_record(folder: Path) -> Record | None:
    """Return the record of a folder in the cache; None if Gazebo stored the folder, or if its files have changed."""
    try:
        values = parse_json(read_input_text(folder / _RECORD, 1 << 16))
        record = Record(str(values["sha256"]), int(values["size"]))
        return record if values["content"] == _content_hash(folder) else None
    except (OSError, ValueError, KeyError, TypeError):
        return None


def _content_hash(folder: Path) -> str:
    """Return a hash of the names and the contents of all files in a folder."""
    digest = hashlib.sha256()
    for path in sorted(p for p in folder.rglob("*") if not p.is_dir()):
        name = path.relative_to(folder).as_posix()
        if name != _RECORD:
            with open_input(path) as file:
                digest.update(f"{len(name)} {name} {hashlib.file_digest(file, 'sha256').hexdigest()}\n".encode())
    return digest.hexdigest()


def _unpack(file: BufferedRandom, folder: Path, most: int) -> None:
    """Write the files of an archive below a folder, after all names and sizes are checked."""
    try:
        with open_archive(file, most) as archive:
            for info in archive.infolist():
                if not info.is_dir():
                    target = folder.joinpath(*PurePosixPath(info.filename).parts)
                    target.parent.mkdir(parents=True, exist_ok=True)
                    with archive.open(info) as source, target.open("xb") as output:
                        shutil.copyfileobj(source, output, _CHUNK)
    except RefusedArchiveError as error:
        raise _bad_archive(str(error) if error.kind == "name" else f"it {error}") from None
    except (zipfile.BadZipFile, zlib.error, EOFError, NotImplementedError, RuntimeError, ValueError) as error:
        raise _bad_archive(f"it is damaged: {error}") from None


def _bad_archive(reason: str) -> DownloadError:
    hint = "nothing of it is stored; tell the owner of the model, or try again later"
    return DownloadError(BAD_ARCHIVE, f"the archive is refused: {reason:.300}", hint)


def _resolve_model_uris(folder: Path, url: FuelUrl) -> None:
    """Replace `model://NAME/...` in the SDF files by Fuel URLs, as Gazebo does when it stores a model.

    A name on Fuel is a model of the same owner, and the folder in the cache has the number of a version as its name.
    """
    for path in sorted(folder.rglob("*.sdf")):
        document = parse_file(path, Diagnostics())
        if document is None:
            continue
        texts = {element.value for element, _ in file_elements(document.root) if element.value.startswith("model://")}
        changes = {text: str(new) for text in sorted(texts) if (new := _fuel_url(text, folder, url)) is not None}
        if changes:
            path.write_bytes(replace_uris(document.text, changes))


def _fuel_url(text: str, folder: Path, url: FuelUrl) -> FuelUrl | None:
    """Return the Fuel URL of a `model://` URI in a downloaded model; None if the URI stays as it is."""
    try:
        name, inside = split_rest(text.removeprefix("model://").rstrip("/"))
        if builtin_model(text) is not None or not name:
            return None
        inside = "" if inside == "." else inside
        full_path, part = join_below(folder, f"{name}/{inside}"), join_below(folder, inside)
    except OutsideError:
        return None
    if full_path.exists():
        return replace(url, inside=full_path.relative_to(folder).as_posix())
    if name.lower() == url.name.lower() or (inside and part.exists()):
        return replace(url, inside=inside)
    return replace(url, kind="models", name=name, version=TIP, inside=inside)
