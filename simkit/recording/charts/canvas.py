"""Canvases for lines and text, as SVG or PNG. Equal calls give equal bytes.

The background is white. Viewers that prefer dark pages show an SVG file with the colours of `_DARK`.
"""

from __future__ import annotations

import io
from html import escape
from typing import Final, Literal

import numpy as np
from numpy.typing import NDArray

from simkit.float_sum import float_sum

Anchor = Literal["start", "middle", "end"]
Points = NDArray[np.float64]

_FONT: Final = "Helvetica,Arial,'DejaVu Sans',sans-serif"
_LETTER: Final = 0.56  # mean width of a letter, as a fraction of the font size
_REPLACEMENTS = {"²": "^2", "³": "^3", "µ": "u"}  # characters that the font of PNG files lacks
_PNG_SCALE = 2  # pixels of a PNG file per pixel of the canvas
_OVERSAMPLING = 2  # factor of the drawing resolution, for smooth thin lines
_INK: Final = "#222222"
_DARK: Final = {
    "#ffffff": "#15181c", _INK: "#e4e6ea", "#e4e4e4": "#2c323a", "#888888": "#7d8794", "#1f77b4": "#6fb3ff",
    "#d62728": "#ff7b84", "#2ca02c": "#6fd08c", "#ff7f0e": "#ffa24d", "#9467bd": "#c9a0e8", "#17becf": "#5fdbe8",
    "#8c564b": "#c99a8f", "#e377c2": "#f2a3db", "#7f7f7f": "#b0b7c0",
}  # fmt: skip
"""Colours on dark pages."""
_UNPRINTABLE = dict.fromkeys((*range(32), 0xFFFE, 0xFFFF), " ")  # characters that XML does not allow


def printable(text: str) -> str:
    """Replace characters that XML does not allow by spaces."""
    return text.translate(_UNPRINTABLE)


def path_data(points: Points) -> str:
    """Return the commands of an SVG path through points, shape (n, 2)."""
    return "M" + "L".join(f"{x:.1f} {y:.1f}" for x, y in points.tolist())


def text_width(text: str, size: float) -> float:
    """Estimate the width of a text [px]."""
    return len(text) * _LETTER * size


def _dark_rules() -> str:
    """Return the style rules that replace the colours of lines, discs and texts."""
    return "".join(f'[fill="{a}"]{{fill:{b}}}[stroke="{a}"]{{stroke:{b}}}' for a, b in _DARK.items())


class SvgCanvas:
    """Canvas that becomes an SVG file."""

    def __init__(self, width: int, height: int) -> None:
        self._parts = [
            f'<svg xmlns="http://www.w3.org/2000/svg" width="{width}" height="{height}" '
            f'viewBox="0 0 {width} {height}" font-family="{_FONT}">',
            f"<style>@media(prefers-color-scheme:dark){{{_dark_rules()}}}</style>",
            f'<rect width="{width}" height="{height}" fill="#ffffff"/>',
        ]

    def line(self, points: Points, colour: str, width: float = 1.0, dash: tuple[float, ...] = ()) -> None:
        """Draw a line through points, shape (n, 2)."""
        dashes = f' stroke-dasharray="{" ".join(f"{d:g}" for d in dash)}"' if dash else ""
        self._parts.append(
            f'<path d="{path_data(points)}" fill="none" stroke="{colour}" stroke-width="{width:g}" '
            f'stroke-linejoin="round"{dashes}/>'
        )

    def dots(self, points: Points, colour: str, radius: float) -> None:
        """Draw a disc at each point, shape (n, 2)."""
        for x, y in points.tolist():
            self._parts.append(f'<circle cx="{x:.1f}" cy="{y:.1f}" r="{radius:g}" fill="{colour}"/>')

    def text(
        self, x: float, y: float, text: str, size: float, anchor: Anchor = "start", *, upright: bool = False
    ) -> None:
        """Draw a text with its baseline at (x, y); `upright` rotates it to read upwards."""
        turned = f' transform="rotate(-90 {x:.1f} {y:.1f})"' if upright else ""
        shown = escape(printable(text), quote=False)
        self._parts.append(
            f'<text x="{x:.1f}" y="{y:.1f}" font-size="{size:g}" text-anchor="{anchor}" fill="{_INK}"{turned}>'
            f"{shown}</text>"
        )

    def result(self) -> bytes:
        """Return the content of the file."""
        return ("\n".join([*self._parts, "</svg>"]) + "\n").encode("utf-8", "replace")


class PngCanvas:
    """Canvas that becomes a PNG file with twice as many pixels."""

    def __init__(self, width: int, height: int) -> None:
        from PIL import Image, ImageDraw

        self._scale = _PNG_SCALE * _OVERSAMPLING
        self._image = Image.new("RGB", (width * self._scale, height * self._scale), "#ffffff")
        self._draw = ImageDraw.Draw(self._image)

    def line(self, points: Points, colour: str, width: float = 1.0, dash: tuple[float, ...] = ()) -> None:
        """Draw a line through points, shape (n, 2)."""
        thick = max(1, round(width * self._scale))
        for piece in _dash(points, dash) if dash else [points]:
            flat = [(x * self._scale, y * self._scale) for x, y in piece.tolist()]
            self._draw.line(flat, fill=colour, width=thick, joint="curve")

    def dots(self, points: Points, colour: str, radius: float) -> None:
        """Draw a disc at each point, shape (n, 2)."""
        for x, y in points.tolist():
            box = [(c + r) * self._scale for r in (-radius, radius) for c in (x, y)]
            self._draw.ellipse(box, fill=colour)

    def text(
        self, x: float, y: float, text: str, size: float, anchor: Anchor = "start", *, upright: bool = False
    ) -> None:
        """Draw a text with its baseline at (x, y); `upright` rotates it to read upwards."""
        from PIL import Image, ImageDraw, ImageFont

        font = ImageFont.load_default(size * self._scale)
        font_anchor = {"start": "ls", "middle": "ms", "end": "rs"}[anchor]
        text = text.translate(_UNPRINTABLE | str.maketrans(_REPLACEMENTS))
        if not upright:
            self._draw.text((x * self._scale, y * self._scale), text, fill=_INK, font=font, anchor=font_anchor)
            return
        left, top, right, bottom = font.getbbox(text, anchor="ls")
        strip = Image.new("L", (max(1, round(right - left)), max(1, round(bottom - top))), 0)
        ImageDraw.Draw(strip).text((-left, -top), text, fill=255, font=font, anchor="ls")
        turned = strip.transpose(Image.Transpose.ROTATE_90)
        up = {"start": turned.height, "middle": turned.height / 2, "end": 0}[anchor]
        self._image.paste(_INK, (round(x * self._scale + top), round(y * self._scale - up)), turned)

    def result(self) -> bytes:
        """Return the content of the file."""
        from PIL import Image

        size = (self._image.width // _OVERSAMPLING, self._image.height // _OVERSAMPLING)
        file = io.BytesIO()
        self._image.resize(size, Image.Resampling.BOX).save(file, "PNG")
        return file.getvalue()


Canvas = SvgCanvas | PngCanvas
"""Canvas for a chart. Positions and sizes are in pixels from the upper left corner."""


def _dash(points: Points, dash: tuple[float, ...]) -> list[Points]:
    """Return the drawn pieces of a dashed line."""
    steps = np.hypot(*np.diff(points, axis=0).T)
    along = np.concatenate(([0.0], np.cumsum(steps)))
    edges = np.cumsum(np.tile(dash, int(along[-1] / float_sum(dash)) + 1))
    starts = np.concatenate(([0.0], edges[1::2]))
    dashes = []
    for start, end in zip(starts, edges[::2], strict=False):
        if start >= along[-1]:
            break
        end = min(end, along[-1])
        inside = points[(along > start) & (along < end)]
        ends = [[float(np.interp(at, along, points[:, i])) for i in (0, 1)] for at in (start, end)]
        dashes.append(np.vstack((ends[0], inside, ends[1])))
    return dashes
