"""Images of the software renderer have the same bits with the instructions of other processors."""

from __future__ import annotations

import os
import subprocess
import sys
from pathlib import Path

import pytest

ROOT = Path(__file__).resolve().parents[4]
SCRIPT = """
import hashlib
from drawn_models import draw, view
from test_software_beside_gl import ASSETS, SHAPES, TWO
from drawn_models import model
from simkit.scene import Surroundings
from simkit.scene.world import Fog
from simkit.sensors.cameras.rendering.software.software_renderer import SoftwareRenderer
from simkit.sensors.cameras.rendering.view import Shot

world = model(SHAPES, ASSETS, TWO)
fog = Surroundings(sky=True, fog=Fog("exp", (0.7, 0.7, 0.9, 1.0), density=0.2))
for quality, surroundings in (("fast", fog), ("gazebo", Surroundings())):
    for shot in (Shot(view(), depth=True), Shot(view(), ids=True)):
        found = draw(SoftwareRenderer, world, shot, (-4.0, -2.5, 2.6), (0.0, 0.0, 0.4),
                     quality=quality, surroundings=surroundings)
        for values in (found.colours, found.depths, found.ids):
            if values is not None:
                print(hashlib.sha256(values.tobytes()).hexdigest())
"""


def hashes(**environment: str) -> str:
    """Return the hashes of images of one world, drawn in a process of its own."""
    here = Path(__file__).parent
    paths = os.pathsep.join(map(str, (ROOT, here, here.parents[1])))
    done = subprocess.run(
        [sys.executable, "-c", SCRIPT],
        env={**os.environ, "PYTHONPATH": paths, **environment},
        capture_output=True, text=True, timeout=120, check=False,
    )  # fmt: skip
    assert done.returncode == 0, done.stderr
    return done.stdout


@pytest.mark.slow
def test_instruction_sets_of_other_processors_do_not_change_the_bits() -> None:
    expected = hashes()
    assert len(expected.split()) == 6
    for environment in (
        {"NPY_DISABLE_CPU_FEATURES": "X86_V4"},
        {"NPY_DISABLE_CPU_FEATURES": "X86_V4 X86_V3"},
        {"OPENCV_CPU_DISABLE": "AVX2,AVX,FMA3,FP16"},
        {"OPENBLAS_CORETYPE": "Prescott"},
    ):
        assert hashes(**environment) == expected, environment
