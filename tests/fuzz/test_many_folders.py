"""100 000 folders and files wherever simkit searches: each command ends soon, with little memory."""

from __future__ import annotations

import os
import re
import shutil
import subprocess
import sys
from collections.abc import Iterator
from dataclasses import dataclass
from pathlib import Path

import pytest
from targets import WORLD_FILES, environment, intact, recorded
from test_system_calls import SWEEP

pytestmark = [pytest.mark.fuzz, pytest.mark.skipif(sys.platform == "win32", reason="limits of POSIX")]
FOLDERS, FILES = 100_000, 2_000
CPU_SECONDS = 60  # [s] of the processor that a command may take
ADDRESSES = 4 << 30  # [bytes] of address space
LIMIT = 400.0  # [s] of wall time; the processor may be shared
URIS = """<sdf version="1.9"><world name="w"><include><uri>model://nowhere</uri></include>
<model name="m"><static>true</static><link name="l"><visual name="v"><geometry><mesh>
<uri>package://nothing/meshes/t.obj</uri></mesh></geometry></visual></link></model></world></sdf>"""


@dataclass(frozen=True)
class Case:
    """A command beside or inside the large folder MANY.

    Attributes:
        command: arguments; MANY stands for the folder.
        codes: exit codes that may come.
    """

    command: str
    codes: tuple[int, ...] = (0,)


CASES = {
    "resource path": Case("check uris.sdf --resource-path MANY", (2,)),
    "package path": Case("check uris.sdf --package-path MANY", (2,)),
    "workspace": Case("check MANY/uris.sdf", (2,)),
    "run in the folder": Case("run MANY/w.sdf --duration 0.05"),
    "scenario": Case("golden record MANY/s.yaml -o new"),
    "golden folder": Case("golden record w.sdf --duration 0.05 -o MANY --force"),
    "golden tree": Case("golden check MANY", (0, 2)),
    "vendored model": Case("vendor MANY/w.sdf new"),
    "bundle": Case("bundle MANY/w.sdf --duration 0.05 -o new.zip"),
    "plugins": Case("run w.sdf --duration 0.05 --plugin-path MANY"),
    "plugin list": Case("plugin list --plugin-path MANY", (0, 2)),
    "interfaces": Case("interface list --interfaces MANY", (0, 2)),
    "lab": Case("lab start 02 MANY/new"),
    "lab in the folder": Case("lab start 02 MANY", (2,)),
    "grade the folder": Case("lab grade MANY", (2,)),
    "sweep into the folder": Case("sweep run sweep.yaml -o MANY/new -n 1 -q"),
    "sweep on the folder": Case("sweep run sweep.yaml -o MANY -n 1 -q", (0, 2)),
    "bag": Case("bag info MANY", (2,)),
    "record into the folder": Case("run w.sdf --duration 0.05 --record MANY/new.mcap"),
    "export": Case("bag export b.mcap -o MANY/new"),
    "fetch": Case("fetch MANY/uris.sdf --dry-run", (0, 2)),
    "models": Case("run w.sdf --duration 0.05 --spawn nowhere:0,0,0 --resource-path MANY", (2,)),
    "world by name": Case("check nowhere --resource-path MANY", (2,)),
}


@pytest.fixture(scope="module")
def many(tmp_path_factory: pytest.TempPathFactory) -> Iterator[Path]:
    """Yield a folder that is a model, a package and a project, with many folders, files and packages."""
    folder = tmp_path_factory.mktemp("many") / "many"
    folder.mkdir()
    for number in range(FOLDERS):
        os.mkdir(f"{folder}/f{number:06}")  # noqa: PTH102 -- 100 000 of them
    for number in range(FILES):
        for name in (f"a{number}.py", f"a{number}.sdf", f"a{number}.mcap.x", f"f{number:06}/package.xml"):
            (folder / name).write_text("")
    config = '<model><name>m</name><sdf version="1.9">w.sdf</sdf></model>'
    (folder / "model.config").write_text(config)
    for name, content in {**WORLD_FILES, "s.yaml": intact("scenario.yaml"), "uris.sdf": URIS.encode()}.items():
        (folder / name).write_bytes(content)
    yield folder
    shutil.rmtree(folder.parent, ignore_errors=True)


@pytest.mark.parametrize("name", CASES)
def test_a_command_ends_soon_beside_a_hundred_thousand_folders(name: str, many: Path, tmp_path: Path) -> None:
    import resource

    case = CASES[name]
    files = {**WORLD_FILES, "sweep.yaml": SWEEP, "uris.sdf": URIS.encode(), "b.mcap": recorded()["b.mcap"]}
    for path, content in files.items():
        (tmp_path / path).write_bytes(content)
    before = {p.name for p in many.iterdir()}

    def limit() -> None:
        resource.setrlimit(resource.RLIMIT_CPU, (CPU_SECONDS, CPU_SECONDS))
        resource.setrlimit(resource.RLIMIT_AS, (ADDRESSES, ADDRESSES))

    done = subprocess.run(
        [sys.executable, "-m", "simkit", *case.command.replace("MANY", str(many)).split()],
        cwd=tmp_path, env={**environment(), "COLUMNS": "200", "OMP_NUM_THREADS": "1"}, preexec_fn=limit,
        capture_output=True, text=True, timeout=LIMIT, check=False, errors="replace",
    )  # fmt: skip
    said = done.stdout + done.stderr
    took = resource.getrusage(resource.RUSAGE_CHILDREN)
    print(f"\n{name}: exit code {done.returncode}, {len(said)} characters, {took.ru_maxrss >> 10} MiB")  # noqa: T201
    for new in {p.name for p in many.iterdir()} - before:
        path = many / new
        shutil.rmtree(path) if path.is_dir() else path.unlink()
    assert done.returncode in case.codes, said[-2000:]
    assert "Traceback" not in said, said[-2000:]
    assert done.returncode == 0 or len(said) < 20_000, said[:500]
    assert done.returncode != 2 or re.search(r"SK-[A-Z]+-\d{3}|Usage", said), said[-500:]
