"""Draws the visual meshes of the TurtleBot3 robots and of their house and writes them as OBJ files.

    python assets/turtlebot3/make_meshes.py

They go into the `meshes/` folders; what more than one robot has is in `turtlebot3_common/meshes/`. The shapes are our
own, drawn after the published outer dimensions (burger 138 x 178 x 192 mm, waffle and waffle_pi 281 x 306 x 141 mm,
wheels of 66 mm). Each file is one material. Coordinates are metres in the frame of the link that carries the part:
x forward, y left, z up; the body parts use `base_link`, whose origin lies 10 mm above the ground between the wheels.
Needs trimesh, shapely and mapbox_earcut (the extra `test` has them). The output is the same on every machine: vertices
are rounded to a hundredth of a millimetre.
"""

from __future__ import annotations

import itertools
import math
from collections.abc import Callable, Sequence
from dataclasses import dataclass
from pathlib import Path

import numpy as np
import shapely
import trimesh
from house_meshes import HOUSE, SOFT
from shapely.geometry import Polygon
from trimesh.creation import box, cylinder, extrude_polygon
from trimesh.transformations import rotation_matrix
from write_obj import obj_text

FOLDER = Path(__file__).parent

PLATE_THICKNESS = 0.004


@dataclass(frozen=True, slots=True)
class Stack:
    """Plates one above the other, held apart by posts.

    Attributes:
        centre_x: middle of the plates along x.
        size: edge length of the square that a plate is cut from.
        cut: how much of an edge is cut off at each corner.
        undersides: z of the underside of each plate.
        posts: (x, y) of the posts on the left; the right has the same.
        holes: (distance between holes, width of a hole) of the grid.
    """

    centre_x: float
    size: float
    cut: float
    undersides: tuple[float, ...]
    posts: tuple[tuple[float, float], ...]
    holes: tuple[float, float]

    def post_places(self) -> list[tuple[float, float]]:
        return [(x, side * y) for x, y in self.posts for side in (1, -1)]


WAFFLE = Stack(
    centre_x=-0.064,
    size=0.266,
    cut=0.062,
    undersides=(0.006, 0.048, 0.088),
    posts=((0.045, 0.062), (-0.028, 0.110), (-0.100, 0.110), (-0.173, 0.062)),
    holes=(0.0205, 0.0140),
)
BURGER = Stack(
    centre_x=-0.033,
    size=0.138,
    cut=0.030,
    undersides=(0.006, 0.050, 0.094, 0.138),
    posts=((0.025, 0.032), (-0.010, 0.060), (-0.056, 0.060), (-0.091, 0.032)),
    holes=(0.0170, 0.0115),
)
WHEEL_RADIUS, WHEEL_WIDTH = 0.033, 0.018
TREAD_DEPTH, TREAD_RIBS = 0.0022, 20
LIDAR_TOP = 0.011  # above the scan plane


def moved(mesh: trimesh.Trimesh, x: float = 0.0, y: float = 0.0, z: float = 0.0) -> trimesh.Trimesh:
    """The same mesh, shifted [m]."""
    mesh.apply_translation((x, y, z))
    return mesh


def block(size: tuple[float, float, float], centre: tuple[float, float, float]) -> trimesh.Trimesh:
    """A box of full edge lengths `size` around `centre` [m]."""
    return moved(box(extents=size), *centre)


def slab(outline: Polygon, bottom: float, height: float) -> trimesh.Trimesh:
    """`outline` in the x-y plane, from z = `bottom` up by `height` [m]."""
    return moved(extrude_polygon(outline, height), z=bottom)


def rounded(width: float, depth: float, radius: float, segments: int = 3) -> Polygon:
    """A rectangle around the origin with rounded corners."""
    inner = shapely.box(-width / 2 + radius, -depth / 2 + radius, width / 2 - radius, depth / 2 - radius)
    return inner.buffer(radius, quad_segs=segments)


def lathe(profile: list[tuple[float, float]], sections: int = 24) -> trimesh.Trimesh:
    """A closed solid of revolution about z from (radius, z) pairs."""
    return trimesh.creation.revolve(np.array(profile), sections=sections)


def upright_to_y(mesh: trimesh.Trimesh) -> trimesh.Trimesh:
    """Turns a part made along z so that its axis is y (a wheel's axle)."""
    mesh.apply_transform(rotation_matrix(-math.pi / 2, (1, 0, 0)))
    return mesh


# ------------------------------------------------------------------ body


def plate_outline(stack: Stack) -> Polygon:
    """A plate with its grid of square holes, which gave the waffle its name."""
    half, cut = stack.size / 2, stack.cut
    corners = []
    for x, y in ((1, 1), (-1, 1), (-1, -1), (1, -1)):
        a, b = (x * half, y * (half - cut)), (x * (half - cut), y * half)
        corners += [a, b] if x == y else [b, a]
    bend = stack.size * 0.045
    outline = Polygon(corners).buffer(-bend).buffer(bend, quad_segs=3)
    rim = outline.buffer(-0.007)
    pitch, hole = stack.holes
    grid = [
        shapely.affinity.translate(rounded(hole, hole, 0.003, segments=1), i * pitch, j * pitch)
        for i in range(-6, 7)
        for j in range(-6, 7)
    ]
    seats = shapely.union_all([shapely.Point(x - stack.centre_x, y).buffer(0.007) for x, y in stack.post_places()])
    holes = [h for h in grid if rim.contains(h) and not seats.intersects(h)]
    return outline.difference(shapely.union_all(holes))


def plates(stack: Stack) -> list[trimesh.Trimesh]:
    outline = shapely.affinity.translate(plate_outline(stack), stack.centre_x, 0)
    return [slab(outline, z, PLATE_THICKNESS) for z in stack.undersides]


def posts(stack: Stack) -> list[trimesh.Trimesh]:
    parts = []
    for x, y in stack.post_places():
        for low, high in itertools.pairwise(stack.undersides):
            bottom, length = low + PLATE_THICKNESS, high - low - PLATE_THICKNESS
            parts.append(moved(cylinder(0.0035, length, sections=6), x, y, bottom + length / 2))
        parts.append(
            moved(cylinder(0.0030, 0.0025, sections=6), x, y, stack.undersides[-1] + PLATE_THICKNESS + 0.00125)
        )
    return parts


def motors(y: float, casters: Sequence[tuple[float, float]]) -> list[trimesh.Trimesh]:
    """Two geared motors, `y` from the middle plane to the axle's end of each, and the housings of the ball casters."""
    parts = []
    for side in (1, -1):
        parts.append(block((0.046, 0.034, 0.034), (-0.010, side * (y - 0.025), 0.027)))
        parts.append(upright_to_y(cylinder(0.011, 0.008, sections=16)))
        moved(parts[-1], 0, side * (y - 0.004), 0.023)
    parts += [moved(cylinder(0.011, 0.010, sections=12), *place, 0.001) for place in casters]
    return parts


def waffle_battery() -> list[trimesh.Trimesh]:
    return [slab(shapely.affinity.translate(rounded(0.105, 0.046, 0.006), -0.075, 0), 0.0105, 0.026)]


def waffle_boards() -> list[trimesh.Trimesh]:
    """The motor controller and the computer on the middle plate, as bare boards."""
    return [
        block((width, depth, 0.0016), (x, 0, 0.058))
        for x, width, depth in ((-0.010, 0.075, 0.105), (-0.125, 0.085, 0.087))
    ]


def waffle_chips() -> list[trimesh.Trimesh]:
    """What stands on the boards: sockets, heat sink, connectors."""
    spots = (
        ((0.012, 0.014, 0.012), (-0.152, 0.030, 0.065)),
        ((0.018, 0.016, 0.014), (-0.155, 0.008, 0.066)),
        ((0.018, 0.016, 0.014), (-0.155, -0.016, 0.066)),
        ((0.030, 0.030, 0.010), (-0.118, 0.004, 0.064)),
        ((0.016, 0.016, 0.003), (-0.008, 0.000, 0.060)),
        ((0.008, 0.070, 0.008), (0.020, 0.000, 0.063)),
        ((0.010, 0.030, 0.009), (-0.038, 0.020, 0.063)),
    )
    return [block(size, centre) for size, centre in spots]


def burger_battery() -> list[trimesh.Trimesh]:
    """Lies across, behind the motors."""
    return [slab(shapely.affinity.translate(rounded(0.036, 0.092, 0.006), -0.066, 0), 0.0105, 0.026)]


def burger_boards() -> list[trimesh.Trimesh]:
    """The motor controller on the second plate and the computer on the third."""
    return [block((0.075, 0.105, 0.0016), (-0.033, 0, 0.060)), block((0.085, 0.056, 0.0016), (-0.033, 0.010, 0.104))]


def burger_chips() -> list[trimesh.Trimesh]:
    spots = (
        ((0.016, 0.016, 0.003), (-0.030, 0.000, 0.0623)),
        ((0.008, 0.070, 0.008), (-0.001, 0.000, 0.0648)),
        ((0.010, 0.030, 0.009), (-0.062, 0.022, 0.0653)),
        ((0.014, 0.012, 0.010), (-0.060, -0.030, 0.0658)),
        ((0.018, 0.014, 0.014), (-0.067, 0.025, 0.1118)),
        ((0.018, 0.014, 0.014), (-0.067, 0.006, 0.1118)),
        ((0.014, 0.014, 0.008), (-0.028, 0.008, 0.1088)),
        ((0.052, 0.005, 0.008), (-0.030, 0.034, 0.1088)),
    )
    return [block(size, centre) for size, centre in spots]


# ------------------------------------------------------------------ wheel, about its own axle (y)


def tyre() -> list[trimesh.Trimesh]:
    """A rubber ring with raised ribs across; the ribs' tops lie on the rolling radius."""
    core, inner, half = WHEEL_RADIUS - TREAD_DEPTH, 0.0235, WHEEL_WIDTH / 2
    ring = lathe(
        [
            (inner, -half),
            (core - 0.001, -half),
            (core, -half + 0.002),
            (core, half - 0.002),
            (core - 0.001, half),
            (inner, half),
            (inner, -half),
        ],
        sections=TREAD_RIBS * 2,
    )
    parts = [ring]
    width = 2 * math.pi * WHEEL_RADIUS / TREAD_RIBS * 0.52
    for k in range(TREAD_RIBS):
        rib = block((TREAD_DEPTH + 0.001, width, WHEEL_WIDTH - 0.001), (core - 0.001 + (TREAD_DEPTH + 0.001) / 2, 0, 0))
        rib.apply_transform(rotation_matrix(2 * math.pi * k / TREAD_RIBS, (0, 0, 1)))
        parts.append(rib)
    # the ribs' corners would lie outside the rolling radius: pull every vertex back onto it
    for part in parts:
        radius = np.hypot(part.vertices[:, 0], part.vertices[:, 1])
        part.vertices[:, :2] *= np.minimum(1.0, WHEEL_RADIUS / np.maximum(radius, 1e-9))[:, None]
    return [upright_to_y(part) for part in parts]


def hub() -> list[trimesh.Trimesh]:
    """A rim with five spokes, drawn on both faces so that one mesh serves both wheels."""
    half = WHEEL_WIDTH / 2 - 0.001
    rim = lathe([(0.0195, -half), (0.0238, -half), (0.0238, half), (0.0195, half), (0.0195, -half)], sections=30)
    parts = [rim, cylinder(0.008, 2 * half, sections=15)]
    for k in range(5):
        spoke = block((0.015, 0.006, 2 * half - 0.003), (0.0135, 0, 0))
        spoke.apply_transform(rotation_matrix(2 * math.pi * k / 5, (0, 0, 1)))
        parts.append(spoke)
    return [upright_to_y(part) for part in parts]


# ------------------------------------------------------------------ lidar, camera, solar cell


def lidar_base() -> list[trimesh.Trimesh]:
    """The foot of the laser scanner with its motor's bulge behind; z = 0 is the scan plane."""
    foot = rounded(0.070, 0.070, 0.020, segments=4)
    tail = shapely.affinity.translate(rounded(0.046, 0.040, 0.012, segments=3), -0.032, 0)
    low = -0.029
    return [
        slab(foot.union(tail), low, 0.015),
        *(block((0.006, 0.006, 0.003), (x, y, low - 0.0005)) for x in (0.026, -0.026) for y in (0.026, -0.026)),
    ]


def lidar_head() -> list[trimesh.Trimesh]:
    """The turning head: a flat dome with the two windows' recess in front."""
    dome = lathe(
        [(0, -0.014), (0.0345, -0.014), (0.0345, 0.005), (0.0325, 0.009), (0.0280, LIDAR_TOP), (0, LIDAR_TOP)],
        sections=32,
    )
    return [dome]


def lidar_window() -> list[trimesh.Trimesh]:
    """Transmitter and receiver openings, just proud of the head."""
    return [block((0.004, 0.016, 0.011), (0.0335, side * 0.0125, -0.003)) for side in (1, -1)]


def camera_body() -> list[trimesh.Trimesh]:
    """A slim depth camera's case; the origin is the colour lens, looking along x."""
    case = slab(rounded(0.020, 0.130, 0.009, segments=4), -0.010, 0.020)
    return [moved(case, -0.008, 0.047, 0)]


def camera_lenses() -> list[trimesh.Trimesh]:
    """The dark front strip's lenses: colour, two infrared eyes and the projector, and the bracket behind."""
    parts = []
    for y, radius in ((0.0, 0.0045), (0.022, 0.0038), (0.052, 0.0030), (0.092, 0.0038)):
        lens = cylinder(radius, 0.003, sections=16)
        lens.apply_transform(rotation_matrix(math.pi / 2, (0, 1, 0)))
        parts.append(moved(lens, 0.0022, y, 0))
    return [*parts, block((0.014, 0.024, 0.010), (-0.012, 0.047, -0.014))]


def pi_camera_board() -> list[trimesh.Trimesh]:
    """A small upright board on its bracket; the origin is the lens, looking along x."""
    board = rounded(0.024, 0.025, 0.002, segments=2)
    plate = extrude_polygon(board, 0.0012)
    plate.apply_transform(rotation_matrix(-math.pi / 2, (0, 1, 0)))
    return [moved(plate, -0.0065, 0, 0.0015), block((0.0025, 0.022, 0.0012), (-0.0085, 0, 0.0150))]


def pi_camera_mount() -> list[trimesh.Trimesh]:
    """An angle on the top plate that carries the board."""
    return [block((0.003, 0.030, 0.026), (-0.0095, 0, 0.002)), block((0.026, 0.030, 0.003), (-0.021, 0, 0.0005))]


def pi_camera_lens() -> list[trimesh.Trimesh]:
    lens = cylinder(0.0034, 0.003, sections=16)
    lens.apply_transform(rotation_matrix(math.pi / 2, (0, 1, 0)))
    return [block((0.006, 0.0085, 0.0085), (-0.0040, 0, 0)), moved(lens, -0.0005, 0, 0)]


def solar_cells() -> list[trimesh.Trimesh]:
    """Four cells in a frame; the origin is the middle of their upper face, z away from it."""
    return [block((0.017, 0.017, 0.0012), (x, y, -0.0006)) for x in (0.0095, -0.0095) for y in (0.0095, -0.0095)]


def solar_frame() -> list[trimesh.Trimesh]:
    return [
        slab(rounded(0.042, 0.042, 0.004, segments=2), -0.0045, 0.0039),
        block((0.010, 0.010, 0.006), (0, 0, -0.0075)),
    ]


Draw = Callable[[], list[trimesh.Trimesh]]

PARTS: dict[str, dict[str, Draw]] = {
    "turtlebot3_common": {
        "tyre": tyre,
        "hub": hub,
        "lidar_base": lidar_base,
        "lidar_head": lidar_head,
        "lidar_window": lidar_window,
        "waffle_plates": lambda: plates(WAFFLE),
        "waffle_posts": lambda: posts(WAFFLE),
        "waffle_motors": lambda: motors(0.133, ((-0.177, 0.064), (-0.177, -0.064))),
        "waffle_battery": waffle_battery,
        "waffle_boards": waffle_boards,
        "waffle_chips": waffle_chips,
    },
    "turtlebot3_burger": {
        "plates": lambda: plates(BURGER),
        "posts": lambda: posts(BURGER),
        "motors": lambda: motors(0.070, ((-0.081, 0.0),)),
        "battery": burger_battery,
        "boards": burger_boards,
        "chips": burger_chips,
    },
    "turtlebot3_waffle": {
        "camera_body": camera_body,
        "camera_lenses": camera_lenses,
        "solar_cells": solar_cells,
        "solar_frame": solar_frame,
    },
    "turtlebot3_waffle_pi": {
        "camera_board": pi_camera_board,
        "camera_mount": pi_camera_mount,
        "camera_lens": pi_camera_lens,
    },
    "turtlebot3_house": HOUSE,
}
"""What is drawn: folder, name of the file, and the function that draws it."""


def main() -> None:
    for folder, parts in PARTS.items():
        meshes = FOLDER / folder / "meshes"
        meshes.mkdir(parents=True, exist_ok=True)
        for name, draw in parts.items():
            text = obj_text(name, draw(), smooth=name in SOFT)
            (meshes / f"{name}.obj").write_text(text, encoding="utf-8")
            count = text.count("\nf ")
            print(f"{folder}/{name:16s} {count:6d} triangles")


if __name__ == "__main__":
    main()
