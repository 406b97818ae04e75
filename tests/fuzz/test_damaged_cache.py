"""Eight processes with one damaged cache of meshes: each gets the right meshes, and the cache is repaired."""

from __future__ import annotations

import os
import random
import shutil
import subprocess
import sys
import time
from collections.abc import Callable, Mapping
from pathlib import Path

import pytest
from targets import environment
from test_broken_files import SECONDS, SEED

pytestmark = pytest.mark.fuzz
PROCESSES = 8
LIMIT = 300.0  # [s] for eight processes on a shared processor
MESHES = 3
WORLD = "<sdf version='1.9'><world name='w'>{}</world></sdf>"
MODEL = """<model name="m{n}"><pose>{n} 0 1 0 0 0</pose><link name="l"><collision name="c"><geometry><mesh>
<uri>t{n}.obj</uri></mesh></geometry></collision></link></model>"""
QUESTION = """
import simkit
with simkit.load("w.sdf") as sim:
    model = sim.mj_model
    print(model.mesh_vert.tobytes().hex(), model.mesh_face.tobytes().hex())
    sim.step(5)
    print(sim.snapshot().hash if hasattr(sim.snapshot(), "hash") else sim.mj_data.qpos.tobytes().hex())
"""


def pyramid(height: float) -> str:
    corners = f"v 0 0 0\nv 1 0 0\nv 0 1 0\nv 0 0 {height}\n"
    return corners + "f 1 3 2\nf 1 2 4\nf 1 4 3\nf 2 3 4\n"


def asked(folder: Path, cache: Path, count: int) -> list[tuple[int, str, str]]:
    """Load the world in some processes at once; return their exit codes and what they print."""
    variables = {**environment(), "SIMKIT_CACHE_DIR": str(cache), "HOME": str(folder)}
    processes = [
        subprocess.Popen(
            [sys.executable, "-c", QUESTION],
            cwd=folder, env=variables, stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True,
        )
        for _ in range(count)
    ]  # fmt: skip
    found = []
    for process in processes:
        out, err = process.communicate(timeout=LIMIT)
        found.append((process.returncode, out, err))
    return found


def entries(cache: Path) -> list[Path]:
    return sorted(cache.rglob("*.bin"))


def _change(change: Callable[[bytes, random.Random], bytes]) -> Callable[[Path, random.Random], None]:
    def apply(cache: Path, chance: random.Random) -> None:
        for file in entries(cache):
            file.write_bytes(change(file.read_bytes(), chance))

    return apply


def _flip(content: bytes, chance: random.Random) -> bytes:
    changed = bytearray(content)
    for _ in range(3):
        changed[chance.randrange(len(changed))] ^= 1 << chance.randrange(8)
    return bytes(changed)


def _exchange(cache: Path, _: random.Random) -> None:
    """Each entry gets the content of another mesh, which is whole."""
    files = entries(cache)
    contents = [file.read_bytes() for file in files]
    for file, content in zip(files, [*contents[1:], contents[0]], strict=True):
        file.write_bytes(content)


def _become_folders(cache: Path, _: random.Random) -> None:
    for file in entries(cache):
        file.unlink()
        (file / "x").mkdir(parents=True)


def _become_loops(cache: Path, _: random.Random) -> None:
    for file in entries(cache):
        file.unlink()
        file.symlink_to(file.name)


def _become_pipes(cache: Path, _: random.Random) -> None:
    for file in entries(cache):
        file.unlink()
        os.mkfifo(file)


def _become_devices(cache: Path, _: random.Random) -> None:
    for file in entries(cache):
        file.unlink()
        file.symlink_to("/dev/zero")


def _forbid(cache: Path, _: random.Random) -> None:
    for path in (*entries(cache), *(p for p in cache.rglob("*") if p.is_dir()), cache):
        path.chmod(0)


def _become_a_file(cache: Path, _: random.Random) -> None:
    shutil.rmtree(cache)
    cache.write_bytes(b"no folder")


def _litter(cache: Path, _: random.Random) -> None:
    for file in entries(cache):
        for number in range(50):
            (file.parent / f"tmp{number}.tmp").write_bytes(file.read_bytes()[: number * 10])
        file.unlink()


DAMAGES: Mapping[str, Callable[[Path, random.Random], None]] = {
    "truncated": _change(lambda content, chance: content[: chance.randrange(len(content))]),
    "empty": _change(lambda *_: b""),
    "zeros": _change(lambda content, _: bytes(len(content))),
    "flipped bits": _change(_flip),
    "longer": _change(lambda content, chance: content + chance.randbytes(1000)),
    "of another mesh": _exchange,
    "folders": _become_folders,
    "loops of links": _become_loops,
    "pipes": _become_pipes,
    "devices": _become_devices,
    "forbidden": _forbid,
    "a file for the folder": _become_a_file,
    "unfinished files": _litter,
}
WITHOUT_REPAIR = {"folders", "forbidden", "a file for the folder"}


@pytest.fixture(scope="module")
def place(tmp_path_factory: pytest.TempPathFactory) -> tuple[Path, str]:
    """Return a folder with a world, a whole cache, and what a process prints without a cache."""
    folder = tmp_path_factory.mktemp("cache_attack")
    for number in range(MESHES):
        (folder / f"t{number}.obj").write_text(pyramid(1.0 + number))
    (folder / "w.sdf").write_text(WORLD.format("".join(MODEL.format(n=n) for n in range(MESHES))))
    ((code, right, said),) = asked(folder, folder / "whole", 1)
    assert code == 0, said
    assert len(entries(folder / "whole")) >= MESHES
    return folder, right


@pytest.mark.parametrize("damage", DAMAGES)
def test_eight_processes_get_the_right_answer_from_a_damaged_cache(
    damage: str, place: tuple[Path, str], tmp_path: Path
) -> None:
    folder, right = place
    began, round_ = time.monotonic(), 0
    while round_ == 0 or time.monotonic() < began + SECONDS / len(DAMAGES):
        cache = tmp_path / str(round_)
        shutil.copytree(folder / "whole", cache)
        DAMAGES[damage](cache, random.Random(f"{SEED} {damage} {round_}"))
        for code, out, said in asked(folder, cache, PROCESSES):
            assert (code, out, said) == (0, right, "")
        if damage not in WITHOUT_REPAIR:
            assert [p.name for p in entries(cache) if p.is_file()] == [p.name for p in entries(folder / "whole")]
            for mended, whole in zip(entries(cache), entries(folder / "whole"), strict=True):
                assert mended.read_bytes() == whole.read_bytes()
            assert damage == "unfinished files" or not list(cache.rglob("*.tmp"))
        round_ += 1
    print(f"\n{damage}: {round_ * PROCESSES} loads")  # noqa: T201 -- read with -s


def test_processes_agree_while_another_damages_the_cache_all_the_time(place: tuple[Path, str], tmp_path: Path) -> None:
    folder, right = place
    cache, chance = tmp_path / "cache", random.Random(SEED)
    shutil.copytree(folder / "whole", cache)
    variables = {**environment(), "SIMKIT_CACHE_DIR": str(cache), "HOME": str(folder)}
    began, loads = time.monotonic(), 0
    while loads == 0 or time.monotonic() < began + SECONDS / len(DAMAGES):
        processes = [
            subprocess.Popen(
                [sys.executable, "-c", QUESTION],
                cwd=folder, env=variables, stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True,
            )
            for _ in range(PROCESSES)
        ]  # fmt: skip
        while any(process.poll() is None for process in processes):
            for file in entries(cache):
                try:
                    content = file.read_bytes()
                    file.write_bytes(content[: chance.randrange(len(content) + 1)])
                except OSError:
                    continue
            time.sleep(0.005)
        for process in processes:
            out, said = process.communicate(timeout=LIMIT)
            assert (process.returncode, out, said) == (0, right, "")
        loads += PROCESSES
    print(f"\nwhile it is damaged: {loads} loads")  # noqa: T201 -- read with -s
