"""The shapes of the base, in the frames of its links (base_link: the origin lies on the axle)."""

from __future__ import annotations

from math import cos, pi, sin

import shapely
from shapely import affinity
from shapely.geometry import Polygon
from solids import Mesh, along_y, band, barrel, block, disc, lathe, moved, rectangle, sector, slab

TURN = 2 * pi

SLOT = (-0.020, 0.030)
"""The laser looks out between these heights; its plane is at -0.004."""


def hull_top() -> list[Mesh]:
    """The drum above the slot with its lid."""
    profile = [(0, 0.030), (0.252, 0.030), (0.260, 0.038), (0.260, 0.176), (0.256, 0.186), (0.246, 0.193), (0, 0.193)]
    return [lathe(profile, sections=56)]


def hull_skirt() -> list[Mesh]:
    """The skirt around the wheels, open where they are, and the wall behind the slot."""
    front, back = ((-66, 66), (114, 246))
    lower = [slab(sector(0.235, 0.257, *ends), -0.074, SLOT[0]) for ends in (front, back)]
    return [*lower, slab(sector(0.235, 0.257, 128, 232), *SLOT)]


def hull_core() -> list[Mesh]:
    """What is seen dark inside the slot and behind the wheels; out of the laser's view."""
    wells = [shapely.box(-0.104, y, 0.104, y + 0.15) for y in (0.150, -0.300)]
    floor = disc(0.235, segments=12).difference(shapely.union_all(wells))
    return [moved(barrel(0.185, -0.062, 0.030, sections=40), x=-0.06), slab(floor, -0.070, SLOT[0] - 0.004)]


def cover_ring() -> list[Mesh]:
    """The ring in base_cover_link's frame; open in front."""
    return [band(0.267, 0.012, 0.012, 0.072, 17, 343)]


def cover_ring_base() -> list[Mesh]:
    return [lathe([(0.250, 0.002), (0.262, 0.004), (0.262, 0.076), (0.250, 0.088)], sections=56)]


def laser_housing() -> list[Mesh]:
    """Scanner head and foot; the origin lies in the scan plane."""
    return [
        moved(barrel(0.027, -0.034, -0.004, sections=20), x=-0.030),
        block((-0.058, -0.030, -0.058), (0.000, 0.030, -0.034)),
    ]


def wheel_tyre() -> list[Mesh]:
    """About z; the rolling radius is 98.5 mm."""
    return [
        lathe([(0.074, -0.030), (0.094, -0.030), (0.0985, -0.024), (0.0985, 0.024), (0.094, 0.030), (0.074, 0.030)], 40)
    ]


def wheel_rim() -> list[Mesh]:
    """Rim, hub and five spokes with their bolts."""
    parts = [
        lathe([(0.066, -0.026), (0.075, -0.026), (0.075, 0.026), (0.066, 0.026)], 40),
        barrel(0.026, -0.034, 0.034),
    ]
    for k in range(5):
        spoke = affinity.rotate(rectangle((0.018, -0.009), (0.070, 0.009), 0.004), 72 * k, origin=(0, 0))
        parts.append(slab(spoke, -0.022, 0.022))
        parts.append(
            moved(barrel(0.004, -0.027, 0.027, sections=8), 0.052 * cos(TURN * k / 5), 0.052 * sin(TURN * k / 5))
        )
    return parts


def caster_fork() -> list[Mesh]:
    """Swivel plate and the two cheeks that hold the wheel 16 mm behind the swivel."""
    cheek = Polygon([(0.010, -0.012), (-0.008, -0.006), (-0.026, -0.034), (-0.022, -0.046), (-0.010, -0.046)])
    parts = [barrel(0.016, -0.012, -0.002, sections=20)]
    for y in (-0.0135, 0.0135):
        plate = slab(affinity.scale(cheek, yfact=-1, origin=(0, 0)), -0.0015, 0.0015)
        parts.append(moved(along_y(plate), y=y))
    return parts
