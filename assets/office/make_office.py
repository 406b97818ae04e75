"""Writes the office, `simple_office/model.sdf`, and the world with people in it, from the numbers below.

    python assets/office/make_office.py

A corridor along x with two offices and a meeting room to the north, an open office and a kitchen to the south. Lengths
m, angles degrees in this file and radians in what is written.
"""

from __future__ import annotations

import math
from collections.abc import Iterable, Iterator, Sequence
from dataclasses import dataclass, replace
from itertools import pairwise
from pathlib import Path

HERE = Path(__file__).resolve().parent
WORLD = HERE.parents[1] / "worlds" / "simple_office_with_people.sdf"

HALF_LENGTH, HALF_WIDTH, CORRIDOR = 6.5, 4.8, 1.2
WALL, HEIGHT, DOOR = 0.12, 2.4, 2.05

LOOKS = {
    "wall": (0.92, 0.91, 0.87), "accent": (0.42, 0.56, 0.60), "door": (0.55, 0.40, 0.27), "carpet": (0.47, 0.50, 0.54),
    "corridor": (0.72, 0.68, 0.60), "tiles": (0.80, 0.82, 0.82), "desk": (0.83, 0.72, 0.55),
    "metal": (0.62, 0.64, 0.66),
    "chair": (0.17, 0.19, 0.22), "screen": (0.06, 0.08, 0.12), "white": (0.95, 0.95, 0.94), "leaf": (0.22, 0.46, 0.23),
    "pot": (0.72, 0.42, 0.30), "sofa": (0.24, 0.40, 0.45), "counter": (0.30, 0.30, 0.32), "red": (0.66, 0.20, 0.18),
    "blue": (0.20, 0.32, 0.58), "yellow": (0.86, 0.68, 0.22), "paper": (0.97, 0.96, 0.92), "glass": (0.65, 0.80, 0.88),
}  # fmt: skip


@dataclass(frozen=True)
class Part:
    """A box (x, y, z), a cylinder (radius, length) or an ellipsoid (radii), its middle at `at`."""

    name: str
    size: tuple[float, ...]
    at: tuple[float, float, float]
    look: str
    kind: str = "box"
    felt: bool = True
    seen: bool = True
    yaw: float = 0.0


def piece(name: str, parts: Iterable[Part], x: float, y: float, degrees: float = 0.0) -> list[Part]:
    """Parts of a piece of furniture in the room; a piece stands on z = 0 and faces +x."""
    turn = math.radians(degrees)
    c, s = math.cos(turn), math.sin(turn)
    return [
        replace(
            p,
            name=f"{name}_{p.name}",
            at=(x + c * p.at[0] - s * p.at[1], y + s * p.at[0] + c * p.at[1], p.at[2]),
            yaw=p.yaw + turn,
        )
        for p in parts
    ]


# ------------------------------------------------------------------ the building


def wall(
    name: str, a: tuple[float, float], b: tuple[float, float], doors: Sequence[tuple[float, float]] = ()
) -> list[Part]:
    """A wall from a to b along x or y; doors as (from, to) along it, with a lintel above."""
    along_x = a[1] == b[1]
    start, end = (a[0], b[0]) if along_x else (a[1], b[1])
    fixed = a[1] if along_x else a[0]

    def part(label: str, low: float, high: float, bottom: float) -> Part:
        length, middle, tall = high - low, (low + high) / 2, HEIGHT - bottom
        size = (length, WALL, tall) if along_x else (WALL, length, tall)
        at = (middle, fixed, bottom + tall / 2) if along_x else (fixed, middle, bottom + tall / 2)
        return Part(label, size, at, "wall")

    found, place = [], start
    for i, (low, high) in enumerate(doors, 1):
        found += [part(f"{name}_{i}", place, low, 0.0), part(f"{name}_lintel_{i}", low, high, DOOR)]
        place = high
    return [*found, part(f"{name}_end", place, end, 0.0)]


def floor(name: str, x: tuple[float, float], y: tuple[float, float], look: str) -> Part:
    size = (x[1] - x[0], y[1] - y[0], 0.004)
    return Part(name, size, ((x[0] + x[1]) / 2, (y[0] + y[1]) / 2, -0.002), look, felt=False)


def building() -> list[Part]:
    length, width, hall = HALF_LENGTH, HALF_WIDTH, CORRIDOR
    found = [
        floor("floor_hall", (-length, length), (-hall, hall), "corridor"),
        floor("floor_north", (-length, length), (hall, width), "carpet"),
        floor("floor_open", (-length, 2.0), (-width, -hall), "carpet"),
        floor("floor_kitchen", (2.0, length), (-width, -hall), "tiles"),
        *wall("north", (-length, width), (length, width)),
        *wall("south", (-length, -width), (length, -width)),
        *wall("west", (-length, -width), (-length, width)),
        *wall("east", (length, -width), (length, width)),
        *wall("hall_north", (-length, hall), (length, hall), [(-3.2, -2.2), (0.6, 1.6), (3.6, 4.6)]),
        *wall("hall_south", (-length, -hall), (length, -hall), [(-4.2, -0.8), (3.2, 4.2)]),
        *wall("between_offices", (-1.2, hall), (-1.2, width)),
        *wall("meeting", (2.6, hall), (2.6, width)),
        *wall("kitchen", (2.0, -width), (2.0, -hall)),
    ]
    # a stripe along the corridor, windows, and a board with the way out: something for the eye
    for i, x in enumerate((-4.6, -1.9, 0.7, 4.4)):
        found.append(Part(f"window_{i}", (1.5, 0.02, 1.1), (x, width - WALL / 2 - 0.005, 1.5), "glass", felt=False))
        found.append(
            Part(f"window_south_{i}", (1.5, 0.02, 1.1), (x, -width + WALL / 2 + 0.005, 1.5), "glass", felt=False)
        )
    found.append(
        Part(
            "accent",
            (0.02, 2 * hall - WALL, HEIGHT),
            (length - WALL / 2 - 0.005, 0.0, HEIGHT / 2),
            "accent",
            felt=False,
        )
    )
    found.append(
        Part(
            "accent_west",
            (0.02, 2 * hall - WALL, HEIGHT),
            (-length + WALL / 2 + 0.005, 0.0, HEIGHT / 2),
            "accent",
            felt=False,
        )
    )
    return found


# ------------------------------------------------------------------ furniture, each facing +x


def desk() -> list[Part]:
    """Whoever sits at it is on its +x side."""
    return [
        Part("top", (0.75, 1.5, 0.03), (0.0, 0.0, 0.725), "desk"),
        Part("leg_left", (0.65, 0.04, 0.71), (0.0, 0.70, 0.355), "metal"),
        Part("leg_right", (0.65, 0.04, 0.71), (0.0, -0.70, 0.355), "metal"),
        Part("back", (0.02, 1.36, 0.40), (-0.30, 0.0, 0.50), "metal"),
        Part("foot", (0.18, 0.24, 0.02), (-0.20, 0.0, 0.75), "chair", felt=False),
        Part("pole", (0.03, 0.05, 0.20), (-0.22, 0.0, 0.85), "chair", felt=False),
        Part("screen", (0.03, 0.56, 0.33), (-0.20, 0.0, 1.06), "chair"),
        Part("picture", (0.004, 0.53, 0.30), (-0.184, 0.0, 1.065), "blue", felt=False),
        Part("keyboard", (0.14, 0.42, 0.02), (0.14, 0.0, 0.75), "screen", felt=False),
        Part("papers", (0.21, 0.30, 0.02), (0.10, 0.48, 0.75), "paper", felt=False),
    ]


def chair() -> list[Part]:
    return [
        Part("base", (0.27, 0.05), (0.0, 0.0, 0.06), "chair", "cylinder"),
        Part("pole", (0.03, 0.34), (0.0, 0.0, 0.25), "metal", "cylinder"),
        Part("seat", (0.46, 0.46, 0.07), (0.0, 0.0, 0.44), "chair"),
        Part("back", (0.06, 0.44, 0.48), (-0.23, 0.0, 0.78), "chair"),
    ]


def shelf(colours: Sequence[str] = ("red", "blue", "yellow", "white")) -> list[Part]:
    found = [Part("body", (0.36, 1.0, 1.8), (0.0, 0.0, 0.9), "desk")]
    for row in range(4):
        z = 0.26 + 0.43 * row
        found.append(Part(f"gap_{row}", (0.01, 0.92, 0.34), (0.178, 0.0, z), "counter", felt=False))
        for i in range(5):
            at = (0.186, -0.36 + 0.12 * i + 0.03 * (row % 2), z - 0.03)
            found.append(
                Part(f"folder_{row}_{i}", (0.012, 0.075, 0.27), at, colours[(row + i) % len(colours)], felt=False)
            )
    return found


def plant() -> list[Part]:
    leaves = [
        Part(
            f"leaf_{i}",
            (0.10, 0.05, 0.30),
            (0.13 * math.cos(a), 0.13 * math.sin(a), 0.75),
            "leaf",
            "ellipsoid",
            False,
            True,
            a,
        )
        for i, a in enumerate(2 * math.pi * k / 6 for k in range(6))
    ]
    return [
        Part("pot", (0.17, 0.36), (0.0, 0.0, 0.18), "pot", "cylinder"),
        Part("crown", (0.19, 0.19, 0.34), (0.0, 0.0, 0.72), "leaf", "ellipsoid"),
        *leaves,
    ]


def meeting_table() -> list[Part]:
    return [
        Part("top", (2.0, 1.0, 0.04), (0.0, 0.0, 0.73), "desk"),
        Part("leg_1", (0.10, 0.60, 0.71), (0.70, 0.0, 0.355), "metal"),
        Part("leg_2", (0.10, 0.60, 0.71), (-0.70, 0.0, 0.355), "metal"),
        Part("laptop", (0.30, 0.22, 0.02), (0.30, 0.10, 0.76), "metal", felt=False),
    ]


def board() -> list[Part]:
    return [
        Part("frame", (0.03, 1.84, 1.04), (0.0, 0.0, 1.45), "metal"),
        Part("face", (0.01, 1.78, 0.98), (0.018, 0.0, 1.45), "white", felt=False),
        Part("line_1", (0.004, 0.80, 0.02), (0.025, -0.30, 1.70), "blue", felt=False),
        Part("line_2", (0.004, 0.60, 0.02), (0.025, -0.40, 1.58), "red", felt=False),
    ]


def sofa() -> list[Part]:
    return [
        Part("seat", (0.70, 1.7, 0.42), (0.05, 0.0, 0.21), "sofa"),
        Part("back", (0.20, 1.7, 0.80), (-0.30, 0.0, 0.40), "sofa"),
        Part("arm_left", (0.75, 0.18, 0.58), (0.02, 0.85, 0.29), "sofa"),
        Part("arm_right", (0.75, 0.18, 0.58), (0.02, -0.85, 0.29), "sofa"),
    ]


def counter() -> list[Part]:
    return [
        Part("body", (0.58, 2.6, 0.86), (0.0, 0.0, 0.43), "white"),
        Part("top", (0.62, 2.6, 0.04), (0.0, 0.0, 0.88), "counter"),
        Part("sink", (0.36, 0.50, 0.01), (0.02, 0.60, 0.902), "metal", felt=False),
        Part("machine", (0.30, 0.28, 0.36), (-0.08, -0.55, 1.08), "chair"),
        Part("cupboards", (0.34, 2.6, 0.60), (-0.12, 0.0, 1.80), "white"),
    ]


def fridge() -> list[Part]:
    return [
        Part("body", (0.62, 0.62, 1.85), (0.0, 0.0, 0.925), "metal"),
        Part("handle", (0.03, 0.03, 0.60), (0.325, 0.24, 1.15), "chair", felt=False),
    ]


def round_table() -> list[Part]:
    return [
        Part("top", (0.40, 0.03), (0.0, 0.0, 1.045), "white", "cylinder"),
        Part("pole", (0.04, 1.02), (0.0, 0.0, 0.51), "metal", "cylinder"),
        Part("foot", (0.24, 0.02), (0.0, 0.0, 0.01), "metal", "cylinder"),
    ]


DESKS = {  # x, y and where whoever sits there looks (degrees)
    "a1": (-5.6, 3.9, 180.0), "a2": (-2.1, 3.9, 0.0), "b1": (1.6, 3.9, 0.0),
    "c1": (-5.6, -2.3, 180.0), "c2": (-5.6, -3.9, 180.0), "d1": (-1.8, -3.9, 0.0), "d2": (0.9, -3.9, 0.0),
}  # fmt: skip


def seat_of(key: str, away: float = 0.62) -> tuple[float, float, float]:
    """Where the one at a desk sits: x, y and where they look [degrees]."""
    x, y, looks = DESKS[key]
    return x - away * math.cos(math.radians(looks)), y - away * math.sin(math.radians(looks)), looks


def office() -> list[Part]:
    found = building()
    for key, (x, y, looks) in DESKS.items():
        found += piece(f"desk_{key}", desk(), x, y, looks + 180.0)
        sx, sy, _ = seat_of(key)
        found += piece(f"chair_{key}", chair(), sx, sy, looks)
    found += piece("shelf_a", shelf(), -4.0, 4.54, -90)
    found += piece("shelf_b", shelf(("white", "blue")), -0.92, 3.2, 0)
    found += piece("shelf_c", shelf(("yellow", "red", "white")), 1.74, -2.6, 180)
    found += piece("table", meeting_table(), 4.6, 3.1, 0)
    for i, (x, y, turn) in enumerate(((4.1, 3.86, -90), (5.1, 3.86, -90), (4.1, 2.34, 90), (5.1, 2.34, 90)), 1):
        found += piece(f"meeting_chair_{i}", chair(), x, y, turn)
    found += piece("board", board(), 6.41, 3.1, 180)
    found += piece("sofa", sofa(), -4.9, 1.72, 90)
    found += piece("counter", counter(), 4.6, -4.42, 90)
    found += piece("fridge", fridge(), 2.45, -4.4, 90)
    found += piece("bar", round_table(), 4.9, -2.6)
    for i, (x, y) in enumerate(((-6.1, -0.85), (6.1, 0.85), (-6.1, 1.6), (-0.85, 4.4), (-2.9, -4.4), (6.1, -1.6)), 1):
        found += piece(f"plant_{i}", plant(), x, y)
    return found


# ------------------------------------------------------------------ people


def rounded(corners: Sequence[tuple[float, float]], radius: float) -> list[tuple[float, float]]:
    """A closed way round the corners, each of them an arc, as a fine polygon."""
    found: list[tuple[float, float]] = []
    count = len(corners)
    for i in range(count):
        (ax, ay), (bx, by), (cx, cy) = corners[i - 1], corners[i], corners[(i + 1) % count]
        before, after = math.hypot(ax - bx, ay - by), math.hypot(cx - bx, cy - by)
        near = min(radius, 0.49 * before, 0.49 * after)
        p = (bx + (ax - bx) / before * near, by + (ay - by) / before * near)
        q = (bx + (cx - bx) / after * near, by + (cy - by) / after * near)
        for k in range(9):
            t = k / 8
            a, b, c = (1 - t) ** 2, 2 * t * (1 - t), t * t
            found.append((a * p[0] + b * bx + c * q[0], a * p[1] + b * by + c * q[1]))
    return found


def waypoints(corners: Sequence[tuple[float, float]], speed: float, radius: float = 0.8) -> list[tuple[float, ...]]:
    """Time, x, y and heading every 0.6 s along a closed way at an even pace."""
    line = rounded(corners, radius)
    line.append(line[0])
    along = [0.0]
    for (ax, ay), (bx, by) in pairwise(line):
        along.append(along[-1] + math.hypot(bx - ax, by - ay))
    count = max(4, round(along[-1] / speed / 0.6))
    step = along[-1] / count

    def at(way: float) -> tuple[float, float]:
        way %= along[-1]
        i = next(k for k in range(1, len(along)) if along[k] >= way)
        part = (way - along[i - 1]) / max(along[i] - along[i - 1], 1e-9)
        (ax, ay), (bx, by) = line[i - 1], line[i]
        return ax + part * (bx - ax), ay + part * (by - ay)

    found, heading = [], None
    for k in range(count + 1):
        (x, y), (fx, fy), (px, py) = at(k * step), at(k * step + 0.05), at(k * step - 0.05)
        new = math.atan2(fy - py, fx - px)
        if heading is not None:
            new = heading + math.remainder(new - heading, 2 * math.pi)
        heading = new
        found.append((round(k * step / speed, 2), x, y, new))
    return found


WALKERS = {
    "walking_woman": ([(-5.6, -0.8), (5.6, -0.8), (5.6, 0.8), (-5.6, 0.8)], 1.15, 0.0),
    "walking_man": ([(-4.6, -1.75), (1.2, -1.75), (1.2, -2.75), (-4.0, -2.75)], 0.95, 0.0),
    "visitor": (
        [(4.35, -0.35), (4.35, 1.62), (3.1, 1.62), (3.1, 4.42), (5.9, 4.42), (5.9, 1.75), (3.85, 1.75), (3.85, 0.3),
         (2.6, 0.3), (2.6, -0.35)],
        0.9, 4.0,
    ),
}  # fmt: skip
STANDING = {
    "colleague_1": (4.45, -2.25, -38.0), "colleague_2": (5.35, -2.95, 142.0), "waiting_man": (-0.6, 3.0, -90.0),
}  # fmt: skip
SITTING = {"programmer": "a1", "secretary": "b1", "student": "c2"}
PEOPLE = {
    "walking_woman": (1.68, (0.70, 0.24, 0.30), (0.15, 0.17, 0.22), (0.90, 0.74, 0.63), (0.36, 0.22, 0.13)),
    "walking_man": (1.80, (0.23, 0.38, 0.60), (0.30, 0.27, 0.23), (0.86, 0.69, 0.56), (0.15, 0.11, 0.09)),
    "visitor": (1.76, (0.90, 0.90, 0.92), (0.12, 0.13, 0.16), (0.58, 0.41, 0.30), (0.10, 0.08, 0.07)),
    "colleague_1": (1.72, (0.28, 0.50, 0.38), (0.20, 0.24, 0.34), (0.92, 0.78, 0.68), (0.64, 0.50, 0.28)),
    "colleague_2": (1.84, (0.78, 0.62, 0.26), (0.18, 0.18, 0.20), (0.78, 0.58, 0.45), (0.16, 0.12, 0.10)),
    "waiting_man": (1.78, (0.42, 0.34, 0.54), (0.24, 0.25, 0.28), (0.88, 0.72, 0.60), (0.48, 0.47, 0.47)),
    "programmer": (1.77, (0.16, 0.18, 0.21), (0.24, 0.30, 0.42), (0.91, 0.76, 0.65), (0.55, 0.35, 0.18)),
    "secretary": (1.66, (0.86, 0.70, 0.72), (0.22, 0.20, 0.24), (0.74, 0.54, 0.42), (0.12, 0.09, 0.08)),
    "student": (1.74, (0.85, 0.46, 0.20), (0.22, 0.28, 0.38), (0.93, 0.80, 0.70), (0.70, 0.56, 0.34)),
}


# ------------------------------------------------------------------ text


def number(value: float) -> str:
    text = f"{value:.4f}".rstrip("0").rstrip(".")
    return "0" if text in ("-0", "") else text


def numbers(values: Iterable[float]) -> str:
    return " ".join(number(v) for v in values)


def shape(part: Part) -> str:
    if part.kind == "box":
        return f"<box><size>{numbers(part.size)}</size></box>"
    if part.kind == "cylinder":
        return f"<cylinder><radius>{number(part.size[0])}</radius><length>{number(part.size[1])}</length></cylinder>"
    return f"<ellipsoid><radii>{numbers(part.size)}</radii></ellipsoid>"


def collision_line(part: Part) -> str:
    pose = f"<pose>{numbers((*part.at, 0, 0, part.yaw))}</pose>"
    return f'<collision name="{part.name}">{pose}<geometry>{shape(part)}</geometry></collision>'


def visual_line(look: str) -> str:
    red, green, blue = LOOKS[look]
    colour = numbers((red, green, blue, 1))
    shine = "0.4 0.4 0.4 1" if look in ("metal", "glass", "screen") else "0.05 0.05 0.05 1"
    material = f"<ambient>{colour}</ambient><diffuse>{colour}</diffuse><specular>{shine}</specular>"
    return (
        f'<visual name="{look}"><geometry><mesh><uri>meshes/{look}.obj</uri></mesh></geometry>'
        f"<material>{material}</material></visual>"
    )


# ------------------------------------------------------------------ one mesh for all that has one look

Vector = tuple[float, float, float]
Facet = list[tuple[Vector, Vector]]  # corners with their normals, anticlockwise from outside


def box_facets(size: Sequence[float]) -> Iterator[Facet]:
    half = [v / 2 for v in size]
    for axis in range(3):
        u, v = (axis + 1) % 3, (axis + 2) % 3
        for sign in (1.0, -1.0):
            facet = []
            for a, b in ((-1, -1), (1, -1), (1, 1), (-1, 1))[:: int(sign)]:
                corner, normal = [0.0, 0.0, 0.0], [0.0, 0.0, 0.0]
                corner[axis], corner[u], corner[v] = sign * half[axis], a * half[u], b * half[v]
                normal[axis] = sign
                facet.append((tuple(corner), tuple(normal)))
            yield facet  # type: ignore[misc]


def cylinder_facets(radius: float, length: float, sides: int = 20) -> Iterator[Facet]:
    ring = [(math.cos(2 * math.pi * k / sides), math.sin(2 * math.pi * k / sides)) for k in range(sides)]
    top, low = length / 2, -length / 2
    for (c, s), (d, t) in zip(ring, ring[1:] + ring[:1], strict=True):
        a, b = (radius * c, radius * s), (radius * d, radius * t)
        n, m = (c, s, 0.0), (d, t, 0.0)
        yield [((*a, low), n), ((*b, low), m), ((*b, top), m), ((*a, top), n)]
    yield [((radius * c, radius * s, top), (0.0, 0.0, 1.0)) for c, s in ring]
    yield [((radius * c, radius * s, low), (0.0, 0.0, -1.0)) for c, s in reversed(ring)]


def ellipsoid_facets(radii: Sequence[float], around: int = 12, up: int = 7) -> Iterator[Facet]:
    def at(i: int, j: int) -> tuple[Vector, Vector]:
        turn, rise = 2 * math.pi * i / around, math.pi * (j / up - 0.5)
        way = (math.cos(rise) * math.cos(turn), math.cos(rise) * math.sin(turn), math.sin(rise))
        normal = [w / r for w, r in zip(way, radii, strict=True)]
        size = math.sqrt(sum(v * v for v in normal))
        place = tuple(w * r for w, r in zip(way, radii, strict=True))
        return place, tuple(v / size for v in normal)  # type: ignore[return-value]

    for i in range(around):
        for j in range(up):
            corners = [at(i, j), at(i + 1, j), at(i + 1, j + 1), at(i, j + 1)]
            yield corners[1:] if j == 0 else (corners[:3] if j == up - 1 else corners)


def facets(part: Part) -> Iterator[Facet]:
    makers = {"box": box_facets, "cylinder": lambda size: cylinder_facets(*size), "ellipsoid": ellipsoid_facets}
    c, s = math.cos(part.yaw), math.sin(part.yaw)

    def turned(p: Vector) -> Vector:
        return c * p[0] - s * p[1], s * p[0] + c * p[1], p[2]

    for facet in makers[part.kind](part.size):
        yield [(tuple(a + b for a, b in zip(turned(p), part.at, strict=True)), turned(n)) for p, n in facet]  # type: ignore[misc]


def mesh_text(look: str, parts: Sequence[Part]) -> str:
    points: dict[str, int] = {}
    normals: dict[str, int] = {}
    faces = []
    for part in parts:
        for facet in facets(part):
            corners = []
            for p, n in facet:
                here = points.setdefault("v " + numbers(p), len(points) + 1)
                corners.append(f"{here}//{normals.setdefault('vn ' + numbers(n), len(normals) + 1)}")
            faces += [f"f {corners[0]} {corners[i]} {corners[i + 1]}" for i in range(1, len(corners) - 1)]
    head = ["# written by make_office.py", f"o {look}"]
    return "\n".join([*head, *points, *normals, *faces, ""])


def looks_of(parts: Iterable[Part]) -> dict[str, list[Part]]:
    found: dict[str, list[Part]] = {}
    for part in parts:
        if part.seen:
            found.setdefault(part.look, []).append(part)
    return found


def model_text() -> str:
    parts = office()
    felt = [collision_line(part) for part in parts if part.felt]
    lines = "\n".join(f"      {line}" for line in (*felt, *map(visual_line, looks_of(parts))))
    return (
        '<?xml version="1.0"?>\n'
        "<!-- An office of 13 x 9.6 m without a ceiling. Written by make_office.py beside this folder. Lengths m. -->\n"
        '<sdf version="1.12">\n  <model name="simple_office">\n    <static>true</static>\n    <link name="link">\n'
        f"{lines}\n    </link>\n  </model>\n</sdf>\n"
    )


CONFIG = """<?xml version="1.0"?>
<model>
  <name>Simple office</name>
  <version>1.0</version>
  <sdf version="1.12">model.sdf</sdf>
  <author><name>simkit</name></author>
  <description>Two offices, a meeting room, an open office and a kitchen along a corridor.</description>
</model>
"""

HEAD = """<?xml version="1.0"?>
<!--
  An office with people who stand, sit and walk. Written by assets/office/make_office.py. Lengths m, angles rad.

  The corridor is free along y = 0: a robot goes to the origin (option spawn, tiago:0,0,0). The people are actors:
  cameras and lidars see them, nothing pushes them and they push nothing.
-->
<sdf version="1.12" xmlns:simkit="https://simkit">
  <world name="simple_office_with_people">

    <physics name="step_1ms" type="ignored">
      <max_step_size>0.002</max_step_size>
      <real_time_factor>1</real_time_factor>
    </physics>

    <scene>
      <ambient>0.62 0.62 0.62 1</ambient>
      <background>0.80 0.87 0.94 1</background>
      <shadows>true</shadows>
      <grid>false</grid>
    </scene>

    <light name="sun" type="directional">
      <pose>-30 -40 70 0 0 0</pose>
      <direction>0.32 0.44 -0.84</direction>
      <diffuse>0.5 0.5 0.48 1</diffuse>
      <specular>0.1 0.1 0.1 1</specular>
      <cast_shadows>true</cast_shadows>
    </light>

    <model name="ground_plane">
      <static>true</static>
      <link name="link">
        <collision name="collision">
          <geometry><plane><normal>0 0 1</normal><size>100 100</size></plane></geometry>
        </collision>
        <visual name="visual">
          <pose>0 0 -0.006 0 0 0</pose>
          <geometry><plane><normal>0 0 1</normal><size>100 100</size></plane></geometry>
          <material><ambient>0.55 0.62 0.50 1</ambient><diffuse>0.55 0.62 0.50 1</diffuse></material>
        </visual>
      </link>
    </model>

    <include>
      <uri>model://simple_office</uri>
      <name>office</name>
    </include>
"""


def person_lines(name: str) -> list[str]:
    height, *colours = PEOPLE[name]
    inner = f"<height>{number(height)}</height>"
    for label, colour in zip(("shirt", "trousers", "skin", "hair"), colours, strict=True):
        inner += f"<{label}>{numbers(colour)}</{label}>"  # type: ignore[arg-type]
    return [f"      <simkit:person>{inner}</simkit:person>"]


def actor_lines(name: str) -> Iterator[str]:
    yield f'    <actor name="{name}">'
    if name in WALKERS:
        corners, speed, delay = WALKERS[name]
        yield from person_lines(name)
        yield "      <script>"
        yield f"        <loop>true</loop><delay_start>{number(delay)}</delay_start><auto_start>true</auto_start>"
        yield '        <trajectory id="0" type="walking">'
        for time, x, y, yaw in waypoints(corners, speed):
            pose = numbers((x, y, 0, 0, 0, yaw))
            yield f"          <waypoint><time>{number(time)}</time><pose>{pose}</pose></waypoint>"
        yield "        </trajectory>"
        yield "      </script>"
    else:
        x, y, degrees = STANDING[name] if name in STANDING else seat_of(SITTING[name], 0.60)
        yield f"      <pose>{numbers((x, y, 0, 0, 0, math.radians(degrees)))}</pose>"
        yield from person_lines(name)
        kind = "standing" if name in STANDING else "sitting"
        yield f'      <script><trajectory id="0" type="{kind}"/></script>'
    yield "    </actor>"


def world_text() -> str:
    lines = [HEAD]
    for name in (*WALKERS, *STANDING, *SITTING):
        lines += [*actor_lines(name), ""]
    return "\n".join([*lines, "  </world>", "</sdf>", ""])


if __name__ == "__main__":
    (HERE / "simple_office" / "model.sdf").write_text(model_text(), encoding="utf-8")
    for look, alike in looks_of(office()).items():
        (HERE / "simple_office" / "meshes" / f"{look}.obj").write_text(mesh_text(look, alike), encoding="utf-8")
    (HERE / "simple_office" / "model.config").write_text(CONFIG, encoding="utf-8")
    WORLD.write_text(world_text(), encoding="utf-8")
