"""GIF files that are written frame by frame."""

from __future__ import annotations

from fractions import Fraction
from pathlib import Path

import numpy as np
from PIL import Image, ImageSequence

from simkit.recording.pictures.video_file import GifFile


def frame(place: int) -> np.ndarray:
    """Grey stripes with a red square."""
    picture = np.repeat(np.arange(60, dtype=np.uint8)[:, None, None] // 20 * 60, 80, axis=1).repeat(3, axis=2)
    picture[10:20, place : place + 10] = (255, 0, 0)
    return picture


def test_frames_are_written_while_they_come_and_equal_ones_last_longer(tmp_path: Path) -> None:
    path = tmp_path / "a.gif"
    places, sizes = [0, 0, 20, 40, 40, 40], []
    file = GifFile(path, Fraction(20))
    for place in places:
        file.take(frame(place))
        sizes.append(path.stat().st_size if path.exists() else 0)
    file.close()
    file.close()
    assert sizes[0] == sizes[1] == 0 and file._last is None
    with Image.open(path) as gif:
        found = [(np.array(one.convert("RGB")), one.info["duration"]) for one in ImageSequence.Iterator(gif)]
        assert (gif.info["loop"], gif.info["version"]) == (0, b"GIF89a")
    assert [duration for _, duration in found] == [100, 50, 150]
    for (picture, _), place in zip(found, (0, 20, 40), strict=True):
        np.testing.assert_array_equal(picture, frame(place))


def test_a_file_without_frames_is_not_written(tmp_path: Path) -> None:
    GifFile(tmp_path / "a.gif", Fraction(20)).close()
    assert not (tmp_path / "a.gif").exists()
