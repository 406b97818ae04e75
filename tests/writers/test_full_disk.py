"""Writers on a full disk: one line with a code, and nothing half written stays."""

from __future__ import annotations

import re
import subprocess
import sys
from pathlib import Path

import pytest

pytestmark = [pytest.mark.slow, pytest.mark.skipif(sys.platform == "win32", reason="limits of POSIX")]
WORLD = """<sdf version="1.9"><world name="w"><model name="b"><pose>0 0 1 0 0 0</pose><link name="l"><sensor name="imu"
type="imu"><topic>imu</topic><update_rate>50</update_rate></sensor></link></model></world></sdf>"""
COMMANDS = {
    "golden record w.sdf --duration 0.1 -o new": (0, 100, 1500),
    "golden record w.sdf --duration 0.2 -o old --force": (0, 100, 1500),
    "lab start 01_turtlesim new": (0, 100, 1500),
    "vendor w.sdf new": (0, 100),
    "convert w.sdf -o new.sdf": (0, 100),
    "convert w.sdf -o new.xml": (0, 100),
    "bundle w.sdf --duration 0.05 -o new.zip": (0, 100),
    "certify w.sdf --duration 0.02 --runs 2 -o new.json": (0, 100),
    "bag export old.mcap -o new": (0, 100),
    "bag recover old.mcap new.mcap": (0, 100),
    "graph w.sdf -o new.svg": (0, 100),
}


def _simkit(command: str, folder: Path, largest: int | None = None) -> subprocess.CompletedProcess[str]:
    def limit() -> None:
        import resource

        if largest is not None:
            resource.setrlimit(resource.RLIMIT_FSIZE, (largest, largest))

    # without -B, Python 3.11 leaves byte code of simkit that is cut off at the limit
    arguments = [sys.executable, "-B", "-m", "simkit", *command.split(" ")]
    return subprocess.run(
        arguments, cwd=folder, capture_output=True, text=True, preexec_fn=limit, timeout=120, check=False
    )


def _content(folder: Path) -> dict[str, bytes]:
    return {str(path): path.read_bytes() if path.is_file() else b"" for path in sorted(folder.rglob("*"))}


@pytest.fixture(scope="module")
def place(tmp_path_factory: pytest.TempPathFactory) -> Path:
    folder = tmp_path_factory.mktemp("disk")
    (folder / "w.sdf").write_text(WORLD)
    for command in ("golden record w.sdf --duration 0.1 -o old", "run w.sdf --duration 0.1 --record old.mcap"):
        assert _simkit(command, folder).returncode == 0
    return folder


@pytest.mark.parametrize("command", COMMANDS)
def test_a_full_disk_leaves_nothing(command: str, place: Path) -> None:
    before = _content(place)
    for largest in COMMANDS[command]:
        done = _simkit(command, place, largest)
        said = done.stdout + done.stderr
        assert done.returncode == 2 and re.search("SK-.*(File too large|temporary directory)", said), said[-500:]
        assert "Traceback" not in said and "[Errno" not in said, said[-500:]
        assert _content(place) == before, largest
