"""Signals at any moment: the exit code says so, and what is left on the disk is whole or absent."""

from __future__ import annotations

import os
import random
import signal
import subprocess
import sys
import time
import zipfile
from collections.abc import Iterator
from contextlib import suppress
from pathlib import Path

import pytest
from targets import WORLD_FILES, environment, recorded
from test_broken_files import SECONDS, SEED

pytestmark = pytest.mark.skipif(sys.platform == "win32", reason="signals of POSIX")
MARKER = "begun"  # file that a command writes after it has begun to handle signals
# A signal before that ends the process in Python's way: Python takes 10 ms to reach the first line of simkit.
NOTE_THE_START = """
import os, sys
def hear(event, values):
    if event == "exec" and getattr(values[0], "co_filename", "").endswith("simkit/garbage_collection.py"):
        os.close(os.open(os.environ["SIMKIT_FUZZ_MARKER"], os.O_CREAT))
sys.addaudithook(hear)
"""
LEAST = 4  # moments of each command, also when the time is short
PATIENCE = 60.0  # [s] for a command to end after its signal; the processor may be shared
COMMANDS = {
    "record": ("run", "w.sdf", "--duration", "20", "--record", "new.mcap", "--force"),
    "record a folder": ("run", "w.sdf", "--duration", "20", "--record", "new", "--force"),
    "golden": ("golden", "record", "w.sdf", "--duration", "10", "-o", "new"),
    "bundle": ("bundle", "w.sdf", "--duration", "10", "-o", "new.zip"),
    "recover": ("bag", "recover", "b.mcap", "new.mcap"),
    "export": ("bag", "export", "b.mcap", "-o", "new"),
    "convert": ("convert", "w.sdf", "-o", "new.xml"),
    "vendor": ("vendor", "w.sdf", "new"),
}


def leftovers(name: str, folder: Path, whole: frozenset[str]) -> Iterator[str]:
    """Yield what is wrong with what a command left in its folder; `whole` are the files that it writes undisturbed."""
    from simkit.errors import InputError
    from simkit.recording.bags.reader import open_bag_to_read
    from simkit.testing.golden.store import read_golden
    from simkit_verification.testing.bundles import open_bundle

    left = {p.name for p in folder.iterdir()} - {*WORLD_FILES, "b.mcap", "tmp", "site", MARKER}
    yield from (f"left {n}" for n in left - {"new", "new.mcap", "new.zip", "new.xml", "new_assets", "new.xml_assets"})
    try:
        for bag in (folder / "new.mcap", folder / "new"):
            if name.startswith(("record", "recover")) and bag.exists() and (bag.is_file() or any(bag.iterdir())):
                with open_bag_to_read(bag) as opened:
                    sum(1 for _ in opened.messages())
        if name == "golden" and (folder / "new").exists() and any((folder / "new").iterdir()):
            read_golden(folder / "new")
        if (folder / "new.zip").exists():
            open_bundle(folder / "new.zip").close()
    except (InputError, zipfile.BadZipFile) as error:
        yield f"not readable: {error}"
    if name in ("export", "vendor", "convert") and left and _files(folder) != whole:
        yield f"half written: {sorted(whole - _files(folder))}"


def _files(folder: Path) -> frozenset[str]:
    return frozenset(p.relative_to(folder).as_posix() for p in folder.rglob("new*/**/*") if p.is_file()) | frozenset(
        p.name for p in folder.glob("new*") if p.is_file()
    )


def interrupted(name: str, folder: Path, number: int, after: float, whole: frozenset[str]) -> list[str]:
    """Send a signal to a command after some seconds, and say what is wrong with its end."""
    for path, content in {**WORLD_FILES, "b.mcap": recorded()["b.mcap"]}.items():
        (folder / path).write_bytes(content)
    (folder / "tmp").mkdir()
    (folder / "site").mkdir()
    (folder / "site" / "sitecustomize.py").write_text(NOTE_THE_START)
    variables = {**environment(), "TMPDIR": str(folder / "tmp"), "COLUMNS": "200"}
    variables["SIMKIT_FUZZ_MARKER"] = str(folder / MARKER)
    variables["PYTHONPATH"] = f"{folder / 'site'}{os.pathsep}{variables['PYTHONPATH']}"
    process = subprocess.Popen(
        [sys.executable, "-m", "simkit", *COMMANDS[name]],
        cwd=folder, env=variables, start_new_session=True, stdout=subprocess.PIPE, stderr=subprocess.STDOUT,
    )  # fmt: skip
    time.sleep(after)
    process.send_signal(number)
    try:
        said = process.communicate(timeout=PATIENCE)[0].decode(errors="replace")
    except subprocess.TimeoutExpired:
        os.killpg(process.pid, signal.SIGKILL)
        process.communicate()
        return [f"does not end after {number!r}"]
    code, problems = process.returncode, []
    if not (folder / MARKER).exists():  # Python itself was starting
        is_as_python_does = code in (-number, 128 + number) or (code == 1 and "KeyboardInterrupt" in said)
        return [] if is_as_python_does else [f"exit code {code} before the first line: {said[-1500:]}"]
    if code not in (0, 128 + number):
        problems.append(f"exit code {code}: {said[-1500:]}")
    if "Traceback" in said:
        problems.append(f"traceback: {said[-1500:]}")
    with suppress(ProcessLookupError):
        os.killpg(process.pid, 0)
        problems.append("a child process goes on")
        os.killpg(process.pid, signal.SIGKILL)
    sockets = f"simkit-{os.getuid()}"  # folder of the sockets of running simulations; it stays, but empty
    for place in (folder / "tmp", folder / "tmp" / sockets):
        problems += [
            f"temporary {p.name}"
            for p in (place.iterdir() if place.is_dir() else ())
            if p.name not in (sockets, ".lock")
        ]
    return problems + list(leftovers(name, folder, whole))


@pytest.mark.fuzz
@pytest.mark.parametrize("name", COMMANDS)
def test_a_signal_at_any_moment_ends_a_command_cleanly(name: str, tmp_path: Path) -> None:
    chance, found, index = random.Random(f"{SEED} {name}"), [], 0
    began = time.monotonic()
    seconds, whole = _undisturbed(name, tmp_path)
    while index < LEAST or time.monotonic() < began + SECONDS / len(COMMANDS):
        (folder := tmp_path / str(index)).mkdir()
        number, after = chance.choice((signal.SIGINT, signal.SIGTERM)), chance.uniform(0, 1.5 * seconds)
        found += [
            f"{number.name} after {after:.3f} s: {text}" for text in interrupted(name, folder, number, after, whole)
        ]
        index += 1
    assert not found, f"{len(found)} in {index} moments\n" + "\n".join(found[:20])


def _undisturbed(name: str, folder: Path) -> tuple[float, frozenset[str]]:
    """Return the seconds of a command without a signal, at most 6, and the files that it writes."""
    (place := folder / "whole").mkdir()
    for path, content in {**WORLD_FILES, "b.mcap": recorded()["b.mcap"]}.items():
        (place / path).write_bytes(content)
    began = time.monotonic()
    with suppress(subprocess.TimeoutExpired):
        subprocess.run(
            [sys.executable, "-m", "simkit", *COMMANDS[name]],
            cwd=place, env=environment(), capture_output=True, timeout=6.0, check=False,
        )  # fmt: skip
    return time.monotonic() - began, _files(place)
