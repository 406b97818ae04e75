"""The furniture of the house: each piece a function that gives its parts, in its own frame.

A piece stands on z = 0 with its back towards -y (what has one), so that it faces +y; `at` puts it into the house.
Lengths m. A part collides unless it says otherwise; what is only for the eye does not.
"""

from __future__ import annotations

import math
from collections.abc import Iterable
from dataclasses import dataclass, replace

from robots import ZERO, Shape, Vector

MESHES = "turtlebot3_house/meshes"


@dataclass(frozen=True, slots=True)
class Part:
    """A shape of one look, its middle at `xyz`.

    Attributes:
        look: a key of `LOOKS`.
        seen: whether it is drawn.
        felt: whether it is touched, and seen by a lidar.
    """

    name: str
    shape: Shape
    xyz: Vector
    look: str
    rpy: Vector = ZERO
    seen: bool = True
    felt: bool = True


@dataclass(frozen=True, slots=True)
class Piece:
    """A named group of parts, standing at (x, y) and turned by `yaw`."""

    name: str
    parts: tuple[Part, ...]
    x: float = 0.0
    y: float = 0.0
    yaw: float = 0.0

    def at(self, name: str, x: float, y: float, degrees: float = 0.0) -> Piece:
        return replace(self, name=name, x=x, y=y, yaw=math.radians(degrees))


LOOKS: dict[str, tuple[float, float, float, float, float]] = {  # red, green, blue, opacity, shine
    "plaster": (0.93, 0.91, 0.86, 1, 0.0),
    "facade": (0.90, 0.89, 0.84, 1, 0.0),
    "glass": (0.62, 0.80, 0.90, 0.35, 0.8),
    "oak_floor": (0.74, 0.58, 0.40, 1, 0.1),
    "oak_joint": (0.66, 0.50, 0.33, 1, 0.1),
    "tiles": (0.80, 0.82, 0.82, 1, 0.3),
    "tile_joint": (0.64, 0.67, 0.68, 1, 0.1),
    "bath_tiles": (0.60, 0.75, 0.79, 1, 0.3),
    "carpet": (0.72, 0.69, 0.76, 1, 0.0),
    "door": (0.48, 0.30, 0.19, 1, 0.2),
    "oak": (0.69, 0.50, 0.31, 1, 0.2),
    "walnut": (0.38, 0.25, 0.17, 1, 0.2),
    "white": (0.95, 0.95, 0.94, 1, 0.3),
    "worktop": (0.28, 0.28, 0.30, 1, 0.4),
    "steel": (0.72, 0.74, 0.76, 1, 0.7),
    "black": (0.08, 0.08, 0.09, 1, 0.5),
    "sofa": (0.20, 0.40, 0.46, 1, 0.0),
    "sofa_light": (0.27, 0.49, 0.55, 1, 0.0),
    "mustard": (0.88, 0.66, 0.20, 1, 0.0),
    "terracotta": (0.76, 0.38, 0.26, 1, 0.1),
    "rug": (0.80, 0.45, 0.34, 1, 0.0),
    "rug_border": (0.93, 0.86, 0.74, 1, 0.0),
    "sage": (0.58, 0.66, 0.55, 1, 0.1),
    "linen": (0.94, 0.94, 0.96, 1, 0.0),
    "blanket": (0.33, 0.42, 0.62, 1, 0.0),
    "leaf": (0.22, 0.47, 0.22, 1, 0.1),
    "soil": (0.23, 0.16, 0.11, 1, 0.0),
    "ceramic": (0.97, 0.98, 0.99, 1, 0.7),
    "water": (0.55, 0.78, 0.86, 1, 0.8),
    "lamp": (1.00, 0.95, 0.78, 1, 0.0),
    "screen": (0.05, 0.09, 0.15, 1, 0.9),
    "book_red": (0.66, 0.18, 0.18, 1, 0.0),
    "book_blue": (0.18, 0.30, 0.55, 1, 0.0),
    "book_green": (0.22, 0.44, 0.33, 1, 0.0),
}


def box(name: str, size: Vector, xyz: Vector, look: str, *, seen: bool = True, felt: bool = True) -> Part:
    return Part(name, Shape("box", size), xyz, look, seen=seen, felt=felt)


def tube(name: str, radius: float, length: float, xyz: Vector, look: str, *, felt: bool = True) -> Part:
    return Part(name, Shape("cylinder", (radius, length)), xyz, look, felt=felt)


def mesh(name: str, file: str, xyz: Vector, look: str) -> Part:
    """A drawn part, for the eye only; what is touched is a simpler part with `seen=False`."""
    return Part(name, Shape("mesh", mesh=f"{MESHES}/{file}.obj"), xyz, look, felt=False)


def piece(*parts: Part | Iterable[Part]) -> Piece:
    flat: list[Part] = []
    for part in parts:
        flat += [part] if isinstance(part, Part) else part
    return Piece("", tuple(flat))


def legs(x: float, y: float, height: float, look: str, thick: float = 0.05) -> list[Part]:
    """Four square legs at (+-x, +-y)."""
    places = ((1, 1), (1, -1), (-1, 1), (-1, -1))
    size = (thick, thick, height)
    return [box(f"leg_{i}", size, (sx * x, sy * y, height / 2), look) for i, (sx, sy) in enumerate(places, 1)]


# ------------------------------------------------------------------ living


def sofa(seats: int = 3) -> Piece:
    """Wide enough for `seats`; faces +y."""
    width = seats * 0.66
    whole = width + 0.36
    cushions = [
        mesh(f"seat_{i}", "seat", ((i - (seats - 1) / 2) * 0.66, 0.06, 0.40), "sofa_light") for i in range(seats)
    ]
    backs = [mesh(f"back_{i}", "back", ((i - (seats - 1) / 2) * 0.66, -0.24, 0.62), "sofa_light") for i in range(seats)]
    return piece(
        box("base", (whole, 0.86, 0.24), (0, 0, 0.20), "sofa"),
        box("rest", (whole, 0.18, 0.70), (0, -0.38, 0.43), "sofa"),
        [box(f"arm_{i}", (0.18, 0.86, 0.50), (s * (width / 2 + 0.09), 0, 0.33), "sofa") for i, s in ((1, 1), (2, -1))],
        [
            box(f"foot_{i}", (0.06, 0.06, 0.08), (sx * whole * 0.45, sy * 0.36, 0.04), "walnut")
            for i, (sx, sy) in enumerate(((1, 1), (1, -1), (-1, 1), (-1, -1)), 1)
        ],
        cushions,
        backs,
        mesh("pillow", "pillow", ((width / 2 - 0.20) if seats > 1 else 0.0, -0.08, 0.64), "mustard"),
    )


def coffee_table() -> Piece:
    return piece(
        box("top", (1.0, 0.55, 0.04), (0, 0, 0.40), "oak"),
        box("shelf", (0.9, 0.45, 0.02), (0, 0, 0.18), "oak"),
        legs(0.46, 0.24, 0.38, "walnut"),
        box("book", (0.24, 0.17, 0.03), (-0.2, 0.05, 0.435), "book_blue", felt=False),
        tube("bowl", 0.09, 0.05, (0.25, 0, 0.445), "terracotta", felt=False),
    )


def rug(width: float, depth: float) -> Piece:
    return piece(
        box("border", (width, depth, 0.008), (0, 0, 0.004), "rug_border", felt=False),
        box("middle", (width - 0.24, depth - 0.24, 0.012), (0, 0, 0.006), "rug", felt=False),
    )


def tv_bench() -> Piece:
    return piece(
        box("body", (1.6, 0.40, 0.40), (0, 0, 0.28), "white"),
        legs(0.72, 0.15, 0.08, "walnut"),
        box("door_1", (0.76, 0.01, 0.34), (-0.39, 0.202, 0.28), "oak", felt=False),
        box("door_2", (0.76, 0.01, 0.34), (0.39, 0.202, 0.28), "oak", felt=False),
        box("foot", (0.40, 0.22, 0.02), (0, 0, 0.49), "black", felt=False),
        box("tv", (1.20, 0.05, 0.70), (0, 0, 0.86), "black"),
        box("screen", (1.14, 0.01, 0.64), (0, 0.026, 0.86), "screen", felt=False),
    )


def bookshelf(width: float = 1.0, height: float = 1.8) -> Piece:
    boards = [
        box(f"board_{i}", (width - 0.06, 0.28, 0.03), (0, 0, 0.06 + i * (height - 0.09) / 4), "oak") for i in range(5)
    ]
    books = []
    for row in range(4):
        low = 0.075 + row * (height - 0.09) / 4
        for k, look in enumerate(("book_red", "book_blue", "book_green", "linen", "mustard")):
            high = 0.20 + 0.04 * ((row * 3 + k * 2) % 4)
            wide = width * (0.09 + 0.03 * ((row + k) % 3))
            x = -width * 0.40 + width * 0.175 * k + wide / 2
            books.append(box(f"book_{row}_{k}", (wide, 0.18, high), (x, -0.02, low + high / 2), look, felt=False))
    return piece(
        [
            box(f"side_{i}", (0.03, 0.30, height), (s * (width / 2 - 0.015), 0, height / 2), "oak")
            for i, s in ((1, 1), (2, -1))
        ],
        box("rear", (width, 0.02, height), (0, -0.15, height / 2), "walnut"),
        boards,
        books,
    )


def floor_lamp() -> Piece:
    return piece(
        tube("foot", 0.15, 0.03, (0, 0, 0.015), "black"),
        tube("pole", 0.015, 1.45, (0, 0, 0.75), "black"),
        mesh("shade", "shade", (0, 0, 1.45), "lamp"),
    )


def plant(height: float = 1.0) -> Piece:
    return piece(
        mesh("pot", "pot", (0, 0, 0), "terracotta"),
        box("felt_pot", (0.26, 0.26, 0.34), (0, 0, 0.17), "terracotta", seen=False),
        tube("soil", 0.135, 0.01, (0, 0, 0.325), "soil", felt=False),
        mesh("leaves", "leaves" if height > 0.7 else "grass", (0, 0, 0.32), "leaf"),
    )


# ------------------------------------------------------------------ kitchen


def dining_table() -> Piece:
    return piece(
        box("top", (1.5, 0.85, 0.04), (0, 0, 0.74), "oak"),
        legs(0.68, 0.36, 0.72, "oak", 0.07),
        tube("plate_1", 0.12, 0.012, (-0.4, 0.2, 0.766), "ceramic", felt=False),
        tube("plate_2", 0.12, 0.012, (0.4, -0.2, 0.766), "ceramic", felt=False),
        mesh("fruit_bowl", "bowl", (0, 0, 0.76), "sage"),
    )


def chair() -> Piece:
    back = [box(f"slat_{i}", (0.40, 0.02, 0.07), (0, -0.19, 0.60 + 0.13 * i), "walnut") for i in range(3)]
    posts = [box(f"post_{i}", (0.04, 0.04, 0.90), (s * 0.19, -0.19, 0.45), "walnut") for i, s in ((1, 1), (2, -1))]
    front = [box(f"leg_{i}", (0.04, 0.04, 0.44), (s * 0.19, 0.19, 0.22), "walnut") for i, s in ((1, 1), (2, -1))]
    return piece(box("seat", (0.43, 0.43, 0.04), (0, 0, 0.45), "sage"), back, posts, front)


def counter(width: float, *, sink: float | None = None, hob: float | None = None) -> Piece:
    """A row of kitchen cupboards with a worktop; `sink` and `hob` are where these lie along x."""
    count = max(1, round(width / 0.6))
    step = width / count
    parts = [
        box("body", (width, 0.56, 0.76), (0, -0.02, 0.48), "white"),
        box("plinth", (width, 0.50, 0.10), (0, -0.05, 0.05), "worktop"),
        box("top", (width, 0.62, 0.04), (0, 0.01, 0.88), "worktop"),
    ]
    for i in range(count):
        x = (i - (count - 1) / 2) * step
        parts.append(box(f"front_{i}", (step - 0.02, 0.02, 0.72), (x, 0.27, 0.48), "sage", felt=False))
        parts.append(box(f"handle_{i}", (0.16, 0.02, 0.02), (x, 0.29, 0.78), "steel", felt=False))
    if sink is not None:
        parts.append(box("sink", (0.50, 0.40, 0.012), (sink, 0.03, 0.900), "steel", felt=False))
        parts.append(box("basin", (0.42, 0.32, 0.014), (sink, 0.03, 0.901), "tile_joint", felt=False))
        parts.append(tube("tap", 0.015, 0.26, (sink, -0.20, 1.03), "steel", felt=False))
        parts.append(box("spout", (0.02, 0.16, 0.02), (sink, -0.13, 1.15), "steel", felt=False))
    if hob is not None:
        parts.append(box("hob", (0.58, 0.50, 0.008), (hob, 0.01, 0.904), "black", felt=False))
        rings = ((-0.14, 0.12), (0.14, 0.12), (-0.14, -0.12), (0.14, -0.12))
        parts += [
            tube(f"ring_{i}", 0.08, 0.010, (hob + x, y, 0.905), "steel", felt=False) for i, (x, y) in enumerate(rings)
        ]
    return piece(parts)


def fridge() -> Piece:
    return piece(
        box("body", (0.62, 0.62, 1.75), (0, 0, 0.895), "steel"),
        box("base", (0.58, 0.58, 0.02), (0, 0, 0.01), "black"),
        box("joint", (0.60, 0.01, 0.015), (0, 0.31, 1.15), "black", felt=False),
        box("handle_1", (0.03, 0.03, 0.40), (-0.25, 0.33, 1.40), "white", felt=False),
        box("handle_2", (0.03, 0.03, 0.40), (-0.25, 0.33, 0.90), "white", felt=False),
    )
