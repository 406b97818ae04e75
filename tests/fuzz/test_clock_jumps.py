"""The wall clock jumps, stands still or runs backwards, and files have odd times: results are the same."""

from __future__ import annotations

import os
import re
import shutil
import subprocess
import sys
import time
from pathlib import Path

import pytest
from targets import WORLD_FILES, environment, intact
from test_system_calls import MESH_WORLD, SWEEP, TETRAHEDRON, fuel_server, outputs

pytestmark = [
    pytest.mark.fuzz,
    pytest.mark.skipif(sys.platform != "linux", reason="LD_PRELOAD of Linux"),
    pytest.mark.skipif(shutil.which("cc") is None, reason="no C compiler"),
]
LIMIT = 150.0  # [s] of wall time; the processor may be shared
SHIM = r"""
#define _GNU_SOURCE
#include <dlfcn.h>
#include <stdlib.h>
#include <string.h>
#include <sys/time.h>
#include <time.h>
#include <unistd.h>
#include <sys/syscall.h>
static long count;
static void jump(struct timespec *t) {
    const char *mode = getenv("JUMP");
    long n = __sync_fetch_and_add(&count, 1);
    if (!mode) return;
    if (!strcmp(mode, "back")) t->tv_sec -= 10 * n;
    if (!strcmp(mode, "forward")) t->tv_sec += 3600 * n;
    if (!strcmp(mode, "both")) t->tv_sec += (n % 2 ? 1 : -1) * 86400L * (n % 400);
    if (!strcmp(mode, "still")) { t->tv_sec = 1700000000; t->tv_nsec = 0; }
    if (!strcmp(mode, "1970")) { t->tv_sec = n; t->tv_nsec = 0; }
    if (!strcmp(mode, "2261")) t->tv_sec = 9200000000L + n;
    if (!strcmp(mode, "before 1970")) t->tv_sec = -100000L + n;
}
int clock_gettime(clockid_t id, struct timespec *t) {
    int code = syscall(SYS_clock_gettime, id, t);
    if (!code && (id == CLOCK_REALTIME || id == CLOCK_REALTIME_COARSE)) jump(t);
    return code;
}
int gettimeofday(struct timeval *v, void *zone) {
    struct timespec t; (void)zone;
    syscall(SYS_clock_gettime, CLOCK_REALTIME, &t); jump(&t);
    v->tv_sec = t.tv_sec; v->tv_usec = t.tv_nsec / 1000; return 0;
}
time_t time(time_t *p) {
    struct timespec t;
    syscall(SYS_clock_gettime, CLOCK_REALTIME, &t); jump(&t);
    if (p) *p = t.tv_sec; return t.tv_sec;
}
"""
MODES = ("back", "forward", "both", "still", "1970", "2261", "before 1970")
COMMANDS = {
    "paced run": "run w.sdf --duration 0.6 --rtf 1 --record new.mcap",
    "limited run": "run w.sdf --duration 0.3 --wall-timeout 60 --record new",
    "golden": "golden record s.yaml -o new",
    "bundle": "bundle w.sdf --duration 0.1 -o new.zip",
    "sweep": "sweep run sweep.yaml -o new -n 2 -q",
    "map": "map mesh.sdf -o new",
    "vendor": "vendor mesh.sdf new",
    "certify": "certify w.sdf --duration 0.05 --runs 2 -o new.json",
    "fetch": "fetch fuel.sdf --server FUEL",
}
FILE_TIMES = (0, -(10**9), 10**10, 2**33, 315_532_799)  # [s since 1970]; ZIP has 1980 to 2107


@pytest.fixture(scope="module")
def shim(tmp_path_factory: pytest.TempPathFactory) -> Path:
    folder = tmp_path_factory.mktemp("clock")
    (folder / "clock.c").write_text(SHIM)
    subprocess.run(["cc", "-shared", "-fPIC", "-O1", "-o", "clock.so", "clock.c", "-ldl"], cwd=folder, check=True)
    variables = {**os.environ, "LD_PRELOAD": str(folder / "clock.so"), "JUMP": "still"}
    script = "import time; print(int(time.time()))"
    found = subprocess.run([sys.executable, "-c", script], env=variables, capture_output=True, text=True, check=True)
    assert found.stdout == "1700000000\n", "the clock of a new process is not replaced"
    return folder / "clock.so"


def write_inputs(folder: Path, fuel: str) -> None:
    folder.mkdir(parents=True)
    include = f"<include><uri>{fuel}/1.0/o/models/box</uri></include>"
    files = {**WORLD_FILES, "s.yaml": intact("scenario.yaml"), "sweep.yaml": SWEEP, "t.obj": TETRAHEDRON}
    files |= {"mesh.sdf": MESH_WORLD.replace(b"{}", b"t.obj")}
    files |= {"fuel.sdf": f'<sdf version="1.9"><world name="w">{include}</world></sdf>'.encode()}
    for name, content in files.items():
        (folder / name).write_bytes(content)


def run(command: str, folder: Path, fuel: str, **variables: str) -> tuple[dict[str, bytes], str]:
    """Run a command; return its files and what it says, without wall times."""
    more = {"SIMKIT_CACHE_DIR": str(folder / "cache"), "GZ_FUEL_CACHE_PATH": str(folder / "new_fuel")}
    done = subprocess.run(
        [sys.executable, "-m", "simkit", *command.replace("FUEL", fuel).split()],
        cwd=folder, env={**environment(), **more, "COLUMNS": "200", **variables},
        capture_output=True, text=True, timeout=LIMIT, check=False,
    )  # fmt: skip
    said = done.stdout + done.stderr
    assert done.returncode == 0, said
    assert "Traceback" not in said and "Warning" not in said, said
    assert not re.search(r"-\d+(\.\d+)? m?s\b", said), said  # no negative duration
    return outputs(folder), "\n".join(re.findall(r"^state .*", said, re.MULTILINE))


@pytest.mark.parametrize("name", COMMANDS)
def test_a_wall_clock_that_jumps_changes_no_result(name: str, shim: Path, tmp_path: Path) -> None:
    with fuel_server() as fuel:
        write_inputs(tmp_path / "usual", fuel)
        usual = run(COMMANDS[name], tmp_path / "usual", fuel)
        for mode in MODES:
            write_inputs(tmp_path / mode, fuel)
            began = time.monotonic()
            found = run(COMMANDS[name], tmp_path / mode, fuel, LD_PRELOAD=str(shim), JUMP=mode)
            differing = [n for n in usual[0].keys() | found[0].keys() if usual[0].get(n) != found[0].get(n)]
            assert (differing, found[1]) == ([], usual[1]), mode
            if name == "paced run":
                assert time.monotonic() - began >= 0.6, f"{mode}: the run is not paced"


@pytest.mark.parametrize("name", ["golden", "bundle", "sweep", "map", "vendor", "paced run"])
def test_files_with_odd_times_change_no_result(name: str, tmp_path: Path) -> None:
    write_inputs(tmp_path / "usual", "http://127.0.0.1:9")
    usual = run(COMMANDS[name], tmp_path / "usual", "")
    for seconds in FILE_TIMES:
        folder = tmp_path / str(seconds)
        write_inputs(folder, "http://127.0.0.1:9")
        if (tmp_path / "usual" / "cache").is_dir():
            shutil.copytree(tmp_path / "usual" / "cache", folder / "cache")
        for path in (*folder.rglob("*"), folder):
            os.utime(path, (seconds, seconds))
        found = run(COMMANDS[name], folder, "")
        differing = [n for n in usual[0].keys() | found[0].keys() if usual[0].get(n) != found[0].get(n)]
        assert (differing, found[1]) == ([], usual[1]), seconds
