"""A kill or an error at a single system call: no output is half written, an older output stays, and a restart works."""

from __future__ import annotations

import os
import random
import re
import shutil
import subprocess
import sys
import time
from collections import Counter
from collections.abc import Iterator
from contextlib import contextmanager
from dataclasses import dataclass
from functools import cache
from pathlib import Path

import pytest
from targets import WORLD_FILES, environment, intact, recorded
from test_broken_files import SECONDS, SEED

pytestmark = [
    pytest.mark.fuzz,
    pytest.mark.skipif(shutil.which("strace") is None, reason="strace is not installed: apt-get install strace"),
]
STRACE = ("strace", "-f", "-qq", "--seccomp-bpf")
LIMIT = 120.0  # [s] of wall time for one command
LEAST = 5  # injections of each command, also when the time is short
SHOWN = 12

SWEEP = b"world: w.sdf\nduration: 0.05\nparameters:\n  speed: [0.1, 0.2]\nseeds: [1, 2]\n"
SWEEP += b"commands: [{at: 0, topic: /cmd_vel, message: {linear: {x: '{speed}'}}}]\n"
SWEEP += b"metrics: {x: \"pose('rover').x\"}\n"
MESH_WORLD = b"""<sdf version="1.9"><world name="w"><model name="m"><static>1</static><link name="l">
<collision name="c"><geometry><mesh><uri>{}</uri></mesh></geometry></collision></link></model></world></sdf>"""
TETRAHEDRON = b"v 0 0 0\nv 1 0 0\nv 0 1 0\nv 0 0 1\nf 1 3 2\nf 1 2 4\nf 1 4 3\nf 2 3 4\n"
LINE = re.compile(r"(?P<thread>\d+) +(?P<name>\w+)\((?P<arguments>.*)")
QUOTED = re.compile(r'"((?:[^"\\]|\\.)*)"')
WALL_TIMES = re.compile(
    rb"\d+(?:\.\d+)? ?m?s\b|time=\"[\d.]+\"|\"?wall\w*\"?[:=] ?\"?[\d.e-]+|\d{4}-\d\d-\d\d[T ][\d:.+Z]+"
)
ERRORS = {
    "openat": ("EMFILE", "ENOSPC", "EIO", "ENOMEM", "EINTR", "EACCES"),
    "write": ("ENOSPC", "EIO", "EINTR", "EDQUOT"),
    "pwrite64": ("ENOSPC", "EIO"),
    "mkdir": ("ENOSPC", "EIO", "EACCES"),
    "rename": ("ENOSPC", "EIO", "EACCES"),
    "fsync": ("EIO", "ENOSPC"),
    "fdatasync": ("EIO", "ENOSPC"),
    "ftruncate": ("EIO", "ENOSPC"),
    "link": ("EPERM", "EMLINK"),
    "copy_file_range": ("EIO", "ENOSPC"),
    "sendfile": ("EIO", "ENOSPC"),
    "read": ("EIO", "EINTR", "ENOMEM"),
    "getdents64": ("EIO", "ENOMEM"),
    "newfstatat": ("EIO", "ENOMEM", "EACCES"),
    "lseek": ("EIO",),
    "flock": ("ENOLCK", "EINTR"),
    "unlink": ("EIO", "EACCES"),
    "unlinkat": ("EIO", "EACCES"),
    "rmdir": ("EIO", "EACCES"),
    "close": ("EIO", "ENOSPC"),
    "fchmod": ("EPERM",),
    "chmod": ("EPERM",),
    "utimensat": ("EPERM",),
}
CHANGES = (
    *("openat", "write", "pwrite64", "mkdir", "rename", "fsync", "fdatasync", "ftruncate", "link", "copy_file_range"),
    *("sendfile", "unlink", "unlinkat", "rmdir", "close", "chmod", "fchmod"),
)


@dataclass(frozen=True)
class Case:
    """A command that writes.

    Attributes:
        older: makes an older output that the command replaces; empty if the command accepts none.
        command: arguments; FUEL stands for the address of a server of this machine.
        is_prefix: whether a readable bag of a part of the run may be left by a kill.
        is_resumed: whether a part of the output may be left, which the restart completes.
        has_data: whether a new data file may lie beside the older output, which does not name it.
        is_pair: whether the command replaces two files one after the other.
    """

    command: str
    older: str = ""
    is_prefix: bool = False
    is_resumed: bool = False
    has_data: bool = False
    is_pair: bool = False


CASES = {
    "record": Case(
        "run w.sdf --duration 0.1 --record new.mcap --force", "run w.sdf --duration 0.05 --record new.mcap", True
    ),
    "record a folder": Case(
        "run w.sdf --duration 0.1 --record new --force", "run w.sdf --duration 0.05 --record new", True
    ),
    "golden": Case("golden record s.yaml -o new --force", "golden record w.sdf --duration 0.05 -o new", has_data=True),
    "bundle": Case("bundle w.sdf --duration 0.1 -o new.zip --force", "bundle w.sdf --duration 0.05 -o new.zip"),
    "vendor": Case("vendor mesh.sdf new"),
    "convert": Case("convert w.sdf -o new.xml --force", "convert ball.sdf -o new.xml"),
    "flatten": Case("convert mesh.sdf --keep-uris -o new.sdf --force"),
    "recover": Case("bag recover b.mcap new.mcap --force", "bag recover short.mcap new.mcap"),
    "export": Case("bag export b.mcap -o new"),
    "map": Case("map w.sdf -o new", "map w.sdf -o new --resolution 0.1", is_pair=True),
    "lab": Case("lab start 02 new"),
    "sweep": Case("sweep run sweep.yaml -o new -n 1 -q", is_resumed=True),
    "sweep of two": Case("sweep run sweep.yaml -o new -n 2 -q", is_resumed=True),
    "certify": Case("certify w.sdf --duration 0.05 --runs 2 -o new.json"),
    "plot": Case("plot b.mcap /odom.pose.pose.position.x -o new.svg"),
    "results": Case("golden check golden --no-causes --html new.html --junit new.xml"),
    "extract": Case("replay b.zip --extract new"),
    "mesh cache": Case("convert mesh.sdf -o new.xml --force"),
    "fetch": Case("fetch fuel.sdf --server FUEL"),
}


def run(arguments: list[str], folder: Path, before: tuple[str, ...] = ()) -> subprocess.CompletedProcess[bytes]:
    """Run a command with its cache, its home and its temporary files below its folder."""
    variables = {**environment(), "COLUMNS": "200", "PYTHONDONTWRITEBYTECODE": "1"}
    variables |= {"SIMKIT_CACHE_DIR": str(folder / "cache"), "GZ_FUEL_CACHE_PATH": str(folder / "new_fuel")}
    variables |= {"TMPDIR": str(folder / "tmp"), "HOME": str(folder / "home"), "OMP_NUM_THREADS": "1"}
    for name in ("tmp", "home"):
        (folder / name).mkdir(exist_ok=True)
    return subprocess.run(
        [*before, sys.executable, "-m", "simkit", *arguments],
        cwd=folder, env=variables, capture_output=True, timeout=LIMIT, check=False,
    )  # fmt: skip


def outputs(folder: Path) -> dict[str, bytes]:
    """Return the content of all files that a command writes for the user."""
    found = {}
    for path in folder.rglob("*"):
        name = path.relative_to(folder).as_posix()
        if path.is_file() and name.startswith("new") and "/." not in name:
            found[name] = _without_times(path).replace(os.fsencode(folder), b"")
    return found


def _without_times(path: Path) -> bytes:
    """The content of a file, without wall times: results are compared with those of another run."""
    if "timings" in path.parts or path.name in ("timings.csv",):
        return b""
    content = path.read_bytes()
    if path.suffix in (".html", ".xml", ".json", ".svg", ".csv", ".yaml", ".md", ".txt"):
        content = WALL_TIMES.sub(b"", content)
    return content


def others(folder: Path, prepared: frozenset[str]) -> list[str]:
    """Return the names of the files that are neither inputs nor outputs; the cache may have any whole file."""
    names = {p.relative_to(folder).as_posix() for p in folder.rglob("*") if p.is_file()} - prepared
    stays = re.compile(r"new.*|simkit\.lock|cache/\w+/\w+\.bin|tmp/simkit-\d+/\.lock")
    return sorted(name for name in names if not stays.fullmatch(name))


class Bench:
    """Runs one case with one injection after the other.

    Args:
        case: the case.
        top: folder for the folders of the runs.
        fuel: address of a server for `fetch`.
    """

    def __init__(self, case: Case, top: Path, fuel: str) -> None:
        self.case, self.top, self._fuel = case, top, fuel
        self.base = top / "base"
        self.base.mkdir()
        self._write_inputs(self.base)
        self.prepared = frozenset(p.relative_to(self.base).as_posix() for p in self.base.rglob("*") if p.is_file())
        if case.older:
            done = run(case.older.split(), self.base)
            assert done.returncode == 0, done.stderr.decode()
        self.older = outputs(self.base)
        whole = self.copy("whole")
        log = top / "calls.txt"
        traced = ("-y", "-s", "300", "-o", str(log), "-e", f"trace={','.join(ERRORS)}")
        done = run(self.arguments, whole, (*STRACE, *traced))
        assert done.returncode == 0, done.stderr.decode()
        self.whole = outputs(whole)
        assert self.whole != self.older
        self.calls = list(touching_calls(log.read_text(errors="replace"), whole))

    @property
    def arguments(self) -> list[str]:
        return self.case.command.replace("FUEL", self._fuel).split()

    def copy(self, name: str) -> Path:
        folder = self.top / name
        shutil.copytree(self.base, folder, symlinks=True)
        return folder

    def _write_inputs(self, folder: Path) -> None:
        made = recorded()
        files = {**WORLD_FILES, "s.yaml": intact("scenario.yaml"), "sweep.yaml": SWEEP, "t.obj": TETRAHEDRON}
        files |= {n: c for n, c in made.items() if n.startswith("golden/") or n in ("b.mcap", "b.zip")}
        files |= {"mesh.sdf": MESH_WORLD.replace(b"{}", b"t.obj"), "short.mcap": _short_bag()}
        include = f"<include><uri>{self._fuel}/1.0/o/models/box</uri></include>"
        files["fuel.sdf"] = f'<sdf version="1.9"><world name="w">{include}</world></sdf>'.encode()
        for name, content in files.items():
            (folder / name).parent.mkdir(parents=True, exist_ok=True)
            (folder / name).write_bytes(content)

    def problems(self, injection: str, name: str) -> Iterator[str]:
        """Yield what is wrong after a command with an injection and after its restart."""
        folder = self.copy(name)
        is_kill = "SIGKILL" in injection
        try:
            traced = ("-o", "/dev/null", "-e", f"trace={injection.partition(':')[0]}", "-e", f"inject={injection}")
            done = run(self.arguments, folder, (*STRACE, *traced))
        except subprocess.TimeoutExpired:
            yield "does not end"
            return
        said = (done.stdout + done.stderr).decode(errors="replace")
        if "Traceback" in said or "Exception ignored" in said:
            yield f"traceback: {said[-1500:]}"
        if not is_kill and done.returncode not in (0, 1, 2):
            yield f"exit code {done.returncode}: {said[-1500:]}"
        is_mute = injection.startswith("write") and injection.endswith("+")  # standard error fails, too
        if done.returncode in (1, 2) and not is_kill and not is_mute and "error" not in said:
            yield f"exit code {done.returncode} without an error: {said[-300:]}"
        left = outputs(folder)
        is_unseen = injection.startswith(("newfstatat:error", "getdents64:error"))  # then a file counts as missing
        if done.returncode == 0 and left != self.whole and not is_unseen:
            yield f"exit code 0, but {difference(left, self.whole)}: {said[-300:]}"
        elif done.returncode != 0 and not self._may_be_left(folder, left):
            yield f"half written: {difference(left, self.whole)}; exit code {done.returncode}: {said[-300:]}"
        more = others(folder, self.prepared)
        if more and not is_kill and not re.match("unlink|rmdir", injection):
            yield f"left {more[:4]}; exit code {done.returncode}: {said[-300:]}"
        if self.case.older or left != self.whole:
            yield from self._restart(folder, is_kept=bool(re.match("(unlink|rmdir).*:error", injection)))
        shutil.rmtree(folder, ignore_errors=True)

    def _may_be_left(self, folder: Path, left: dict[str, bytes]) -> bool:
        if self.case.is_resumed or left in (self.older, self.whole):
            return True
        if self.case.has_data or self.case.is_pair:
            is_known = left.items() <= self.older.items() | self.whole.items()
            return is_known and (self.case.is_pair or self.older.items() <= left.items())
        return self.case.is_prefix and all(_is_readable(p) for p in (folder / "new.mcap", folder / "new") if p.exists())

    def _restart(self, folder: Path, *, is_kept: bool) -> Iterator[str]:
        """Run the command again; `is_kept` says that a file could not be removed."""
        again = run(self.arguments, folder)
        said = (again.stdout + again.stderr).decode(errors="replace")
        if again.returncode != 0:
            yield f"the restart ends with {again.returncode}: {said[-800:]}"
        elif (left := outputs(folder)) != self.whole and not (is_kept and self.whole.items() <= left.items()):
            yield f"after the restart: {difference(left, self.whole)}"


def difference(left: dict[str, bytes], whole: dict[str, bytes]) -> str:
    missing, more = sorted(whole.keys() - left.keys()), sorted(left.keys() - whole.keys())
    other = sorted(n for n in whole.keys() & left.keys() if whole[n] != left[n])
    return f"missing {missing[:5]}, more {more[:5]}, different {other[:5]}"


def _is_readable(bag: Path) -> bool:
    from simkit.errors import InputError
    from simkit.recording.bags.reader import open_bag_to_read

    if bag.is_dir() and not any(bag.iterdir()):
        return True
    try:
        with open_bag_to_read(bag) as opened:
            sum(1 for _ in opened.messages())
    except InputError:
        return False
    return True


def touching_calls(log: str, folder: Path) -> Iterator[tuple[str, int]]:
    """Yield each system call that touches a folder: its name and its number among those of its thread."""
    counts: Counter[tuple[str, str]] = Counter()
    for line in log.splitlines():
        if (found := LINE.match(line)) is None:
            continue
        name, arguments = found["name"], found["arguments"]
        counts[found["thread"], name] += 1
        paths = [] if name in ("write", "read", "pwrite64") else [path for path in QUOTED.findall(arguments) if path]
        if paths:
            touches = any(p.startswith(f"{folder}/") or not p.startswith("/") for p in paths)
        else:
            touches = f"<{folder}/" in arguments.partition(",")[0]
        if touches and name in ERRORS:
            yield name, counts[found["thread"], name]


@cache
def _short_bag() -> bytes:
    from hostile_bags import Made

    return Made("zstd").content()


@contextmanager
def fuel_server() -> Iterator[str]:
    from packs.fuel.tests.fuel_server import model, served

    with served() as state:
        state.archives["o/models/box"] = [model()]
        yield state.url


def injections(bench: Bench, chance: random.Random) -> Iterator[str]:
    """Yield injections without end: each call that changes something once with a kill, and any with an error."""
    kills = [(name, number) for name, number in bench.calls if name in CHANGES]
    while True:
        if chance.random() < 0.5:
            name, number = chance.choice(kills)
            yield f"{name}:signal=SIGKILL:when={number}"
        else:
            name, number = chance.choice(bench.calls if chance.random() < 0.3 else kills)
            error = chance.choice(ERRORS[name])
            is_full = error in ("ENOSPC", "EDQUOT") and name in ("write", "pwrite64")
            yield f"{name}:error={error}:when={number}{'+' if is_full else ''}"


@pytest.mark.parametrize("name", CASES)
def test_a_kill_or_an_error_at_one_system_call_leaves_whole_files(name: str, tmp_path: Path) -> None:
    chance, found, index = random.Random(f"{SEED} {name}"), [], 0
    with fuel_server() as fuel:
        bench = Bench(CASES[name], tmp_path, fuel)
        began = time.monotonic()
        drawn = injections(bench, chance)
        while index < LEAST or time.monotonic() < began + SECONDS / len(CASES):
            injection = next(drawn)
            for text in bench.problems(injection, str(index)):
                found.append(f"{injection}: {text}")
                print(f"\n{name} {found[-1]}", flush=True)  # noqa: T201 -- read with -s
            index += 1
    took = time.monotonic() - began
    print(f"\n{name}: {index} injections in {took:.0f} s; {len(bench.calls)} calls")  # noqa: T201 -- read with -s
    assert not found, f"{len(found)} in {index}\n" + "\n".join(found[:SHOWN])
