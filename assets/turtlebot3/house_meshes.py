"""Draws what is round or soft in the house; `make_meshes.py` writes it into `turtlebot3_house/meshes/`.

Lengths m; each mesh in the frame of its piece of furniture (see `furniture.py`).
"""

from __future__ import annotations

import math
from collections.abc import Callable

import numpy as np
import trimesh
from trimesh.creation import box, cylinder, icosphere, revolve
from trimesh.transformations import rotation_matrix

Parts = list[trimesh.Trimesh]


def pillowed(size: tuple[float, float, float], softness: float, subdivisions: int = 2) -> trimesh.Trimesh:
    """A body between a box (`softness` 0) and an ellipsoid (1) of full edge lengths `size`, around the origin."""
    ball = icosphere(subdivisions=subdivisions)
    power = 2.0 / (1.0 + 7.0 * (1.0 - softness))  # of a superellipsoid: 1 is a sphere, 0.25 nearly a box
    unit = np.sign(ball.vertices) * np.abs(ball.vertices) ** power
    unit /= np.abs(unit).max(axis=0)
    ball.vertices = unit * (np.array(size) / 2)
    return ball


def turned(profile: list[tuple[float, float]], sections: int = 24) -> trimesh.Trimesh:
    """A solid of revolution about z from (radius, z) pairs."""
    return revolve(np.array(profile), sections=sections)


def stretched(mesh: trimesh.Trimesh, x: float, y: float, z: float = 1.0) -> trimesh.Trimesh:
    mesh.apply_scale((x, y, z))
    return mesh


def leaf(length: float, width: float, lean: float, azimuth: float, height: float) -> trimesh.Trimesh:
    """A bent blade that starts at `height` on the axis and points to `azimuth`, `lean` from the vertical."""
    steps = np.linspace(0.0, 1.0, 6)
    bend = lean + 0.9 * steps**2
    along = np.concatenate([[0.0], np.cumsum(np.sin(bend)[1:] * length / 5)])
    up = np.concatenate([[0.0], np.cumsum(np.cos(bend)[1:] * length / 5)]) + height
    half = width / 2 * np.sin(math.pi * (0.12 + 0.86 * steps)) + 0.001
    rows = [[(a, s * h, z), (a, s * h, z - 0.004)] for a, z, h in zip(along, up, half, strict=True) for s in (1, -1)]
    vertices = np.array([p for pair in rows for p in pair])
    faces = []
    for i in range(5):
        a = 4 * i  # left top, left bottom, right top, right bottom, then the same of the next row
        left, under, right, beneath = a, a + 1, a + 2, a + 3
        for p, q in ((left, right), (beneath, under), (under, left), (right, beneath)):
            faces += [(p, q, q + 4), (p, q + 4, p + 4)]
    mesh = trimesh.Trimesh(vertices, faces, process=False)
    mesh.apply_transform(rotation_matrix(azimuth, (0, 0, 1)))
    return mesh


def leaves() -> Parts:
    """A tall plant: a stem with blades all around."""
    golden = math.pi * (3 - math.sqrt(5))
    blades = [leaf(0.42 - 0.012 * k, 0.10, 0.25 + 0.035 * k, golden * k, 0.62 - 0.045 * k) for k in range(13)]
    stem = cylinder(0.012, 0.62, sections=8)
    stem.apply_translation((0, 0, 0.31))
    return [stem, *blades]


def grass() -> Parts:
    golden = math.pi * (3 - math.sqrt(5))
    return [leaf(0.30 + 0.02 * (k % 4), 0.04, 0.10 + 0.045 * k, golden * k, 0.0) for k in range(16)]


def star() -> Parts:
    """Five feet with castors."""
    parts = []
    for k in range(5):
        turn = rotation_matrix(2 * math.pi * k / 5 + math.pi / 2, (0, 0, 1))
        foot = box(extents=(0.28, 0.045, 0.03))
        foot.apply_translation((0.14, 0, 0.075))
        castor = cylinder(0.028, 0.04, sections=12)
        castor.apply_transform(rotation_matrix(math.pi / 2, (1, 0, 0)))
        castor.apply_translation((0.27, 0, 0.028))
        for part in (foot, castor):
            part.apply_transform(turn)
            parts.append(part)
    return parts


def bathtub() -> Parts:
    """A tub with thick walls, open above; 1.7 m along x."""
    half_x, half_y, high, wall = 0.85, 0.375, 0.58, 0.08
    parts = []
    for s in (1, -1):
        long = box(extents=(2 * half_x, wall, high))
        long.apply_translation((0, s * (half_y - wall / 2), high / 2))
        short = box(extents=(wall, 2 * (half_y - wall), high))
        short.apply_translation((s * (half_x - wall / 2), 0, high / 2))
        rim = box(extents=(2 * half_x, 0.02, 0.02))
        rim.apply_translation((0, s * (half_y + 0.005), high - 0.01))
        parts += [long, short, rim]
    floor = box(extents=(2 * half_x, 2 * half_y, 0.10))
    floor.apply_translation((0, 0, 0.05))
    return [*parts, floor]


def toilet() -> Parts:
    """Bowl, seat and lid's rim, longer than wide."""
    bowl = turned([(0, 0), (0.12, 0), (0.11, 0.14), (0.18, 0.34), (0.185, 0.38), (0, 0.38)])
    seat = turned([(0.11, 0.38), (0.19, 0.38), (0.19, 0.41), (0.11, 0.41), (0.11, 0.38)])
    return [stretched(part, 1.0, 1.35) for part in (bowl, seat)]


def porthole() -> Parts:
    ring = turned([(0.13, 0), (0.19, 0), (0.18, 0.03), (0.13, 0.03), (0.13, 0)])
    ring.apply_transform(rotation_matrix(-math.pi / 2, (1, 0, 0)))
    return [ring]


def bowl() -> Parts:
    return [
        turned([(0.05, 0), (0.10, 0.015), (0.16, 0.07), (0.15, 0.07), (0.095, 0.025), (0, 0.018), (0, 0), (0.05, 0)])
    ]


def pot() -> Parts:
    return [
        turned([(0, 0), (0.11, 0), (0.155, 0.30), (0.165, 0.30), (0.165, 0.34), (0.14, 0.34), (0.13, 0.30), (0, 0.30)])
    ]


def shade(radius: float, height: float) -> Parts:
    inner = radius - 0.008
    profile = [(radius, 0), (radius * 0.7, height), (inner * 0.7, height), (inner, 0), (radius, 0)]
    return [turned(profile, sections=28)]


def single(mesh: trimesh.Trimesh) -> Parts:
    return [mesh]


SOFT = frozenset({"seat", "back", "pillow", "bed_pillow", "blanket", "round_seat", "chair_back"})
"""What has no edges: drawn with smooth shading."""

HOUSE: dict[str, Callable[[], Parts]] = {
    "seat": lambda: single(pillowed((0.64, 0.66, 0.20), 0.45)),
    "back": lambda: single(pillowed((0.62, 0.22, 0.46), 0.55)),
    "pillow": lambda: single(pillowed((0.42, 0.18, 0.38), 0.75)),
    "bed_pillow": lambda: single(pillowed((0.66, 0.42, 0.16), 0.70)),
    "blanket": lambda: single(pillowed((1.68, 1.52, 0.20), 0.25)),
    "round_seat": lambda: single(pillowed((0.48, 0.48, 0.10), 0.60)),
    "chair_back": lambda: single(pillowed((0.44, 0.08, 0.50), 0.60)),
    "leaves": leaves,
    "grass": grass,
    "pot": pot,
    "shade": lambda: shade(0.24, 0.30),
    "small_shade": lambda: shade(0.12, 0.16),
    "bowl": bowl,
    "bathtub": bathtub,
    "toilet": toilet,
    "porthole": porthole,
    "star": star,
}
