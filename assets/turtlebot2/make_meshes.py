"""Draws the TurtleBot 2's visual meshes, one OBJ file for each material of a part.

    python assets/turtlebot2/make_meshes.py

All shapes are our own, drawn after the published outer dimensions: the base 351.5 mm across and 124.8 mm high, wheels
of 70.4 mm, plates 6 mm thick, the Kinect 278 x 73 x 73 mm. Coordinates are metres in the frame of the link that has
the part: x forward, y left, z up. Needs trimesh, shapely and mapbox_earcut (the extra `test` has them). The output is
the same on every machine: vertices are rounded to a hundredth of a millimetre.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Iterable
from pathlib import Path

import numpy as np
import shapely
import trimesh
from robot import PLATE_THICKNESS, POLES, WHEEL_RADIUS, WHEEL_WIDTH
from shapely.geometry import Polygon
from trimesh.creation import box, cylinder, extrude_polygon
from trimesh.transformations import rotation_matrix
from write_obj import obj_text

FOLDER = Path(__file__).parent
Parts = list[trimesh.Trimesh]
TOP = 0.1142  # of the base, above base_link
PITCH = 0.0254  # between the holes of a plate
BOTTOM_PLATE = ((0.1335, 0.083), (0.0, 0.1725), (-0.0787, 0.1725), (-0.1335, 0.105))
TOP_PLATE = ((0.1436, 0.092), (0.0520, 0.1700), (-0.0250, 0.1700), (-0.1436, 0.086))
"""Left half of a plate's outline, from the front to the back, around the middle of the outline."""


def moved(mesh: trimesh.Trimesh, x: float = 0.0, y: float = 0.0, z: float = 0.0) -> trimesh.Trimesh:
    """The same mesh, shifted [m]."""
    mesh.apply_translation((x, y, z))
    return mesh


def turned(mesh: trimesh.Trimesh, angle: float, axis: tuple[float, float, float]) -> trimesh.Trimesh:
    """The same mesh, turned about an axis through the origin [rad]."""
    mesh.apply_transform(rotation_matrix(angle, axis))
    return mesh


def block(size: tuple[float, float, float], centre: tuple[float, float, float]) -> trimesh.Trimesh:
    """A box of full edge lengths `size` around `centre` [m]."""
    return moved(box(extents=size), *centre)


def slab(outline: Polygon, bottom: float, height: float) -> trimesh.Trimesh:
    """`outline` in the x-y plane, from z = `bottom` up by `height` [m]."""
    return moved(extrude_polygon(outline, height), z=bottom)


def lathe(profile: Iterable[tuple[float, float]], sections: int) -> trimesh.Trimesh:
    """A closed solid of revolution about z from (radius, z) pairs."""
    return trimesh.creation.revolve(np.array(list(profile)), sections=sections)


def sector(inner: float, outer: float, low: float, high: float, middle: float = 0.0, steps: int = 40) -> Polygon:
    """The part of a ring between two angles around `middle` [rad]."""
    angles = np.linspace(middle + low, middle + high, steps)
    outside = [(outer * math.cos(a), outer * math.sin(a)) for a in angles]
    inside = [(inner * math.cos(a), inner * math.sin(a)) for a in reversed(angles)]
    return Polygon([*outside, *inside])


# ------------------------------------------------------------------ the base


def shell() -> Parts:
    """The body without its bumper: straight sides, a bevelled shoulder and a rim around the deck."""
    side = [(0.0, 0.006), (0.152, 0.006), (0.166, 0.012), (0.1705, 0.022), (0.1705, 0.088), (0.1665, 0.101)]
    rim = [(0.1590, 0.1105), (0.1500, TOP), (0.1440, TOP), (0.1420, 0.1100), (0.0, 0.1100), (0.0, 0.006)]
    return [lathe([*side, *rim], sections=72)]


def bumper() -> Parts:
    """The band around the front half, in three steps, with a lip at its upper edge."""
    reach = math.radians(98)
    bands = ((0.010, 0.014, 0.1735), (0.014, 0.064, 0.1757), (0.064, 0.068, 0.1735), (0.068, 0.074, 0.1752))
    return [slab(sector(0.168, outer, -reach, reach), low, high - low) for low, high, outer in bands]


def deck() -> Parts:
    """The plate on top, with the recess that the docking plate of a robot on top fits in."""
    return [
        lathe([(0.0, 0.109), (0.139, 0.109), (0.139, 0.1122), (0.0, 0.1122), (0.0, 0.109)], sections=60),
        lathe([(0.052, 0.112), (0.056, 0.112), (0.056, 0.1134), (0.052, 0.1134), (0.052, 0.112)], sections=40),
    ]


def window() -> Parts:
    """The three infrared receivers in the shoulder, and the strip of connectors at the back."""
    reach = math.radians(7)
    receivers = [
        slab(sector(0.164, 0.1716, -reach, reach, math.radians(at), steps=6), 0.078, 0.010) for at in (0, 60, -60)
    ]
    return [*receivers, slab(sector(0.166, 0.1716, -0.32, 0.32, math.pi, steps=14), 0.044, 0.028)]


def buttons() -> Parts:
    """Three buttons on the rim, and the ring of the power switch at the back."""
    row = [slab(shapely.Point(0, 0).buffer(0.0058, quad_segs=4), 0.0, 0.0022) for _ in range(3)]
    places = [(0.1470 * math.cos(math.radians(a)), 0.1470 * math.sin(math.radians(a))) for a in (204, 211, 218)]
    knobs = [moved(knob, x, y, TOP - 0.0012) for knob, (x, y) in zip(row, places, strict=True)]
    switch = turned(cylinder(0.009, 0.006, sections=18), math.pi / 2, (0, 1, 0))
    return [*knobs, moved(switch, -0.1705, -0.040, 0.030)]


def lamps() -> Parts:
    """The status light and the two lamps beside the buttons."""
    places = [(0.1470 * math.cos(math.radians(a)), 0.1470 * math.sin(math.radians(a))) for a in (180, 187, 194)]
    return [
        moved(slab(shapely.Point(0, 0).buffer(0.0032, quad_segs=3), 0, 0.002), x, y, TOP - 0.001) for x, y in places
    ]


def tyre() -> Parts:
    """A rubber ring; its tread lies on the rolling radius."""
    half = WHEEL_WIDTH / 2
    ring = [(0.026, -half), (WHEEL_RADIUS - 0.0015, -half), (WHEEL_RADIUS, -half + 0.002), (WHEEL_RADIUS, half - 0.002)]
    return [turned(lathe([*ring, (WHEEL_RADIUS - 0.0015, half), (0.026, half), ring[0]], 40), -math.pi / 2, (1, 0, 0))]


def hub() -> Parts:
    """A disc with a raised middle, the same on both faces."""
    half = WHEEL_WIDTH / 2
    profile = [(0.0, -half), (0.010, -half), (0.012, -half + 0.004), (0.0262, -half + 0.004)]
    mirrored = [(r, -z) for r, z in reversed(profile)]
    return [turned(lathe([*profile, *mirrored, profile[0]], 30), -math.pi / 2, (1, 0, 0))]


# ------------------------------------------------------------------ the stack


def outline(half: tuple[tuple[float, float], ...]) -> Polygon:
    """A plate's outline with rounded corners, from its left half."""
    corners = [*half, *((x, -y) for x, y in reversed(half))]
    bend = 0.014
    return Polygon(corners).buffer(-bend).buffer(bend, quad_segs=4)


def plate(half: tuple[tuple[float, float], ...], origin: float, names: tuple[str, ...], slot: Polygon) -> Parts:
    """A plate with a grid of holes, a cable slot, and no holes where a pole is screwed on.

    Args:
        half: Left half of the outline.
        origin: x of the plate's link in base_link.
        names: Poles that hold this plate.
        slot: Cable slot.
    """
    edge = outline(half)
    inside = edge.buffer(-0.008)
    seats = [shapely.Point(x - origin, y).buffer(0.0105) for name in names for x, y in POLES[name][3]]
    blocked = shapely.union_all([*seats, slot.buffer(0.006)])
    grid = [
        shapely.Point((i + 0.5) * PITCH, j * PITCH).buffer(0.0026, quad_segs=2)
        for i in range(-7, 7)
        for j in range(-7, 8)
    ]
    holes = [hole for hole in grid if inside.contains(hole) and not blocked.intersects(hole)]
    cut = edge.difference(shapely.union_all([*holes, slot]))
    return [slab(cut, -PLATE_THICKNESS / 2, PLATE_THICKNESS)]


def rounded(width: float, depth: float, radius: float, segments: int = 4) -> Polygon:
    """A rectangle around the origin with rounded corners."""
    inner = shapely.box(-width / 2 + radius, -depth / 2 + radius, width / 2 - radius, depth / 2 - radius)
    return inner.buffer(radius, quad_segs=segments)


def plate_bottom() -> Parts:
    """The lowest plate, with a large opening over the deck."""
    return plate(
        BOTTOM_PLATE, 0.02364, ("bottom", "middle"), shapely.affinity.translate(rounded(0.05, 0.11, 0.012), -0.08)
    )


def plate_top() -> Parts:
    """The two upper plates."""
    slot = shapely.affinity.translate(rounded(0.022, 0.100, 0.010), -0.040)
    return plate(TOP_PLATE, -0.01364, ("middle", "top", "kinect"), slot)


# ------------------------------------------------------------------ the Kinect, about the middle of its case


def kinect_case() -> Parts:
    """The bar with its bevelled front, the neck and the foot."""
    profile = Polygon(
        [
            (0.0363, 0.001),
            (0.0363, 0.030),
            (0.030, 0.0365),
            (-0.027, 0.0365),
            (-0.0363, 0.026),
            (-0.030, -0.0015),
            (0.030, -0.0015),
        ]
    )
    bar = extrude_polygon(profile.buffer(-0.003).buffer(0.003, quad_segs=3), 0.27794)
    # the profile's plane is x-z, and the bar lies along y
    turned(bar, math.pi / 2, (1, 0, 0))
    moved(bar, y=0.27794 / 2)
    neck = moved(cylinder(0.012, 0.020, sections=20), -0.004, 0, -0.010)
    foot = slab(shapely.affinity.translate(rounded(0.066, 0.076, 0.012), -0.002, 0), -0.0365, 0.016)
    return [bar, neck, foot]


def kinect_lenses() -> Parts:
    """Infrared projector, colour lens and infrared lens in the front, with the strip behind them."""
    lenses = []
    for y, z, radius in ((0.0635, 0.016, 0.0090), (-0.0125, 0.016, 0.0075), (0.0125, 0.016, 0.0075)):
        lens = turned(cylinder(radius, 0.004, sections=20), math.pi / 2, (0, 1, 0))
        lenses.append(moved(lens, 0.0362, y, z))
    return lenses


PARTS: dict[str, Callable[[], Parts]] = {
    draw.__name__: draw
    for draw in (
        shell, bumper, deck, window, buttons, lamps, tyre, hub, plate_bottom, plate_top, kinect_case, kinect_lenses,
    )
}  # fmt: skip
"""What is drawn: the name of the file, and the function that draws it."""


def main() -> None:
    meshes = FOLDER / "meshes"
    meshes.mkdir(exist_ok=True)
    for name, draw in PARTS.items():
        text = obj_text(name, draw())
        (meshes / f"{name}.obj").write_text(text, encoding="utf-8")
        print(f"{name:16s} {text.count(chr(10) + 'f '):6d} triangles")


if __name__ == "__main__":
    main()
