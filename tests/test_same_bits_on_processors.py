"""The messages of six worlds have the same bits on processors with other instructions.

An environment variable hides instructions from NumPy or OpenCV. An emulator replaces the whole processor by one without
AVX-512, which changes the code of the C library, Embree, BLAS, NumPy and OpenCV at once. Each run converts its meshes
anew.
"""

from __future__ import annotations

import json
import os
import shutil
import subprocess
import sys
from collections.abc import Callable
from pathlib import Path

import numpy as np
import pytest

PROGRAM = Path(__file__).with_name("message_hashes.py")
WORLDS = ("turtlebot3_world", "tiago_table", "sensor_bench", "cameras", "simple_office_with_people", "navigation")
AVX512 = "AVX512F AVX512CD AVX512_SKX AVX512_CLX AVX512_CNL AVX512_ICL AVX512_SPR"
OLD = tuple(map(int, np.__version__.split(".")[:2])) < (2, 4)
"""NumPy before 2.4 names single features, later versions name levels of the processor."""
NO_V4 = AVX512 if OLD else "X86_V4 AVX512_ICL AVX512_SPR"
NO_V3 = f"{AVX512} AVX2 FMA3 F16C" if OLD else f"X86_V3 {NO_V4}"
SETTINGS = {
    "NumPy without x86-64-v4": {"NPY_DISABLE_CPU_FEATURES": NO_V4},
    "NumPy without x86-64-v3": {"NPY_DISABLE_CPU_FEATURES": NO_V3},
    "OpenCV without AVX": {"OPENCV_CPU_DISABLE": "AVX2,FMA3,FP16,AVX"},
}
EMULATOR = shutil.which("qemu-x86_64")
Hashes = dict[str, str]

pytestmark = [
    pytest.mark.slow,
    pytest.mark.skipif(os.uname().machine != "x86_64", reason="the settings are those of x86-64 processors"),
    pytest.mark.filterwarnings("default"),
]


def run_program(world: str, cache: Path, settings: dict[str, str], command: tuple[str, ...] = ()) -> Hashes:
    environment = {**os.environ, "SIMKIT_CACHE_DIR": str(cache), **settings}
    done = subprocess.run(
        [*command, sys.executable, "-W", "ignore", str(PROGRAM), world],
        env=environment, capture_output=True, text=True, check=False,
    )  # fmt: skip
    assert done.returncode == 0, done.stderr[-2000:]
    return dict(json.loads(done.stdout.splitlines()[-1])["hashes"])


@pytest.fixture(scope="session")
def usual_hashes(tmp_path_factory: pytest.TempPathFactory) -> Callable[[str], Hashes]:
    """Return the hashes of a world on this processor; each world runs once."""
    known: dict[str, Hashes] = {}

    def find(world: str) -> Hashes:
        if world not in known:
            known[world] = run_program(world, tmp_path_factory.mktemp("cache"), {})
        return known[world]

    return find


@pytest.mark.parametrize("setting", SETTINGS)
@pytest.mark.parametrize("world", WORLDS)
def test_messages_do_not_depend_on_instructions(
    world: str, setting: str, tmp_path: Path, usual_hashes: Callable[[str], Hashes]
) -> None:
    assert run_program(world, tmp_path, SETTINGS[setting]) == usual_hashes(world)


@pytest.mark.skipif(EMULATOR is None, reason="needs qemu-x86_64 (Debian: qemu-user)")
@pytest.mark.parametrize("world", WORLDS)
def test_messages_are_the_same_on_an_emulated_haswell(
    world: str, tmp_path: Path, usual_hashes: Callable[[str], Hashes]
) -> None:
    """NumPy uses no AVX2 here, because qemu 7.2 sorts int32 numbers wrongly with NumPy's AVX2 code (`np.argsort`)."""
    assert EMULATOR is not None
    settings = {"NPY_DISABLE_CPU_FEATURES": NO_V3}
    assert run_program(world, tmp_path, settings, (EMULATOR, "-cpu", "Haswell")) == usual_hashes(world)
