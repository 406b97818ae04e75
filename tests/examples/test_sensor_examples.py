"""Each example of a sensor draws its picture: of a plausible size, with something on it, and it says where."""

from __future__ import annotations

import re
import runpy
import sys
import time
from pathlib import Path

import numpy as np
import pytest

pytest.importorskip("matplotlib", reason="the pictures of the sensor pages are drawn by matplotlib")
from PIL import Image

FOLDER = Path(__file__).resolve().parents[2] / "examples" / "sensors"
IMAGES = FOLDER.parents[1] / "docs" / "images" / "sensors"
EXAMPLES = sorted(p for p in FOLDER.glob("*.py") if p.stem != "plots")
LARGEST = 150_000  # bytes
MOST_SECONDS = 10.0  # of processor time, for one; on an idle machine they take less than 2


@pytest.mark.slow
@pytest.mark.parametrize("script", EXAMPLES, ids=lambda p: p.stem)
def test_an_example_draws_its_picture(
    script: Path, tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    out = tmp_path / "picture.png"
    monkeypatch.syspath_prepend(str(FOLDER))
    monkeypatch.setattr(sys, "argv", [str(script), str(out)])
    start = time.process_time()
    runpy.run_path(str(script), run_name="__main__")
    taken = time.process_time() - start
    assert str(out) in capsys.readouterr().out
    assert_is_a_picture(out)
    assert taken < MOST_SECONDS


@pytest.mark.parametrize("script", EXAMPLES, ids=lambda p: p.stem)
def test_its_default_name_is_its_own_and_the_page_has_the_picture(script: Path) -> None:
    assert re.search(rf'run\(main, "{script.stem}\.png"\)', script.read_text(encoding="utf-8"))
    assert_is_a_picture(IMAGES / f"{script.stem}.png")


def assert_is_a_picture(path: Path) -> None:
    assert path.stat().st_size <= LARGEST
    with Image.open(path) as image:
        grey = np.asarray(image.convert("L"), dtype=float)
    height, width = grey.shape
    assert 600 <= width <= 1400
    assert 300 <= height <= 1400
    ink = (grey < 200).mean()
    assert 0.005 < ink < 0.7, "it is empty, or all of it is painted"
    assert grey.std() > 10
