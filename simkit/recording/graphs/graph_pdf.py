"""Drawing of a graph as a PDF of one page, without compression and without other programs."""

from __future__ import annotations

import itertools
import math
from collections.abc import Iterator, Sequence
from typing import Final

from simkit.recording.charts.canvas import printable
from simkit.recording.graphs.graph_svg import LINE_HEIGHT, GraphBox, GraphEdge, shortened
from simkit.recording.graphs.layered_layout import layered_layout

_MARGIN, _TITLE = 24.0, 40.0
_HEAD, _SMALL, _LARGE = 12.0, 10.0, 16.0  # [pt] sizes of the texts
_ADVANCE: Final = 0.6  # width of a character of Courier, as a part of its size
_ROUND: Final = 0.5523  # distance of the control points of a quarter of a circle, as a part of its radius
_TIP, _TIP_HALF_WIDTH = 7.0, 3.0  # [pt]
_FILL: Final = {"node": "0.91 0.94 1", "topic": "1 0.97 0.9", "frame": "0.91 0.97 0.94"}
_STROKE: Final = {"node": "0.23 0.44 0.83", "topic": "0.79 0.54 0.02", "frame": "0.17 0.54 0.34"}
_GREY, _BLACK = "0.53 0.58 0.63", "0.11 0.15 0.2"
Point = tuple[float, float]


def graph_pdf(title: str, boxes: Sequence[GraphBox], edges: Sequence[GraphEdge]) -> bytes:
    """Return a graph as a PDF file. Characters outside Latin-1 are question marks."""
    sizes = {box.name: box.size() for box in boxes}
    layout = layered_layout(sizes, [(edge.start, edge.end) for edge in edges])
    width = max(layout.width, len(title) * _LARGE * _ADVANCE) + 2 * _MARGIN
    height = layout.height + 2 * _MARGIN + _TITLE
    page = _Page(height)
    page.text(title, (_MARGIN, _MARGIN + 8), _LARGE)
    page.origin = (_MARGIN, _MARGIN + _TITLE - 10)
    for edge in edges:
        points = layout.paths.get((edge.start, edge.end))
        if points is not None:
            page.edge(points, is_dashed=edge.is_dashed)
    for box in boxes:
        page.box(box, layout.boxes[box.name])
    return _file(width, height, "\n".join(page.operators).encode("latin-1"))


class _Page:
    """Operators of a page. Places have their origin at the top; those of PDF have it at the bottom.

    Args:
        height: height of the page [pt].
    """

    def __init__(self, height: float) -> None:
        self._height = height
        self.origin = (0.0, 0.0)
        self.operators: list[str] = []

    def _at(self, place: Point) -> str:
        x, y = place
        return f"{x + self.origin[0]:.2f} {self._height - y - self.origin[1]:.2f}"

    def text(self, text: str, place: Point, size: float, *, is_bold: bool = True, is_centred: bool = False) -> None:
        """Write a line of text."""
        x, y = place
        if is_centred:
            x -= len(text) * size * _ADVANCE / 2
        plain = printable(text).encode("latin-1", "replace").decode("latin-1")
        for sign in "\\()":
            plain = plain.replace(sign, f"\\{sign}")
        font = f"/F{2 if is_bold else 1} {size:g} Tf"
        self.operators.append(f"BT {_BLACK} rg {font} {self._at((x, y))} Td ({plain}) Tj ET")

    def edge(self, points: Sequence[Point], *, is_dashed: bool) -> None:
        """Draw smooth pieces between columns and straight lines through them, with a tip at the end."""
        path = [f"{self._at(points[0])} m"]
        for number, ((x0, y0), (x, y)) in enumerate(itertools.pairwise(points)):
            bend = (x - x0) / 2
            inner = f"{self._at((x0 + bend, y0))} {self._at((x - bend, y))} "
            path.append(f"{self._at((x, y))} l" if number % 2 else f"{inner}{self._at((x, y))} c")
        self.operators.append(f"{_GREY} RG 1.2 w [{'5 4' if is_dashed else ''}] 0 d {' '.join(path)} S [] 0 d")
        x, y = points[-1]
        side = math.copysign(_TIP, x - points[-2][0]) if len(points) > 1 else _TIP
        corners = [(x, y), (x - side, y - _TIP_HALF_WIDTH), (x - side, y + _TIP_HALF_WIDTH)]
        first, *others = map(self._at, corners)
        self.operators.append(f"{_GREY} rg {first} m {' '.join(f'{corner} l' for corner in others)} h f")

    def box(self, box: GraphBox, place: tuple[float, float, float, float]) -> None:
        """Draw a box with its lines."""
        x, y, width, height = place
        radius = 6.0 if box.kind == "node" else min(height / 2, 16.0)
        colours = f"{_FILL[box.kind]} rg {_STROKE[box.kind]} RG 1 w"
        self.operators.append(f"{colours} {' '.join(self._rounded(x, y, width, height, radius))} h B")
        lines = [*([(box.above, False)] if box.above else []), (box.head, True), *((line, False) for line in box.lines)]
        for number, (line, is_bold) in enumerate(lines):
            at = (x + width / 2, y + 6 + LINE_HEIGHT * (0.75 + number))
            self.text(shortened(line), at, _HEAD if is_bold else _SMALL, is_bold=is_bold, is_centred=True)

    def _rounded(self, x: float, y: float, width: float, height: float, radius: float) -> Iterator[str]:
        near, right, bottom = radius * (1 - _ROUND), x + width, y + height
        yield f"{self._at((x + radius, y))} m {self._at((right - radius, y))} l"
        corners = (
            ((right - near, y), (right, y + near), (right, y + radius), (right, bottom - radius)),
            ((right, bottom - near), (right - near, bottom), (right - radius, bottom), (x + radius, bottom)),
            ((x + near, bottom), (x, bottom - near), (x, bottom - radius), (x, y + radius)),
            ((x, y + near), (x + near, y), (x + radius, y), (x + radius, y)),
        )
        for first, second, end, line in corners:
            yield f"{self._at(first)} {self._at(second)} {self._at(end)} c {self._at(line)} l"


def _file(width: float, height: float, content: bytes) -> bytes:
    """Return a PDF file with one page (ISO 32000-1, 7.5) and two of the fonts that every viewer has."""
    fonts = "/Type /Font /Subtype /Type1 /Encoding /WinAnsiEncoding /BaseFont"
    page = f"/Type /Page /Parent 2 0 R /MediaBox [0 0 {width:.0f} {height:.0f}] /Contents 4 0 R"
    objects = [
        b"<< /Type /Catalog /Pages 2 0 R >>",
        b"<< /Type /Pages /Kids [3 0 R] /Count 1 >>",
        f"<< {page} /Resources << /Font << /F1 5 0 R /F2 6 0 R >> >> >>".encode(),
        b"<< /Length %d >>\nstream\n%b\nendstream" % (len(content), content),
        f"<< {fonts} /Courier >>".encode(),
        f"<< {fonts} /Courier-Bold >>".encode(),
    ]
    data, places = b"%PDF-1.4\n", []
    for number, body in enumerate(objects, 1):
        places.append(len(data))
        data += b"%d 0 obj\n%b\nendobj\n" % (number, body)
    table = b"".join(b"%010d 00000 n \n" % place for place in places)
    head = b"xref\n0 %d\n0000000000 65535 f \n" % (len(objects) + 1)
    trailer = b"trailer\n<< /Size %d /Root 1 0 R >>\nstartxref\n%d\n%%%%EOF\n" % (len(objects) + 1, len(data))
    return data + head + table + trailer
