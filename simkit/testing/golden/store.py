"""Golden runs on disk: a folder with `golden.json` to read and one file of data.

`golden.json` names the data it belongs to by its hash. The data are written first and `golden.json` is put in place
last, in one go: at whatever moment the writing is cut off, what is there is the old golden run or the new one.
"""

from __future__ import annotations

import hashlib
import json
import os
import re
from collections.abc import Iterator, Sequence
from contextlib import contextmanager, suppress
from pathlib import Path
from typing import Final

from simkit.errors import InputError
from simkit.run_spec import JsonMapping, JsonObject
from simkit.testing.golden.array_packing import PackingError
from simkit.testing.golden.record_encoding import decode_record, decode_scenario, encode_record, encode_scenario
from simkit.testing.run_record.record import RunRecord

FORMAT: Final = 1
MAIN_FILE: Final = "golden.json"
_DATA: Final = re.compile(r"data-[0-9a-f]{12}\.xz")
_TEMPORARY_NAME: Final = re.compile(r"\.golden-\d+\.tmp")
_MAX_TEXT_BYTES: Final = 16 << 20  # [bytes] of golden.json
_MAX_DATA_BYTES: Final = 256 << 20
_READ_ATTEMPTS: Final = 20  # of reading a golden run that others write at the same time
_MAX_HISTORY: Final = 50  # reasons that are kept


def write_golden(
    folder: str | os.PathLike[str],
    record: RunRecord,
    *,
    reason: str = "",
    changed: Sequence[str] = (),
    history: Sequence[JsonMapping] = (),
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
    about, data = encode_record(record)
    digest = hashlib.sha256(data).hexdigest()
    name = f"data-{digest[:12]}.xz"
    entry: JsonObject = {"reason": reason or "recorded"}
    entry |= {key: record.fingerprint[key] for key in ("simkit", "mujoco", "numpy") if key in record.fingerprint}
    if changed:
        entry["changed"] = list(changed)
    text = json.dumps(
        {
            "format": FORMAT,
            "scenario": encode_scenario(record.scenario, place),
            **about,
            "data": {"file": name, "sha256": digest, "bytes": len(data)},
            "history": [*history, entry][-_MAX_HISTORY:],
        },
        indent=1,
        ensure_ascii=False,
    )
    try:
        place.mkdir(parents=True, exist_ok=True)
        with _locked_folder(place) as handle:
            _write_atomically(place, name, data)
            _write_atomically(place, MAIN_FILE, (text + "\n").encode())
            if handle is not None:
                os.fsync(handle)
            _remove_old_data(place, name)
    except OSError as error:
        message = f"SK-GOLDEN-005 {place} cannot be written: {error.strerror or error}"
        raise InputError(message, "SK-GOLDEN-005") from None


def read_golden(folder: str | os.PathLike[str]) -> RunRecord:
    """The golden record of a folder.

    Raises:
        InputError: SK-GOLDEN-002 there is none; SK-GOLDEN-003 it is damaged, or no golden run at all; SK-GOLDEN-004 a
            newer version of simkit wrote it.
    """
    place = golden_folder(folder)
    said, name, digest, data = _read_main_and_data(place)
    if len(data) > _MAX_DATA_BYTES:
        raise _damaged_error(place / name, "is larger than any golden run may be")
    if hashlib.sha256(data).hexdigest() != digest:
        raise _damaged_error(place / name, f"is not what {MAIN_FILE} says: its hash is another")
    try:
        return decode_record(said, data, decode_scenario(said["scenario"], place))
    except PackingError as error:
        raise _damaged_error(place / name, f"is damaged: {error}") from None
    except (ValueError, TypeError, KeyError, AttributeError, IndexError, OverflowError, RecursionError) as error:
        raise _damaged_error(place, f"is damaged: {type(error).__name__}: {error}") from None


def _read_main_and_data(place: Path) -> tuple[JsonObject, str, str, bytes]:
    """What `golden.json` says, the name and the hash of its data, and those."""
    for trial in range(_READ_ATTEMPTS):
        said = read_main(place)
        name, digest = _read_data(place, said)
        try:
            with open(place / name, "rb") as file:
                return said, name, digest, file.read(_MAX_DATA_BYTES + 1)
        except FileNotFoundError as error:  # or somebody has made another run golden just now
            if trial == _READ_ATTEMPTS - 1 or read_main(place) == said:
                raise _damaged_error(place / name, f"cannot be read: {error.strerror}") from None
        except OSError as error:
            raise _damaged_error(place / name, f"cannot be read: {error.strerror or error}") from None
    raise AssertionError(place)


def read_main(folder: Path) -> JsonObject:
    """What `golden.json` of a folder says.

    Raises:
        InputError: as `read_golden`.
    """
    path = folder / MAIN_FILE
    try:
        with open(path, "rb") as file:
            text = file.read(_MAX_TEXT_BYTES + 1)
    except (FileNotFoundError, NotADirectoryError):
        raise InputError(
            f"SK-GOLDEN-002 {folder}: there is no golden run (no {MAIN_FILE})\n"
            "    help: simkit golden record WORLD --out DIR makes one",
            "SK-GOLDEN-002",
        ) from None
    except OSError as error:
        raise _damaged_error(path, f"cannot be read: {error.strerror or error}") from None
    if len(text) > _MAX_TEXT_BYTES:
        raise _damaged_error(path, "is larger than any may be")
    try:
        said = json.loads(text.decode())
    except RecursionError:
        raise _damaged_error(path, "is nested too deep") from None
    except ValueError as error:
        raise _damaged_error(path, f"is not JSON: {error}") from None
    if not isinstance(said, dict) or type(said.get("format")) is not int:
        raise _damaged_error(path, "is not of a golden run")
    if said["format"] > FORMAT:
        raise InputError(
            f"SK-GOLDEN-004 {path}: format {said['format']} is newer than what this simkit reads ({FORMAT})\n"
            "    help: pip install --upgrade simkit-robotics",
            "SK-GOLDEN-004",
        )
    if said["format"] < 1 or not isinstance(said.get("scenario"), dict):
        raise _damaged_error(path, "is not of a golden run")
    return said


def read_history(folder: str | os.PathLike[str]) -> list[JsonMapping]:
    """What was recorded and blessed in a folder, oldest first."""
    found = read_main(golden_folder(folder)).get("history", [])
    return [one for one in found if isinstance(one, dict)] if isinstance(found, list) else []


def golden_folder(path: str | os.PathLike[str]) -> Path:
    """The folder of a golden run, of which `golden.json` may be named as well."""
    found = Path(path)
    return found.parent if found.name == MAIN_FILE else found


def is_golden(path: str | os.PathLike[str]) -> bool:
    """Whether there is a golden run."""
    return (golden_folder(path) / MAIN_FILE).is_file()


def find_goldens(path: str | os.PathLike[str]) -> list[Path]:
    """The golden runs in a folder and below it, by name.

    Raises:
        InputError: SK-GOLDEN-002 there is none.
    """
    top = golden_folder(path)
    if (top / MAIN_FILE).is_file():
        return [top]
    found = []
    for folder, names, files in os.walk(top):
        names.sort()
        if MAIN_FILE in files:
            found.append(Path(folder))
            names.clear()
    if not found:
        read_main(top)
    return found


def _read_data(place: Path, said: JsonMapping) -> tuple[str, str]:
    data = said.get("data")
    name, digest = (data.get("file"), data.get("sha256")) if isinstance(data, dict) else (None, None)
    if not isinstance(name, str) or not _DATA.fullmatch(name) or not isinstance(digest, str):
        raise _damaged_error(place / MAIN_FILE, "does not say where its data are")
    return name, digest


def _damaged_error(path: Path, what: str) -> InputError:
    return InputError(f"SK-GOLDEN-003 {path} {what}", "SK-GOLDEN-003")


def _write_atomically(folder: Path, name: str, data: bytes) -> None:
    """Writes a file that is there as a whole or not at all."""
    left = folder / f".golden-{os.getpid()}.tmp"
    with open(left, "wb") as file:
        file.write(data)
        file.flush()
        os.fsync(file.fileno())
    left.replace(folder / name)


@contextmanager
def _locked_folder(folder: Path) -> Iterator[int | None]:
    """Lets one process at a time write in a folder: of two, the last one's run is golden, as a whole.

    Yields:
        A descriptor of the folder; None on Windows, which has no lock for one.
    """
    if not hasattr(os, "O_DIRECTORY"):
        yield None
        return
    import fcntl

    handle = os.open(folder, os.O_RDONLY | os.O_DIRECTORY)
    try:
        with suppress(OSError):  # a file system without locks
            fcntl.flock(handle, fcntl.LOCK_EX)
        yield handle
    finally:
        os.close(handle)


def _remove_old_data(folder: Path, name: str) -> None:
    """Removes the data that were golden before, and what a writing that was cut off has left."""
    for path in folder.iterdir():
        if (_DATA.fullmatch(path.name) and path.name != name) or _TEMPORARY_NAME.fullmatch(path.name):
            path.unlink(missing_ok=True)
