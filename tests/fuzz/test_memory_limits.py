"""Commands and calls with too little memory: one line with a code, and nothing half written."""

from __future__ import annotations

import os
import re
import subprocess
import sys
from pathlib import Path

import pytest
from targets import WORLD_FILES, environment, intact, recorded

pytestmark = [pytest.mark.fuzz, pytest.mark.skipif(sys.platform != "linux", reason="limits of the address space")]
COMMANDS = {
    "check": "check w.sdf",
    "inspect": "inspect w.sdf --json",
    "run": "run w.sdf --duration 0.1 --record out.mcap",
    "record a folder": "run w.sdf --duration 0.1 --record out",
    "convert": "convert w.sdf -o out.xml",
    "vendor": "vendor w.sdf out",
    "bundle": "bundle w.sdf --duration 0.05 -o out.zip",
    "replay": "replay b.zip",
    "golden record": "golden record s.yaml -o out",
    "golden check": "golden check golden --html out.html --junit out.xml",
    "certify": "certify w.sdf --duration 0.05 --runs 2 -o out.json",
    "bag info": "bag info b.mcap",
    "bag export": "bag export b.mcap -o out",
    "sweep": "sweep run sweep.yaml -o out --jobs 1",
    "map": "map w.sdf -o out",
    "plot": "plot b.mcap /odom.pose.pose.position.x -o out.svg",
}
SWEEP = "world: w.sdf\nduration: 0.05\nparameters:\n  physics.max_step_size: [0.001, 0.002]\nmetrics: {t: time}\n"
LIMITS = (90, 290, 330, 400, 550)  # [MiB]
PYTHON = """
import resource, sys
import simkit.build, mujoco, numpy
limit = int(sys.argv[1]) << 20
used = int(next(l for l in open("/proc/self/status") if l.startswith("VmSize")).split()[1]) << 10
resource.setrlimit(resource.RLIMIT_AS, (used + limit, used + limit))
try:
    with simkit.load("w.sdf") as sim:
        sim.spawn("ball.sdf")
        sim.run(0.1)
        sim.snapshot()
except simkit.SimkitError as error:
    print(error.code)
"""
IMPORT = """
import importlib, resource, sys
import simkit.build, mujoco
from simkit.memory_error import check_memory_limit, find_memory_error
limit = int(sys.argv[1]) << 20
used = int(next(l for l in open("/proc/self/status") if l.startswith("VmSize")).split()[1]) << 10
resource.setrlimit(resource.RLIMIT_AS, (8 << 30, 8 << 30))
check_memory_limit()
resource.setrlimit(resource.RLIMIT_AS, (used + limit, used + limit))
try:
    importlib.import_module(sys.argv[2])
except Exception as error:
    print(find_memory_error(error).code)
"""


def _limited(arguments: list[str], folder: Path, limit: int = 0) -> subprocess.CompletedProcess[str]:
    import resource

    def prepare() -> None:
        resource.setrlimit(resource.RLIMIT_CORE, (0, 0))
        if limit:
            resource.setrlimit(resource.RLIMIT_AS, (limit << 20, limit << 20))

    (folder.parent / "tmp").mkdir(exist_ok=True)
    variables = {**environment(), "TMPDIR": str(folder.parent / "tmp"), "COLUMNS": "200"}
    given = {k: v for k, v in variables.items() if v is not None}
    return subprocess.run(
        [sys.executable, *arguments],
        cwd=folder,
        env=given,
        preexec_fn=prepare,
        capture_output=True,
        text=True,
        timeout=300,
        check=False,
    )


def _folder(root: Path) -> Path:
    (folder := root / "work").mkdir()
    for path, content in {**recorded(), **WORLD_FILES, "s.yaml": intact("scenario.yaml")}.items():
        (folder / path).parent.mkdir(parents=True, exist_ok=True)
        (folder / path).write_bytes(content)
    (folder / "sweep.yaml").write_text(SWEEP)
    return folder


@pytest.mark.parametrize("name", COMMANDS)
def test_a_command_with_too_little_memory_ends_with_one_line(name: str, tmp_path: Path) -> None:
    folder, wrong = _folder(tmp_path), []
    before = {path.name for path in folder.iterdir()}
    for limit in LIMITS:
        done = _limited(["-m", "simkit", *COMMANDS[name].split()], folder, limit)
        said = done.stdout + done.stderr
        fault = ""
        # the other process of a comparison may be the one without memory
        codes = (0, 1, 2, 5) if name == "certify" else (0, 1)
        if "Traceback" in said or done.returncode not in codes:
            fault = f"exit code {done.returncode}"
        elif done.returncode == 1 and not re.search(r"SK-CORE-008|the rows? .*failed|failed", said):
            fault = "no code"
        left = [p.name for p in (folder.parent / "tmp").iterdir() if p.name != f"simkit-{os.getuid()}"]
        new = [path for path in folder.iterdir() if path.name not in before]
        left += [path.name for path in new if path.name.startswith(".")]
        if done.returncode == 1 and name not in ("run", "record a folder", "sweep", "bag export", "golden check"):
            left += [path.name for path in new if not path.name.startswith(".")]
        if fault or left:
            wrong.append(f"{limit} MiB: {fault}; left {left}: {said[-600:]}")
        for path in new:
            subprocess.run(["rm", "-rf", str(path)], check=True)
    assert not wrong, "\n".join(wrong)


@pytest.mark.parametrize("limit", [1, 8, 24, 48, 96, 200])
def test_python_calls_raise_an_error_of_simkit(limit: int, tmp_path: Path) -> None:
    done = _limited(["-c", PYTHON, str(limit)], _folder(tmp_path))
    assert done.returncode == 0 and done.stdout.strip() in ("", "SK-CORE-008"), done.stdout + done.stderr[-1500:]


@pytest.mark.parametrize("limit", [1, 60, 130])
@pytest.mark.parametrize("module", ["scipy.special", "scipy.stats", "cv2"])
def test_an_import_of_a_library_with_its_own_openblas_ends(module: str, limit: int, tmp_path: Path) -> None:
    done = _limited(["-c", IMPORT, str(limit), module], tmp_path)
    assert (done.returncode, done.stdout.strip()) == (0, "SK-CORE-008"), done.stdout + done.stderr[-1500:]
