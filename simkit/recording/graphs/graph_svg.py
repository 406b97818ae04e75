"""Drawing of a graph as SVG, with colours for light and for dark pages."""

from __future__ import annotations

import itertools
from collections.abc import Sequence
from dataclasses import dataclass
from html import escape
from typing import Final

from simkit.recording.charts.canvas import printable
from simkit.recording.graphs.layered_layout import layered_layout

LINE_HEIGHT: Final = 16.0
"""Distance of two lines of a box [px]."""
_MARGIN, _TITLE, _PAD = 24.0, 40.0, 10.0
_CHARACTER: Final = {True: 8.1, False: 6.5}  # [px] width of a character of a bold or a small text
_LONGEST: Final = 44  # characters of a line
_STYLE: Final = """
svg{background:#fff;font-family:system-ui,"Segoe UI",Roboto,"DejaVu Sans",sans-serif}
text{fill:#1d2733}.head{font-size:13px;font-weight:600}.small{font-size:11px;fill:#5b6775}
.title{font-size:18px;font-weight:600}
.node{fill:#e8f0fe;stroke:#3b6fd4}.topic{fill:#fff8e6;stroke:#c98a06}.frame{fill:#e9f7ef;stroke:#2c8a57}
.edge{fill:none;stroke:#8793a1;stroke-width:1.4}.dashed{stroke-dasharray:5 4}.tip{fill:#8793a1}
@media(prefers-color-scheme:dark){svg{background:#14181d}text{fill:#e6eaef}.small{fill:#9aa7b4}
.node{fill:#1c2c4a;stroke:#6d9bf0}.topic{fill:#3a2f12;stroke:#e0b04a}.frame{fill:#173526;stroke:#5cbf8b}
.edge{stroke:#6f7c8a}.tip{fill:#6f7c8a}}
"""


@dataclass(frozen=True)
class GraphBox:
    """Box of a graph.

    Attributes:
        name: unique name.
        kind: `node`, `topic` or `frame`.
        head: main line.
        lines: small lines below it.
        above: small line above it.
    """

    name: str
    kind: str
    head: str
    lines: Sequence[str] = ()
    above: str = ""

    def size(self) -> tuple[float, float]:
        """Return width and height [px]."""
        texts = [(self.head, True), *((line, False) for line in (self.above, *self.lines))]
        width = max(len(shortened(text)) * _CHARACTER[is_bold] for text, is_bold in texts)
        return width + 2 * _PAD + 6, LINE_HEIGHT * (1 + len(self.lines) + bool(self.above)) + 12


@dataclass(frozen=True)
class GraphEdge:
    """Edge of a graph from one box to another; a dashed edge stands for a static transform."""

    start: str
    end: str
    is_dashed: bool = False


def graph_svg(title: str, boxes: Sequence[GraphBox], edges: Sequence[GraphEdge]) -> str:
    """Return a graph as the text of an SVG file."""
    sizes = {box.name: box.size() for box in boxes}
    layout = layered_layout(sizes, [(edge.start, edge.end) for edge in edges])
    width = max(layout.width + 2 * _MARGIN, len(title) * 10 + 2 * _MARGIN)
    height = layout.height + 2 * _MARGIN + _TITLE
    parts = [
        f'<svg xmlns="http://www.w3.org/2000/svg" viewBox="0 0 {width:.0f} {height:.0f}" '
        f'width="{width:.0f}" height="{height:.0f}" role="img"><title>{_text(title)}</title><style>{_STYLE}</style>',
        '<defs><marker id="tip" viewBox="0 0 8 8" refX="7" refY="4" markerWidth="7" markerHeight="7" orient="auto">'
        '<path class="tip" d="M0 0L8 4L0 8z"/></marker></defs>',
        f'<text class="title" x="{_MARGIN}" y="{_MARGIN + 8}">{_text(title)}</text>',
        f'<g transform="translate({_MARGIN} {_MARGIN + _TITLE - 10})">',
    ]
    for edge in edges:
        points = layout.paths.get((edge.start, edge.end))
        if points is not None:
            dashed = " dashed" if edge.is_dashed else ""
            parts.append(f'<path class="edge{dashed}" marker-end="url(#tip)" d="{_curve(points)}"/>')
    parts += [_box(box, layout.boxes[box.name]) for box in boxes]
    return "\n".join([*parts, "</g></svg>\n"])


def _curve(points: Sequence[tuple[float, float]]) -> str:
    """Return a path of smooth pieces between columns and straight lines through them."""
    text = f"M{points[0][0]:.1f} {points[0][1]:.1f}"
    for number, ((x0, y0), (x, y)) in enumerate(itertools.pairwise(points)):
        if number % 2:
            text += f"L{x:.1f} {y:.1f}"
        else:
            bend = (x - x0) / 2
            text += f"C{x0 + bend:.1f} {y0:.1f} {x - bend:.1f} {y:.1f} {x:.1f} {y:.1f}"
    return text


def _box(box: GraphBox, place: tuple[float, float, float, float]) -> str:
    x, y, width, height = place
    radius = 6 if box.kind == "node" else min(height / 2, 16)
    parts = [
        f'<g><title>{_text(box.name)}</title><rect class="{box.kind}" x="{x:.1f}" y="{y:.1f}" '
        f'width="{width:.1f}" height="{height:.1f}" rx="{radius:.0f}"/>'
    ]
    top = y + 6 + LINE_HEIGHT * 0.75
    lines = [
        *([(box.above, "small")] if box.above else []),
        (box.head, "head"),
        *((text, "small") for text in box.lines),
    ]
    for number, (line, role) in enumerate(lines):
        at = f'x="{x + width / 2:.1f}" y="{top + number * LINE_HEIGHT:.1f}" text-anchor="middle"'
        parts.append(f'<text class="{role}" {at}>{_text(shortened(line))}</text>')
    return "".join([*parts, "</g>"])


def shortened(text: str) -> str:
    """Leave out the middle of a long text."""
    if len(text) <= _LONGEST:
        return text
    half = (_LONGEST - 1) // 2
    return f"{text[:half]}…{text[-half:]}"


def _text(text: str) -> str:
    return escape(printable(text))
