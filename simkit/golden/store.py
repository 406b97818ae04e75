"""Golden runs on disk: a folder with `golden.json` to read and one file of data.

`golden.json` names the data it belongs to by its hash. The data are written first and `golden.json` is put in place
last, in one go: at whatever moment the writing is cut off, what is there is the old golden run or the new one.
"""

from __future__ import annotations

import hashlib
import json
import os
import re
from collections.abc import Iterator, Mapping, Sequence
from contextlib import contextmanager, suppress
from pathlib import Path
from typing import Any, Final

from simkit.errors import InputError
from simkit.golden.contents import about_record, record_of
from simkit.golden.packing import PackingError
from simkit.golden.record import Record
from simkit.golden.written import plain_scenario, scenario_from

FORMAT: Final = 1
MAIN: Final = "golden.json"
_DATA: Final = re.compile(r"data-[0-9a-f]{12}\.xz")
_LEFT: Final = re.compile(r"\.golden-\d+\.tmp")
_MOST_TEXT: Final = 16 << 20  # [bytes] of golden.json
_MOST_DATA: Final = 256 << 20
_TRIALS: Final = 20  # of reading a golden run that others write at the same time
_MOST_BLESSED: Final = 50  # reasons that are kept


def write_golden(
    folder: str | os.PathLike[str],
    record: Record,
    *,
    reason: str = "",
    changed: Sequence[str] = (),
    history: Sequence[Mapping[str, Any]] = (),
) -> None:
    """Makes a record the golden one.

    Args:
        folder: where it goes; a golden run that is there is replaced in one go.
        record: what a run gave.
        reason: why it is right; for what is recorded first it may be empty.
        changed: what differs from the one before, in sentences.
        history: of the one before; what is written adds an entry.

    Raises:
        InputError: SK-GOLDEN-005 the folder cannot be written.
    """
    place = Path(folder)
    about, data = about_record(record)
    digest = hashlib.sha256(data).hexdigest()
    name = f"data-{digest[:12]}.xz"
    entry: dict[str, Any] = {"reason": reason or "recorded"}
    entry |= {key: record.fingerprint[key] for key in ("simkit", "mujoco", "numpy") if key in record.fingerprint}
    if changed:
        entry["changed"] = list(changed)
    text = json.dumps(
        {
            "format": FORMAT,
            "scenario": plain_scenario(record.scenario, place),
            **about,
            "data": {"file": name, "sha256": digest, "bytes": len(data)},
            "history": [*history, entry][-_MOST_BLESSED:],
        },
        indent=1,
        ensure_ascii=False,
    )
    try:
        place.mkdir(parents=True, exist_ok=True)
        with _alone(place):
            _put(place, name, data)
            _put(place, MAIN, (text + "\n").encode())
            _sync(place)
            _tidy(place, name)
    except OSError as error:
        message = f"SK-GOLDEN-005 {place} cannot be written: {error.strerror or error}"
        raise InputError(message, "SK-GOLDEN-005") from None


def read_golden(folder: str | os.PathLike[str]) -> Record:
    """The golden record of a folder.

    Raises:
        InputError: SK-GOLDEN-002 there is none; SK-GOLDEN-003 it is damaged, or no golden run at all; SK-GOLDEN-004 a
            newer version of simkit wrote it.
    """
    place = folder_of(folder)
    said, name, digest, data = _said_and_data(place)
    if len(data) > _MOST_DATA:
        raise _damaged(place / name, "is larger than any golden run may be")
    if hashlib.sha256(data).hexdigest() != digest:
        raise _damaged(place / name, f"is not what {MAIN} says: its hash is another")
    try:
        return record_of(said, data, scenario_from(said["scenario"], place))
    except PackingError as error:
        raise _damaged(place / name, f"is damaged: {error}") from None
    except (ValueError, TypeError, KeyError, AttributeError, IndexError, OverflowError, RecursionError) as error:
        raise _damaged(place, f"is damaged: {type(error).__name__}: {error}") from None


def _said_and_data(place: Path) -> tuple[dict[str, Any], str, str, bytes]:
    """What `golden.json` says, the name and the hash of its data, and those."""
    for trial in range(_TRIALS):
        said = read_main(place)
        name, digest = _data_of(place, said)
        try:
            with open(place / name, "rb") as file:
                return said, name, digest, file.read(_MOST_DATA + 1)
        except FileNotFoundError as error:  # or somebody has made another run golden just now
            if trial == _TRIALS - 1 or read_main(place) == said:
                raise _damaged(place / name, f"cannot be read: {error.strerror}") from None
        except OSError as error:
            raise _damaged(place / name, f"cannot be read: {error.strerror or error}") from None
    raise AssertionError(place)


def read_main(folder: Path) -> dict[str, Any]:
    """What `golden.json` of a folder says.

    Raises:
        InputError: as `read_golden`.
    """
    path = folder / MAIN
    try:
        with open(path, "rb") as file:
            text = file.read(_MOST_TEXT + 1)
    except (FileNotFoundError, NotADirectoryError):
        raise InputError(
            f"SK-GOLDEN-002 {folder}: there is no golden run (no {MAIN})\n"
            "    help: simkit golden record WORLD --out DIR makes one",
            "SK-GOLDEN-002",
        ) from None
    except OSError as error:
        raise _damaged(path, f"cannot be read: {error.strerror or error}") from None
    if len(text) > _MOST_TEXT:
        raise _damaged(path, "is larger than any may be")
    try:
        said = json.loads(text.decode())
    except RecursionError:
        raise _damaged(path, "is nested too deep") from None
    except ValueError as error:
        raise _damaged(path, f"is not JSON: {error}") from None
    if not isinstance(said, dict) or type(said.get("format")) is not int:
        raise _damaged(path, "is not of a golden run")
    if said["format"] > FORMAT:
        raise InputError(
            f"SK-GOLDEN-004 {path}: format {said['format']} is newer than what this simkit reads ({FORMAT})\n"
            "    help: pip install --upgrade simkit-robotics",
            "SK-GOLDEN-004",
        )
    if said["format"] < 1 or not isinstance(said.get("scenario"), dict):
        raise _damaged(path, "is not of a golden run")
    return said


def history_of(folder: str | os.PathLike[str]) -> list[Mapping[str, Any]]:
    """What was recorded and blessed in a folder, oldest first."""
    found = read_main(folder_of(folder)).get("history", [])
    return [one for one in found if isinstance(one, dict)] if isinstance(found, list) else []


def folder_of(path: str | os.PathLike[str]) -> Path:
    """The folder of a golden run, of which `golden.json` may be named as well."""
    found = Path(path)
    return found.parent if found.name == MAIN else found


def is_golden(path: str | os.PathLike[str]) -> bool:
    """Whether there is a golden run."""
    return (folder_of(path) / MAIN).is_file()


def find_goldens(path: str | os.PathLike[str]) -> list[Path]:
    """The golden runs in a folder and below it, by name.

    Raises:
        InputError: SK-GOLDEN-002 there is none.
    """
    top = folder_of(path)
    if (top / MAIN).is_file():
        return [top]
    found = []
    for folder, names, files in os.walk(top):
        names.sort()
        if MAIN in files:
            found.append(Path(folder))
            names.clear()
    if not found:
        read_main(top)
    return found


def _data_of(place: Path, said: Mapping[str, Any]) -> tuple[str, str]:
    data = said.get("data")
    name, digest = (data.get("file"), data.get("sha256")) if isinstance(data, dict) else (None, None)
    if not isinstance(name, str) or not _DATA.fullmatch(name) or not isinstance(digest, str):
        raise _damaged(place / MAIN, "does not say where its data are")
    return name, digest


def _damaged(path: Path, what: str) -> InputError:
    return InputError(f"SK-GOLDEN-003 {path} {what}", "SK-GOLDEN-003")


def _put(folder: Path, name: str, data: bytes) -> None:
    """Writes a file that is there as a whole or not at all."""
    left = folder / f".golden-{os.getpid()}.tmp"
    with open(left, "wb") as file:
        file.write(data)
        file.flush()
        os.fsync(file.fileno())
    left.replace(folder / name)


@contextmanager
def _alone(folder: Path) -> Iterator[None]:
    """Lets one process at a time write in a folder: of two, the last one's run is golden, as a whole."""
    if not hasattr(os, "O_DIRECTORY"):  # Windows has no lock for a folder
        yield
        return
    import fcntl

    handle = os.open(folder, os.O_RDONLY | os.O_DIRECTORY)
    try:
        with suppress(OSError):  # a file system without locks
            fcntl.flock(handle, fcntl.LOCK_EX)
        yield
    finally:
        os.close(handle)


def _sync(folder: Path) -> None:
    if hasattr(os, "O_DIRECTORY"):
        handle = os.open(folder, os.O_RDONLY | os.O_DIRECTORY)
        try:
            os.fsync(handle)
        finally:
            os.close(handle)


def _tidy(folder: Path, name: str) -> None:
    """Removes the data that were golden before, and what a writing that was cut off has left."""
    for path in folder.iterdir():
        if (_DATA.fullmatch(path.name) and path.name != name) or _LEFT.fullmatch(path.name):
            path.unlink(missing_ok=True)
