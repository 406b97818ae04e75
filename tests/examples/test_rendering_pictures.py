"""The pictures of `docs/rendering.md` can be drawn, and show what the page says."""

from __future__ import annotations

import importlib.util
from pathlib import Path
from types import ModuleType

import numpy as np
import pytest

FOLDER = Path(__file__).resolve().parents[2] / "examples" / "rendering"


@pytest.fixture
def looks() -> ModuleType:
    spec = importlib.util.spec_from_file_location("looks", FOLDER / "looks.py")
    assert spec is not None and spec.loader is not None
    module = importlib.util.module_from_spec(spec)
    spec.loader.exec_module(module)
    return module


def test_gazebos_quality_adds_shadows_to_the_same_colours(looks: ModuleType) -> None:
    fast, gazebo = (looks.picture(FOLDER / "world.sdf", quality).astype(int) for quality in looks.QUALITIES)
    darker = (fast - gazebo).max(axis=2) > 60
    assert 0.01 < darker.mean() < 0.2
    assert np.abs(fast - gazebo)[~darker].mean() < 3


def test_fog_pales_what_is_far(looks: ModuleType) -> None:
    clear = (FOLDER / "world.sdf").read_text(encoding="utf-8")
    foggy = looks.picture(clear.replace("<sky/>", looks.FOG), "fast").astype(int)
    wall = looks.picture(clear, "fast").astype(int)[50, 200], foggy[50, 200]
    assert np.ptp(wall[0]) > 100 > 40 > np.ptp(wall[1])
