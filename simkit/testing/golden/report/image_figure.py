"""Images of a topic side by side: golden run, run and their difference."""

from __future__ import annotations

import base64
from collections.abc import Sequence
from dataclasses import dataclass
from typing import Final

import numpy as np

from simkit.testing.golden.compare.difference import Difference, Verdict
from simkit.testing.run_record.record import Array, Pictures

_LARGEST: Final = 256  # [px]: a kept picture that is larger is shown smaller
_BLUE_FIRST: Final = ("bgr", "8UC3")


@dataclass(frozen=True)
class ImageRow:
    """Images of one message: name and `data:` address of each."""

    images: Sequence[tuple[str, str]]
    caption: str


@dataclass(frozen=True)
class ImageFigure:
    """Images of one difference, which `words` describes."""

    words: str
    rows: Sequence[ImageRow]


def image_figure(verdict: Verdict, difference: Difference) -> ImageFigure | None:
    """Return the first images that differ: golden, run, and the difference, brighter; None where there are none.

    Args:
        verdict: the difference's.
        difference: of a topic of images.
    """
    streams = [record.streams.get(difference.topic) for record in (verdict.golden, verdict.run)]
    if streams[0] is None or streams[1] is None or streams[0].pictures is None or streams[1].pictures is None:
        return None
    golden, run = streams[0].pictures, streams[1].pictures
    messages = np.intersect1d(golden.messages, run.messages)
    count = len(messages)
    if count == 0:
        return None
    golden, run = golden.at(messages), run.at(messages)
    # the first that was kept at or after the first that differs
    index = int(np.searchsorted(messages, difference.index)) if difference.index >= 0 else -1
    times = streams[0].times_ns
    rows = []
    for place in _shown_messages(golden, run, count, index):
        message = int(messages[place])
        seconds = f" at {times[message] * 1e-9:.6g} s" if message < len(times) else ""
        rows.append(_image_row(golden, run, place, f"picture {message}{seconds}"))
    return ImageFigure(difference.words, rows)


def _shown_messages(golden: Pictures, run: Pictures, count: int, index: int) -> list[int]:
    """The first that differs, and the one that differs most."""
    if golden.small.shape[1:] != run.small.shape[1:]:
        return [index if 0 <= index < count else 0]
    far = np.array([_mean_difference(_absolute_difference(golden.small[i], run.small[i])) for i in range(count)])
    first = index if 0 <= index < count else int((far > 0.0).argmax())
    worst = int(np.nan_to_num(far).argmax())
    return [first, worst] if far[worst] > 1.5 * far[first] and worst != first else [first]


def _image_row(golden: Pictures, run: Pictures, index: int, caption: str) -> ImageRow:
    ours, theirs = _downsample(golden.small[index]), _downsample(run.small[index])
    low, high = _value_range(ours, theirs)
    shown = [
        ("golden", _display_pixels(ours, golden.encoding, low, high)),
        ("run", _display_pixels(theirs, run.encoding, low, high)),
    ]
    if ours.dtype.kind == "f" or ours.dtype == np.uint16:
        caption += f", from {low:.4g} (dark) to {high:.4g} (bright)"
    if ours.shape == theirs.shape:
        factor, apart = _amplified_difference(
            _absolute_difference(ours, theirs), high - low if ours.dtype != np.uint8 else 255.0
        )
        shown.append((f"difference × {factor:.3g}", apart))
    tiles = _tile_text(golden, run, index)
    return ImageRow([(name, _png(image)) for name, image in shown], caption + tiles)


def _tile_text(golden: Pictures, run: Pictures, index: int) -> str:
    if index >= min(len(golden.tiles), len(run.tiles)) or golden.tiles.shape[1:] != run.tiles.shape[1:]:
        return ""
    other = golden.tiles[index] != run.tiles[index]
    return f"; {int(other.sum())} of {other.size} tiles of the whole picture differ" if other.size else ""


def _downsample(image: Array) -> Array:
    step = -(-max(image.shape[:2]) // _LARGEST)
    return image[::step, ::step]


def _value_range(*images: Array) -> tuple[float, float]:
    """Lowest and highest of all values that are finite, zero left out where it is the lowest of depths."""
    values = [image[np.isfinite(image)] if image.dtype.kind == "f" else image.reshape(-1) for image in images]
    values = [v for v in values if v.size]
    low = min((float(v.min()) for v in values), default=0.0)
    high = max((float(v.max()) for v in values), default=1.0)
    return low, high if high > low else low + 1.0


def _absolute_difference(ours: Array, theirs: Array) -> Array:
    """Difference without its sign; 0 where neither is finite, nan where one of them is."""
    a, b = np.asarray(ours, np.float64), np.asarray(theirs, np.float64)
    with np.errstate(invalid="ignore"):
        off = np.abs(a - b)
    same = (a == b) | (np.isnan(a) & np.isnan(b))
    return np.where(same, 0.0, np.where(np.isfinite(off), off, np.nan))


def _mean_difference(apart: Array) -> float:
    """Mean of a difference; a pixel that is finite in one image only counts as far."""
    return float(np.nan_to_num(apart, nan=255.0).mean()) if apart.size else 0.0


def _amplified_difference(apart: Array, full: float) -> tuple[float, Array]:
    """Return the factor by which the difference is brightened, and that image; values that are not finite are white."""
    most = float(apart[np.isfinite(apart)].max(initial=0.0))
    factor = max(1.0, full / most) if most > 0.0 else 1.0
    scaled = np.where(np.isfinite(apart), apart * factor * 255.0 / full, 255.0)
    return factor, _three_channels(np.clip(scaled, 0, 255).astype(np.uint8))


def _display_pixels(image: Array, encoding: str, low: float, high: float) -> Array:
    """Convert an image to three channels, blue first, as OpenCV writes it."""
    if image.dtype != np.uint8:
        finite = np.isfinite(image)
        scaled = np.where(finite, (np.where(finite, image, low).astype(np.float64) - low) / (high - low), 0.0)
        return _three_channels(np.clip(scaled * 255.0, 0, 255).astype(np.uint8))
    if image.ndim == 3 and image.shape[2] >= 3:
        three = image[:, :, :3]
        return three if encoding.lower().startswith(_BLUE_FIRST[0]) or encoding == _BLUE_FIRST[1] else three[:, :, ::-1]
    return _three_channels(image)


def _three_channels(image: Array) -> Array:
    plane = image if image.ndim == 2 else image[:, :, 0]
    return np.repeat(plane[:, :, None], 3, axis=2)


def _png(image: Array) -> str:
    import cv2

    written, data = cv2.imencode(".png", np.ascontiguousarray(image))
    return "data:image/png;base64," + base64.b64encode(data.tobytes()).decode() if written else ""
