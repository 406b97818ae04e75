"""Golden runs on disk: a folder with the readable file `golden.json` and one data file.

`golden.json` refers to its data file by hash. The data file is written first; then `golden.json` is replaced
atomically. If writing is interrupted at any time, the folder contains either the old or the new golden run.
"""

from __future__ import annotations

import hashlib
import json
import os
import re
from collections.abc import Iterator, Sequence
from contextlib import contextmanager, suppress
from functools import partial
from pathlib import Path
from typing import Final

from simkit import file_lock
from simkit.diagnostic_record import Where
from simkit.errors import InputError
from simkit.input_file import read_input, read_input_text
from simkit.install_command import install_command
from simkit.json_reader import parse_json
from simkit.output_file import open_regular
from simkit.run_spec import JsonMapping, JsonObject
from simkit.testing.golden.array_packing import PackingError
from simkit.testing.golden.record_encoding import decode_record, decode_scenario, encode_record, encode_scenario
from simkit.testing.run_record.record import RunRecord
from simkit.testing.scenarios.code_permission import permit_code

FORMAT: Final = 1
MAIN_FILE: Final = "golden.json"
_DATA: Final = re.compile(r"data-[0-9a-f]{12}\.xz")
_LOCK_NAME: Final = ".golden.lock"
_TEMPORARY_NAME: Final = re.compile(r"\.golden-\d+\.tmp")
_MAX_TEXT_BYTES: Final = 16 << 20  # maximum size of golden.json [bytes]
_MAX_DATA_BYTES: Final = 256 << 20
_READ_ATTEMPTS: Final = 20  # attempts to read a golden run that another process is writing
_MAX_HISTORY: Final = 50  # maximum number of entries


def write_golden(
    folder: str | os.PathLike[str],
    record: RunRecord,
    *,
    reason: str = "",
    changed: Sequence[str] = (),
    history: Sequence[JsonMapping] = (),
) -> None:
    """Write a record as the golden run.

    Args:
        folder: Target folder; an existing golden run in it is replaced atomically.
        record: Record of a run.
        reason: Reason why the record is correct; may be empty for the first one.
        changed: Sentences about the differences from the previous golden run.
        history: History of the previous golden run; one entry is added.

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
            "scenario": encode_scenario(permit_code(record.scenario, allow_code=True), place),  # stored, not run
            **about,
            "data": {"file": name, "sha256": digest, "bytes": len(data)},
            "history": [*history, entry][-_MAX_HISTORY:],
        },
        indent=1,
        ensure_ascii=False,
    )
    content = (text + "\n").encode()  # before anything is written: a name that is not UTF-8 is an error
    try:
        place.mkdir(parents=True, exist_ok=True)
        with _locked_folder(place) as handle:
            _write_atomically(place, name, data)
            _write_atomically(place, MAIN_FILE, content)
            if handle is not None:
                os.fsync(handle)
            _remove_old_data(place, name)
    except OSError as error:
        _remove_unfinished(place, name)
        message = f"cannot write {place}: {error.strerror or error}"
        raise InputError("SK-GOLDEN-005", message) from None


def read_golden(folder: str | os.PathLike[str]) -> RunRecord:
    """Read the golden record in a folder.

    Raises:
        InputError: SK-GOLDEN-002 there is no golden run; SK-GOLDEN-003 the golden run is damaged or has another format;
            SK-GOLDEN-004 a newer version of simkit wrote the golden run.
    """
    place = golden_folder(folder)
    main, name, digest, data = _read_main_and_data(place)
    if hashlib.sha256(data).hexdigest() != digest:
        raise _damaged_error(place / name, f"does not have the hash that {MAIN_FILE} lists")
    try:
        return decode_record(main, data, decode_scenario(main["scenario"], place, partial(_where, place)))
    except PackingError as error:
        raise _damaged_error(place / name, f"is damaged: {error}") from None
    except (ValueError, TypeError, LookupError, AttributeError, OSError, ArithmeticError, RecursionError) as error:
        raise _damaged_error(place, f"is damaged: {type(error).__name__}: {str(error)[:300]}") from None


def _read_main_and_data(place: Path) -> tuple[JsonObject, str, str, bytes]:
    """Return the content of `golden.json`, then the name, hash and content of its data file."""
    for trial in range(_READ_ATTEMPTS):
        main = read_main(place)
        name, digest = _read_data(place, main)
        try:
            return main, name, digest, read_input(place / name, _MAX_DATA_BYTES, inside=place)
        except FileNotFoundError as error:  # another process may have replaced the golden run just now
            if trial == _READ_ATTEMPTS - 1 or read_main(place) == main:
                raise _damaged_error(place / name, f"cannot be read: {error.strerror}") from None
        except OSError as error:
            raise _damaged_error(place / name, f"cannot be read: {error.strerror or error}") from None
    raise AssertionError(place)


def read_main(folder: Path) -> JsonObject:
    """Return the content of `golden.json` in a folder.

    Raises:
        InputError: See `read_golden`.
    """
    path = folder / MAIN_FILE
    try:
        text = read_input(path, _MAX_TEXT_BYTES, inside=folder)
    except (FileNotFoundError, NotADirectoryError):
        raise InputError(
            "SK-GOLDEN-002",
            f"{folder}: there is no golden run (no {MAIN_FILE})",
            help="record a golden run with: simkit golden record WORLD --out DIR",
        ) from None
    except OSError as error:
        raise _damaged_error(path, f"cannot be read: {error.strerror or error}") from None
    try:
        main = parse_json(text.decode())
    except ValueError as error:
        raise _damaged_error(path, f"is not JSON: {error}") from None
    if not isinstance(main, dict) or type(main.get("format")) is not int:
        raise _damaged_error(path, "is not the file of a golden run")
    if main["format"] > FORMAT:
        raise InputError(
            "SK-GOLDEN-004",
            f"{path} has format {main['format']}; this version of simkit reads formats up to {FORMAT}",
            help=install_command(option="--upgrade"),
        )
    if main["format"] < 1 or not isinstance(main.get("scenario"), dict):
        raise _damaged_error(path, "is not the file of a golden run")
    return main


def _where(folder: Path, key: str) -> Where:
    """Return the position of a key in `golden.json`; its first line if the key is not written plainly."""
    text = read_input(folder / MAIN_FILE, _MAX_TEXT_BYTES)
    before = text.partition(f'"{key}"'.encode())[0]
    return Where(str(folder / MAIN_FILE), 1 if before == text else before.count(b"\n") + 1)


def read_history(folder: str | os.PathLike[str]) -> list[JsonMapping]:
    """Return the history of a golden run, oldest entry first."""
    history = read_main(golden_folder(folder)).get("history", [])
    return [entry for entry in history if isinstance(entry, dict)] if isinstance(history, list) else []


def line_of_key(folder: Path, key: str) -> int | None:
    """Return the line of `golden.json` in which a key of the scenario is; None without such a line."""
    lines = read_input_text(folder / MAIN_FILE, _MAX_TEXT_BYTES, inside=folder).split("\n")
    return next((number for number, line in enumerate(lines, 1) if line.lstrip().startswith(f'"{key}":')), None)


def golden_folder(path: str | os.PathLike[str]) -> Path:
    """Return the folder of a golden run, given the folder or its `golden.json`."""
    folder = Path(path)
    return folder.parent if folder.name == MAIN_FILE else folder


def is_golden(path: str | os.PathLike[str]) -> bool:
    """Check whether a path is a golden run."""
    return (golden_folder(path) / MAIN_FILE).is_file()


def find_goldens(path: str | os.PathLike[str]) -> list[Path]:
    """Return the golden runs in a folder and its subfolders, sorted by name.

    Raises:
        InputError: SK-GOLDEN-002 there is no golden run.
    """
    top = golden_folder(path)
    if (top / MAIN_FILE).is_file():
        return [top]
    folders = []
    for folder, names, files in os.walk(top):
        names.sort()
        if MAIN_FILE in files:
            folders.append(Path(folder))
            names.clear()
    if not folders:
        read_main(top)
    return folders


def _read_data(place: Path, main: JsonMapping) -> tuple[str, str]:
    data = main.get("data")
    name, digest = (data.get("file"), data.get("sha256")) if isinstance(data, dict) else (None, None)
    if not isinstance(name, str) or not _DATA.fullmatch(name) or not isinstance(digest, str):
        raise _damaged_error(place / MAIN_FILE, "does not name its data file")
    return name, digest


def _damaged_error(path: Path, what: str) -> InputError:
    return InputError("SK-GOLDEN-003", f"{path} {what}")


def _write_atomically(folder: Path, name: str, data: bytes) -> None:
    """Write a file atomically, so that it is complete or absent."""
    left = folder / f".golden-{os.getpid()}.tmp"
    try:
        with open(left, "wb") as file:
            file.write(data)
            file.flush()
            os.fsync(file.fileno())
        left.replace(folder / name)
    except BaseException:  # a full disk, or an interrupt
        left.unlink(missing_ok=True)
        raise


@contextmanager
def _locked_folder(folder: Path) -> Iterator[int | None]:
    """Lock a folder, so that only one process writes in it at a time.

    Yields:
        Descriptor of the folder; None on Windows, which cannot open a folder and locks a file in it.
    """
    if not hasattr(os, "O_DIRECTORY"):
        with _locked_file(folder / _LOCK_NAME):
            yield None
        return
    handle = os.open(folder, os.O_RDONLY | os.O_DIRECTORY)
    try:
        with suppress(OSError):  # some file systems do not support locks
            file_lock.wait_for_lock(handle)
        yield handle
    finally:
        os.close(handle)


@contextmanager
def _locked_file(path: Path) -> Iterator[None]:
    """Lock a file, and remove it at the end unless another process waits for it."""
    is_locked = False
    while not is_locked:
        with open_regular(path) as file:
            with suppress(OSError):
                file_lock.wait_for_lock(file.fileno())
            is_locked = file_lock.is_same_file(file.fileno(), path)  # else another process has removed it
            if is_locked:
                try:
                    yield
                finally:
                    file_lock.remove_locked_file(file, path)


def _remove_unfinished(place: Path, name: str) -> None:
    """Remove the data file of a golden run that could not be written, unless a complete golden run has it."""
    main = place / MAIN_FILE
    with suppress(OSError):
        if not main.is_file() or name.encode() not in read_input(main, _MAX_TEXT_BYTES):
            (place / name).unlink(missing_ok=True)
        if not any(place.iterdir()):
            place.rmdir()


def _remove_old_data(folder: Path, name: str) -> None:
    """Remove old data files and temporary files of interrupted writes."""
    for path in folder.iterdir():
        if (_DATA.fullmatch(path.name) and path.name != name) or _TEMPORARY_NAME.fullmatch(path.name):
            path.unlink(missing_ok=True)
