"""The robot of the visual servoing example stops before the orange pylon; what it read is where things are."""

from __future__ import annotations

import math
import runpy
import sys
from pathlib import Path
from typing import Any

import numpy as np
import pytest

EXAMPLE = Path(__file__).resolve().parents[2] / "examples" / "visual_servoing" / "servo.py"
PYLON, RADIUS = np.array((1.7, 1.1)), 0.1
LENS = np.array((0.069, -0.047))  # on the robot, from its base_footprint
WIDTH, FOV = 320, 1.02974
FOCAL = WIDTH / (2 * math.tan(FOV / 2))


@pytest.fixture(scope="module")
def servo() -> dict[str, Any]:
    return runpy.run_path(str(EXAMPLE))


@pytest.fixture(scope="module")
def sights(servo: dict[str, Any]) -> Any:
    return servo["run"]()


def in_camera(sight: Any) -> np.ndarray:
    """The pylon's axis seen from above, in the camera's frame: ahead, to the left [m]."""
    x, y, heading = sight.place
    turn = np.array(((math.cos(heading), math.sin(heading)), (-math.sin(heading), math.cos(heading))))
    return turn @ (PYLON - (x, y)) - LENS


def depth_along(sight: Any) -> float:
    """Of the pylon's surface, on the ray of the centroid's column [m]."""
    ray = np.array((1.0, (WIDTH / 2 - sight.centroid[0]) / FOCAL))
    axis = in_camera(sight)
    a, b, c = ray @ ray, ray @ axis, axis @ axis - RADIUS**2
    return float((b - math.sqrt(b * b - a * c)) / a)


def is_whole(sight: Any) -> bool:
    return sight.centroid is not None and not sight.mask[:, [0, -1]].any()


def test_it_stops_half_a_metre_before_the_pylon_and_faces_it(sights: Any) -> None:
    end = sights[-1]
    assert end.distance == pytest.approx(0.5, abs=0.01)
    ahead, left = in_camera(end)
    assert math.hypot(ahead, left) - RADIUS == pytest.approx(0.5, abs=0.02)
    assert end.centroid[0] == pytest.approx(WIDTH / 2, abs=4)
    assert end.time < 20


def test_the_distance_of_each_picture_is_the_truth_within_a_centimetre(sights: Any) -> None:
    whole = [sight for sight in sights if is_whole(sight)]
    assert len(whole) > 50
    for sight in whole:
        assert sight.distance == pytest.approx(depth_along(sight), abs=0.01)


def test_the_centroid_is_where_the_pylon_is(sights: Any) -> None:
    for sight in filter(is_whole, sights):
        ahead, left = in_camera(sight)
        assert sight.centroid[0] == pytest.approx(WIDTH / 2 - FOCAL * left / ahead, abs=2)


def test_it_searches_first_and_is_not_taken_in_by_other_colours(sights: Any) -> None:
    """The blue box, the green ball and the yellow post come before its eyes as well."""
    assert sights[0].centroid is None
    first = next(sight for sight in sights if sight.centroid is not None)
    ahead, left = in_camera(first)
    assert abs(math.atan2(left, ahead)) < FOV / 2 + math.atan2(RADIUS, ahead)


def test_the_same_seed_sees_the_same(servo: dict[str, Any], sights: Any) -> None:
    again = servo["run"](timeout=0.35)
    assert len(again) == 4
    for one, other in zip(again, sights, strict=False):
        assert one.place == other.place
        assert np.array_equal(one.picture, other.picture)


def test_it_draws_its_picture(servo: dict[str, Any], sights: Any, tmp_path: Path) -> None:
    pytest.importorskip("matplotlib", reason="the picture is drawn by matplotlib")
    from PIL import Image

    servo["draw"](sights, tmp_path / "servo.png")
    with Image.open(tmp_path / "servo.png") as image:
        assert image.size == (880, 594)
        assert np.asarray(image.convert("L"), dtype=float).std() > 20


def test_its_documents_picture_is_there() -> None:
    picture = EXAMPLE.parents[2] / "docs" / "images" / "visual_servoing.png"
    assert 10_000 < picture.stat().st_size < 150_000


def test_a_wrong_command_line_says_how(servo: dict[str, Any], monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(sys, "argv", ["servo.py", "a.png", "b.png"])
    with pytest.raises(SystemExit, match=r"usage: .*OUT\.png"):
        runpy.run_path(str(EXAMPLE), run_name="__main__")


@pytest.mark.slow
@pytest.mark.usefixtures("servo")
def test_it_runs_without_matplotlib_and_tells_what_the_picture_needs(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    monkeypatch.setitem(sys.modules, "matplotlib", None)
    monkeypatch.setattr(sys, "argv", [str(EXAMPLE)])
    monkeypatch.chdir(tmp_path)
    runpy.run_path(str(EXAMPLE), run_name="__main__")
    said = capsys.readouterr()
    assert said.out.startswith("stopped after") and "pip install matplotlib" in said.err
    assert list(tmp_path.iterdir()) == []
