"""Marks and words over a picture: paths, scans, goals, title, legend and scale bar.

They are drawn over the finished image, so that they have the same width at each distance and throw no shadows. The
distances of the image tell which parts of them lie behind an object: these parts are faint.
"""

from __future__ import annotations

import itertools
import math
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field
from typing import TYPE_CHECKING, Final

import numpy as np
from numpy.typing import NDArray

from simkit.float_sum import float_sum
from simkit.number_text import counted
from simkit.recording.pictures.camera import MARGIN, Camera

if TYPE_CHECKING:
    from PIL.ImageDraw import ImageDraw
    from PIL.ImageFont import FreeTypeFont

Points = NDArray[np.float64]
Colours = NDArray[np.uint8]
Distances = NDArray[np.float32]
Colour = tuple[int, int, int]

_PATHS: Final[tuple[Colour, ...]] = ((25, 113, 240), (240, 130, 10), (140, 60, 200), (0, 150, 136), (200, 30, 120))
_SCAN: Final[Colour] = (235, 45, 40)
_GOAL: Final[Colour] = (20, 160, 60)
_INK: Final[Colour] = (32, 36, 40)
_PAPER: Final[Colour] = (255, 255, 255)
MARK_COLOURS: Final = (*_PATHS, _SCAN, _GOAL, _INK, _PAPER)
"""All colours of marks and words."""
_FAINT: Final = 0.3  # opacity of parts behind an object
_SHIFT: Final = 4  # fractional bits of OpenCV's coordinates
_REFERENCE: Final = 800.0  # [px] height of an image whose lines have the widths below
_TOLERANCE: Final = 0.012  # share of the distance by which a mark may lie behind a surface
_MOST_PATHS: Final = len(_PATHS)


@dataclass(frozen=True)
class Marks:
    """Content that is drawn over a picture, in the world frame [m].

    Attributes:
        title: title line.
        paths: path of each model that moved, points of shape (n, 3).
        scans: points of each laser scan by topic, shape (n, 3).
        goals: positions of the newest goals by topic, shape (3,).
    """

    title: str = ""
    paths: Mapping[str, Points] = field(default_factory=dict)
    scans: Mapping[str, Points] = field(default_factory=dict)
    goals: Mapping[str, Points] = field(default_factory=dict)


def draw_overlay(image: Colours, distances: Distances, camera: Camera, marks: Marks) -> Colours:
    """Return a picture with its marks, title, legend and scale bar.

    Args:
        image: picture, shape (height, width, 3).
        distances: distances along the line of sight [m], shape (height, width).
        camera: camera of the picture.
        marks: content to draw.
    """
    hidden, seen = image.copy(), image.copy()
    for number, path in enumerate(marks.paths.values()):
        _draw_path(hidden, seen, distances, camera, path, _PATHS[number % len(_PATHS)])
    for points in marks.scans.values():
        _draw_points(hidden, seen, distances, camera, points)
    faint = np.any(hidden != image, axis=2) & ~np.any(seen != image, axis=2)
    seen[faint] = (_FAINT * hidden[faint] + (1.0 - _FAINT) * image[faint]).astype(np.uint8)
    for goal in marks.goals.values():
        _draw_goal(seen, camera, goal)
    return _draw_words(seen, camera, marks)


# ---------------------------------------------------------------------- marks


def _is_visible(pixels: Points, depth: Points, distances: Distances) -> NDArray[np.bool_]:
    height, width = distances.shape
    column = np.clip(np.rint(pixels[:, 0]), 0, width - 1).astype(int)
    row = np.clip(np.rint(pixels[:, 1]), 0, height - 1).astype(int)
    is_visible: NDArray[np.bool_] = depth <= distances[row, column] * (1.0 + _TOLERANCE)
    return is_visible


def _draw_path(hidden: Colours, seen: Colours, distances: Distances, camera: Camera, path: Points, to: Colour) -> None:
    """Draw a path into both images; only its visible parts into `seen`."""
    import cv2

    pixels, depth = camera.project(path)
    visible = _is_visible(pixels, depth, distances)
    ahead = depth > 0.0
    shifted = _shifted(pixels)
    width = _scaled(camera, 4)
    for wide, colour in ((width + 2, _PAPER), (width, to)):
        for n, (a, b) in enumerate(itertools.pairwise(shifted)):
            if not (ahead[n] and ahead[n + 1]):
                continue
            ends = tuple(map(int, a)), tuple(map(int, b))
            cv2.line(hidden, *ends, colour, wide, cv2.LINE_AA, _SHIFT)
            if visible[n] and visible[n + 1]:
                cv2.line(seen, *ends, colour, wide, cv2.LINE_AA, _SHIFT)


def _draw_points(hidden: Colours, seen: Colours, distances: Distances, camera: Camera, points: Points) -> None:
    import cv2

    if not len(points):
        return
    pixels, depth = camera.project(points)
    height, width = distances.shape
    inside = (depth > 0.0) & (pixels >= 0.0).all(axis=1) & (pixels[:, 0] < width) & (pixels[:, 1] < height)
    pixels, depth = pixels[inside], depth[inside]
    visible = _is_visible(pixels, depth, distances)
    radius = max(1.0, 2.6 * camera.height / _REFERENCE) * (1.0 if len(points) < 2000 else 0.5)
    for (x, y), is_seen in zip(_shifted(pixels), visible, strict=True):
        for image in (hidden, seen) if is_seen else (hidden,):
            cv2.circle(image, (int(x), int(y)), round(radius * 2**_SHIFT), _SCAN, -1, cv2.LINE_AA, _SHIFT)


def _draw_goal(image: Colours, camera: Camera, goal: Points) -> None:
    """Draw a ring and a dot at a goal, also behind objects."""
    import cv2

    pixels, depth = camera.project(goal)
    if depth[0] <= 0.0:
        return
    middle = tuple(int(v) for v in _shifted(pixels)[0])
    radius, width = _scaled(camera, 11), _scaled(camera, 3)
    for colour, wide in ((_PAPER, width + 3), (_GOAL, width)):
        cv2.circle(image, middle, radius << _SHIFT, colour, wide, cv2.LINE_AA, _SHIFT)
    cv2.circle(image, middle, _scaled(camera, 4) << _SHIFT, _GOAL, -1, cv2.LINE_AA, _SHIFT)


def _shifted(pixels: Points) -> NDArray[np.int64]:
    return np.rint(np.clip(pixels, -1e5, 1e5) * 2**_SHIFT).astype(np.int64)


def _scaled(camera: Camera, width: float) -> int:
    """Return a width [px] for the height of the image."""
    return max(1, round(width * camera.height / _REFERENCE))


# ---------------------------------------------------------------------- words


def _draw_words(image: Colours, camera: Camera, marks: Marks) -> Colours:
    """Draw title, legend and scale bar along the edges."""
    from PIL import Image, ImageDraw, ImageFont

    size = max(11.0, 19.0 * camera.height / _REFERENCE)
    font = ImageFont.load_default(size)
    canvas = Image.fromarray(image)
    draw = ImageDraw.Draw(canvas)
    assert isinstance(font, ImageFont.FreeTypeFont)
    edge = round(0.8 * size)
    middle = MARGIN * camera.height / 2
    _text(draw, (edge, middle), _fitted(marks.title, font, camera.width - 2 * edge), font, "lm")
    bottom = camera.height - middle
    left = _draw_scale(draw, camera, font, edge, bottom)
    _draw_legend(draw, font, _legend(marks), (left + 2 * edge, camera.width - edge), bottom)
    return np.asarray(canvas)


def _text(draw: ImageDraw, at: tuple[float, float], text: str, font: FreeTypeFont, anchor: str) -> None:
    """Draw dark letters with a light outline, which can be read over each background."""
    draw.text(
        at, text, fill=_INK, font=font, anchor=anchor, stroke_width=max(1, round(font.size / 9)), stroke_fill=_PAPER
    )


def _fitted(text: str, font: FreeTypeFont, width: float) -> str:
    """Shorten a text to a width [px]."""
    while len(text) > 1 and font.getlength(text) > width:
        text = text[: -2 if text.endswith("…") else -1].rstrip() + "…"
    return text


def scale_length(pixels_per_metre: float, width: float) -> float:
    """Return the longest round length [m] (1, 2 or 5 times a power of ten) of a scale bar of at most `width` [px]."""
    most = width / pixels_per_metre
    power = 10.0 ** math.floor(math.log10(most))
    return max(step * power for step in (1.0, 2.0, 5.0) if step * power <= most * (1.0 + 1e-9))


def length_text(metres: float) -> str:
    """Return a length with the unit that people use for it: `20 cm`, `5 m`, `2 km`."""
    for factor, unit in ((1e-3, "km"), (1.0, "m"), (1e2, "cm"), (1e3, "mm")):
        if metres * factor >= 0.999:
            return f"{metres * factor:g} {unit}"
    return f"{metres * 1e6:g} µm"


def _draw_scale(draw: ImageDraw, camera: Camera, font: FreeTypeFont, edge: float, bottom: float) -> float:
    """Draw a scale bar, which holds for the middle of the scene; return its right end with its text [px]."""
    metres = scale_length(camera.pixels_per_metre, 0.16 * camera.width)
    right = edge + metres * camera.pixels_per_metre
    tick = font.size / 3
    ends = [(edge, bottom - tick, edge, bottom + tick), (right, bottom - tick, right, bottom + tick)]
    for wide, colour in ((_scaled(camera, 6), _PAPER), (_scaled(camera, 2.4), _INK)):
        for line in ((edge, bottom, right, bottom), *ends):
            draw.line(line, fill=colour, width=wide)
    text = length_text(metres)
    _text(draw, (right + 0.6 * font.size, bottom), text, font, "lm")
    return float(right + 0.6 * font.size + font.getlength(text))


def _legend(marks: Marks) -> list[tuple[str, Colour, str]]:
    """Return the entries of the legend: kind of mark, colour and text."""
    entries: list[tuple[str, Colour, str]] = []
    names = list(marks.paths)
    if len(names) <= _MOST_PATHS:
        entries += [("line", _PATHS[n], f"path of {name}") for n, name in enumerate(names)]
    else:
        entries.append(("line", _PATHS[0], f"paths of {counted(len(names), 'model')}"))
    scans = [topic for topic, points in marks.scans.items() if len(points)]
    if scans:
        entries.append(("dots", _SCAN, f"scan {scans[0]}" if len(scans) == 1 else counted(len(scans), "scan")))
    entries += [("ring", _GOAL, f"goal {topic}") for topic in itertools.islice(marks.goals, 3)]
    return entries


def _draw_legend(
    draw: ImageDraw,
    font: FreeTypeFont,
    entries: Sequence[tuple[str, Colour, str]],
    between: tuple[float, float],
    y: float,
) -> None:
    """Draw the entries of the legend in one line that ends at the right edge; leave out those without room."""
    size = font.size
    symbol, gap = 1.6 * size, 1.2 * size
    left, right = between
    shown = [(*entry[:2], _fitted(entry[2], font, 16 * size)) for entry in entries]
    widths = [symbol + 0.4 * size + font.getlength(text) for _, _, text in shown]
    while shown and float_sum(widths) + gap * (len(shown) - 1) > right - left:
        shown.pop()
        widths.pop()
    x = right - float_sum(widths) - gap * max(len(shown) - 1, 0)
    for (kind, colour, text), width in zip(shown, widths, strict=True):
        _draw_symbol(draw, kind, colour, x, y, symbol)
        _text(draw, (x + symbol + 0.4 * size, y), text, font, "lm")
        x += width + gap


def _draw_symbol(draw: ImageDraw, kind: str, colour: Colour, x: float, y: float, width: float) -> None:
    unit = width / 12
    if kind == "line":
        draw.line((x, y, x + width, y), fill=_PAPER, width=round(3.4 * unit))
        draw.line((x, y, x + width, y), fill=colour, width=round(2 * unit))
    elif kind == "dots":
        for share in (0.15, 0.5, 0.85):
            draw.circle((x + share * width, y), 1.4 * unit, fill=colour)
    else:
        draw.circle((x + width / 2, y), 4.5 * unit, outline=_PAPER, width=round(3 * unit))
        draw.circle((x + width / 2, y), 4 * unit, outline=colour, width=round(1.6 * unit))
        draw.circle((x + width / 2, y), 1.5 * unit, fill=colour)
