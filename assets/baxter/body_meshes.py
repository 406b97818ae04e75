"""The shapes of pedestal, torso and head, in the frames of their links; of the screen x is to the left, y up."""

from __future__ import annotations

from links import HEIGHT
from shapely import affinity
from solids import Mesh, along_x, barrel, disc, hull, moved, rectangle, slab, stack

SHOULDER = (0.064, 0.259)  # x, y of the left arm's first joint
FEET = ((0.36, 0.33), (0.36, -0.33), (-0.36, 0.33), (-0.36, -0.33))


def pedestal_column() -> list[Mesh]:
    return stack((disc(0.17), -0.12), (disc(0.11), -0.24), (disc(0.11), -0.74), (disc(0.17), -0.83))


def pedestal_legs() -> list[Mesh]:
    low, high = 0.06 - HEIGHT, 0.12 - HEIGHT
    return [hull((disc(0.05, x, y), low), (disc(0.15), low), (disc(0.035, x, y), low + 0.03), (disc(0.12), high))
            for x, y in FEET]  # fmt: skip


def pedestal_feet() -> list[Mesh]:
    return [moved(barrel(0.04, 0.0, 0.07, 0.01), x, y, -HEIGHT) for x, y in FEET]


def torso_shell() -> list[Mesh]:
    """The red shell: broad between the shoulders, narrow at the neck."""
    return stack(
        (rectangle((-0.11, -0.13), (0.09, 0.13), 0.05), -0.10),
        (rectangle((-0.16, -0.19), (0.12, 0.19), 0.07), 0.06),
        (rectangle((-0.16, -0.20), (0.13, 0.20), 0.07), 0.20),
        (rectangle((-0.14, -0.16), (0.12, 0.16), 0.06), 0.38),
        (rectangle((-0.08, -0.09), (0.11, 0.09), 0.05), 0.55),
    )


def torso_core() -> list[Mesh]:
    """Waist, and the brackets of the arms."""
    parts = [barrel(0.15, -0.14, -0.08, 0.01)]
    for side in (1, -1):
        x, y = SHOULDER[0], side * SHOULDER[1]
        foot = rectangle((-0.12, min(0, side * 0.18)), (0.10, max(0, side * 0.18)), 0.03)
        parts.append(hull((disc(0.075, x, y), 0.065), (disc(0.080, x, y), 0.125), (foot, 0.04), (foot, 0.125)))
    return parts


def torso_neck() -> list[Mesh]:
    return [moved(hull((disc(0.065), 0.54), (disc(0.055), 0.63)), 0.04), moved(barrel(0.05, 0.62, 0.66), 0.06)]


def head_neck() -> list[Mesh]:
    back = along_x(hull((rectangle((-0.04, -0.05), (0.05, 0.05), 0.02), 0.0), (disc(0.04), 0.09)))
    return [barrel(0.05, -0.03, 0.05, 0.008), back]


def screen_shell() -> list[Mesh]:
    return [
        hull(
            (rectangle((-0.10, -0.06), (0.10, 0.06), 0.03), -0.075),
            (rectangle((-0.155, -0.10), (0.155, 0.10), 0.035), -0.030),
            (rectangle((-0.160, -0.105), (0.160, 0.105), 0.035), -0.012),
        )
    ]


def screen_frame() -> list[Mesh]:
    return [slab(rectangle((-0.152, -0.097), (0.152, 0.097), 0.03), -0.012, 0.002)]


def screen_display() -> list[Mesh]:
    return [slab(rectangle((-0.130, -0.080), (0.130, 0.080), 0.008), 0.002, 0.003)]


def screen_eyes() -> list[Mesh]:
    """Two eyes with a brow each."""
    parts = []
    for side in (1, -1):
        eye = affinity.scale(disc(0.026, side * 0.052, -0.004), 1.0, 1.25)
        brow = affinity.rotate(rectangle((-0.028, -0.004), (0.028, 0.004), 0.0035), -8 * side)
        parts += [slab(eye, 0.003, 0.004), slab(affinity.translate(brow, side * 0.055, 0.048), 0.003, 0.004)]
    return parts


def screen_pupils() -> list[Mesh]:
    return [slab(disc(0.014, side * 0.048, -0.012), 0.004, 0.005) for side in (1, -1)]
