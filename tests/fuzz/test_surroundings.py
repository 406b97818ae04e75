"""Few file handles, a full disk, closed streams and odd paths: a result, or an error with a code and no traceback."""

from __future__ import annotations

import os
import re
import shutil
import subprocess
import sys
from collections.abc import Callable
from dataclasses import dataclass, field
from pathlib import Path

import pytest
from targets import WORLD_FILES, environment, intact, recorded
from test_system_calls import SWEEP

pytestmark = [pytest.mark.fuzz, pytest.mark.skipif(sys.platform == "win32", reason="limits and paths of POSIX")]
LIMIT = 120.0  # [s] of wall time; the processor may be shared
COMMANDS = {
    "record": "run w.sdf --duration 0.3 --record OUT.mcap",
    "record a folder": "run w.sdf --duration 0.3 --record OUT",
    "golden": "golden record s.yaml -o OUT",
    "check": "golden check golden --html OUT.html --junit OUT.xml",
    "bundle": "bundle w.sdf --duration 0.1 -o OUT.zip",
    "replay": "replay b.zip --record OUT.mcap",
    "extract": "replay b.zip --extract OUT",
    "info": "bag info b.mcap",
    "recover": "bag recover b.mcap OUT.mcap",
    "export": "bag export b.mcap -o OUT",
    "convert": "convert w.sdf -o OUT.xml",
    "vendor": "vendor w.sdf OUT",
    "plot": "plot b.mcap /odom.pose.pose.position.x -o OUT.svg",
    "picture": "run w.sdf --duration 0.1 --until time>0.05 --timeout 1 --junit OUT.xml",
    "certify": "certify w.sdf --duration 0.05 --runs 2 -o OUT.json",
    "inspect": "inspect w.sdf --json",
    "check a world": "check w.sdf",
    "doctor": "doctor",
    "sweep of two": "sweep run sweep.yaml -o OUT -n 2 -q",
    "check with two": "golden check golden golden --jobs 2 --no-causes",
}


@dataclass(frozen=True)
class Surroundings:
    """One way in which the place of a command differs.

    Attributes:
        out: stands for OUT in the command.
        variables: changes of the environment; None removes a variable.
        prepare: what the new process does before it becomes the command.
        codes: exit codes that may come.
        mounts: commands of a shell, as root of a new name space of mounts, before the command starts.
    """

    out: str = "new"
    variables: dict[str, str | None] = field(default_factory=dict)
    prepare: Callable[[], None] | None = None
    codes: tuple[int, ...] = (0, 1, 2)
    mounts: str = ""


def _limit(name: str, value: int) -> Callable[[], None]:
    def prepare() -> None:
        import resource

        resource.setrlimit(getattr(resource, name), (value, value))

    return prepare


def _close(*streams: int) -> Callable[[], None]:
    return lambda: [os.close(stream) for stream in streams] and None


def _full(*streams: int) -> Callable[[], None]:
    return lambda: [os.dup2(os.open("/dev/full", os.O_WRONLY), stream) for stream in streams] and None


NO_HOME = {"HOME": "/proc/none", "XDG_CACHE_HOME": None, "XDG_RUNTIME_DIR": None, "XDG_CONFIG_HOME": None}
SURROUNDINGS = {
    "40 file handles": Surroundings(prepare=_limit("RLIMIT_NOFILE", 40)),
    "a full disk": Surroundings(prepare=_limit("RLIMIT_FSIZE", 3000)),
    "a disk that is full at once": Surroundings(prepare=_limit("RLIMIT_FSIZE", 0)),
    "an output below a file": Surroundings(out="w.sdf/new", codes=(0, 2)),
    "an output where nobody writes": Surroundings(out="/proc/new", codes=(0, 2)),
    "no standard output": Surroundings(prepare=_close(1)),
    "no standard error": Surroundings(prepare=_close(2)),
    "no streams": Surroundings(prepare=_close(0, 1, 2)),
    "full streams": Surroundings(prepare=_full(1, 2)),
    "a full standard output": Surroundings(prepare=_full(1)),
    "the C locale": Surroundings(
        out="n\u00fc",
        variables={"LANG": "C", "LC_ALL": "C", "PYTHONUTF8": "0", "PYTHONCOERCECLOCALE": "0"},
        codes=(0, 2),
    ),
    "a home that is nowhere": Surroundings(variables=NO_HOME, codes=(0,)),
    "no home": Surroundings(variables={**NO_HOME, "HOME": None, "USER": None, "LOGNAME": None}, codes=(0,)),
    "no folder for temporary files": Surroundings(variables={"TMPDIR": "/proc/none"}),
    "no shared memory": Surroundings(mounts="mount -t tmpfs -o ro,size=4k none /dev/shm", codes=(0, 2)),
    "little shared memory": Surroundings(mounts="mount -t tmpfs -o size=4k none /dev/shm", codes=(0, 2)),
    "a closed folder of shared memory": Surroundings(mounts="mount -t tmpfs -o mode=000 none /dev/shm", codes=(0, 2)),
    "no devices": Surroundings(mounts="mount -t tmpfs -o ro none /dev", codes=(0, 1, 2)),
    "no folder /tmp": Surroundings(variables={"TMPDIR": None}, mounts="mount -t tmpfs -o ro none /tmp", codes=(0, 2)),
    "no folder /proc": Surroundings(mounts="mount -t tmpfs -o ro none /proc", codes=(0, 2)),
    "no folder /sys": Surroundings(mounts="mount -t tmpfs -o ro none /sys", codes=(0, 2)),
    "a full folder /tmp": Surroundings(
        variables={"TMPDIR": "/tmp"}, mounts="mount -t tmpfs -o size=4k none /tmp; echo x > /tmp/x"
    ),
    "a work folder that nobody writes": Surroundings(mounts="mount -o remount,ro,bind .", codes=(0, 2)),
    "a very long path": Surroundings(out="/".join(["d" * 200] * 25), codes=(0, 2)),
    "a very long name": Surroundings(out="n" * 300, codes=(0, 2)),
    "a name with a line feed and an escape": Surroundings(out="a\n\x1b[2J\x1b]0;t\x07b", codes=(0, 2)),
    "a name that is no text": Surroundings(out="a\udcff", codes=(0, 2)),
    "a name with spaces and quotes": Surroundings(out="a 'b\" $c & %d {e}", codes=(0, 2)),
}


def problems(name: str, place: str, folder: Path) -> list[str]:
    """Run a command in its surroundings and say what is wrong with its end."""
    files = {**recorded(), **WORLD_FILES, "s.yaml": intact("scenario.yaml"), "sweep.yaml": SWEEP}
    for path, content in files.items():
        (folder / path).parent.mkdir(parents=True, exist_ok=True)
        (folder / path).write_bytes(content)
    given = SURROUNDINGS[place]
    variables = {**environment(), "TMPDIR": str(folder.parent / "tmp"), "COLUMNS": "200", **given.variables}
    (folder.parent / "tmp").mkdir(exist_ok=True)
    arguments = [part.replace("OUT", given.out) for part in COMMANDS[name].split(" ")]
    command = [sys.executable, "-B", "-m", "simkit", *arguments]  # no byte code that is cut off by a full disk
    if given.mounts:
        # The work folder is mounted on /mnt, so that it stays when /tmp is hidden.
        mounts = f"mount --bind . /mnt && cd /mnt && {given.mounts} && cd /mnt"
        command = ["unshare", "-m", "sh", "-c", f'{mounts} && exec "$@"', "sh", *command]
    try:
        done = subprocess.run(
            command,
            cwd=folder,
            env={k: v for k, v in variables.items() if v is not None},
            preexec_fn=given.prepare,
            capture_output=True,
            timeout=LIMIT,
            check=False,
        )
    except subprocess.TimeoutExpired:
        return ["does not end"]
    said = (done.stdout + done.stderr).decode(errors="replace")
    found = [] if done.returncode in given.codes else [f"exit code {done.returncode}: {said[-1200:]}"]
    if "Traceback" in said or "Exception ignored" in said:
        found.append(f"traceback, exit code {done.returncode}: {said[-1200:]}")
    is_open = (given.prepare is None and place != "no devices") or place.startswith(("40", "a full disk", "a disk"))
    if done.returncode == 2 and is_open and not re.search(r"SK-[A-Z0-9]+-\d{3}|Usage:", said):
        found.append(f"exit code 2 without a code: {said[-300:]}")
    if done.returncode == 1 and is_open and not said.strip():
        found.append("exit code 1 without a word")
    sockets = f"simkit-{os.getuid()}"  # folder of the sockets of running simulations; it stays
    left = [p.name for p in (folder.parent / "tmp").iterdir() if p.name != sockets]
    return [*found, *(f"left temporary {n}" for n in left)]


@pytest.mark.parametrize("name", COMMANDS)
@pytest.mark.parametrize("place", SURROUNDINGS)
def test_a_command_ends_with_a_result_or_an_error(name: str, place: str, tmp_path: Path) -> None:
    if SURROUNDINGS[place].mounts and subprocess.run(["unshare", "-m", "true"], check=False).returncode != 0:
        pytest.skip("only root can mount in a name space of its own")
    (folder := tmp_path / "work").mkdir()
    found = problems(name, place, folder)
    assert not found, "\n".join(found)
    shutil.rmtree(tmp_path, ignore_errors=True)
