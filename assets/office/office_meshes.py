"""One mesh for everything in the office that has one look, as OBJ text. Lengths m."""

from __future__ import annotations

import math
from collections.abc import Iterator, Sequence

from office_parts import Part, numbers

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
