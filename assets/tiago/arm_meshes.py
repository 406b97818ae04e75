"""The shapes of arm and gripper, in the frames of their links; the fingers point along -z and open along x."""

from __future__ import annotations

from shapely import affinity
from shapely.geometry import Polygon
from solids import Mesh, along_x, along_y, barrel, block, disc, hull, moved, rectangle, slab, stack


def arm_1() -> list[Mesh]:
    """A puck on the bracket, and an arm to the flange beside the second joint."""
    bridge = hull((disc(0.046), -0.008), (disc(0.046), 0.034), (rectangle((0.03, 0.052), (0.16, 0.086), 0.010), 0.0))
    flange = moved(along_y(barrel(0.052, 0.070, 0.087, 0.005)), 0.125, 0, -0.031)
    rib = hull(
        (rectangle((0.085, 0.070), (0.165, 0.086), 0.006), -0.05),
        (rectangle((0.06, 0.055), (0.165, 0.086), 0.008), 0.012),
    )
    return [barrel(0.052, -0.022, 0.038, 0.006), bridge, flange, rib]


def arm_2() -> list[Mesh]:
    """The second motor across, and the collar of the third."""
    collar = along_x(hull((disc(0.046), 0.0), (disc(0.050), 0.060), (disc(0.048), 0.082)))
    return [barrel(0.052, -0.052, 0.049, 0.008), collar]


def arm_3() -> list[Mesh]:
    """Upper arm, tapering to the elbow."""
    shaft = stack(
        (disc(0.044, -0.012), -0.215), (disc(0.046, -0.006), -0.150), (disc(0.050), -0.060), (disc(0.050), 0.004)
    )
    elbow = moved(along_y(barrel(0.052, 0.003, 0.058, 0.008)), -0.020, 0, -0.222)
    return [*shaft, elbow]


def arm_3_ring() -> list[Mesh]:
    return [barrel(0.0508, -0.010, -0.004, 0.001)]


def arm_4() -> list[Mesh]:
    """Elbow and the part of the forearm that does not turn; along -x."""
    fore = [
        moved(along_x(part), 0, 0.020, 0.027)
        for part in (
            hull((disc(0.038), 0.0), (disc(0.046), -0.055)),
            hull((disc(0.046), -0.055), (disc(0.050), -0.150)),
            barrel(0.050, -0.168, -0.150, 0.003),
        )
    ]
    neck = hull((disc(0.046), 0.0), (rectangle((-0.090, -0.028), (-0.030, 0.060), 0.012), 0.020), (disc(0.040), 0.024))
    return [barrel(0.052, -0.031, 0.024, 0.008), neck, *fore]


def arm_5() -> list[Mesh]:
    """The turning part of the forearm, swelling to the fork of the wrist; z points out."""
    body = stack(
        (disc(0.050), 0.010),
        (disc(0.053), 0.030),
        (affinity.scale(disc(0.053), 1.0, 1.18), 0.080),
        (affinity.scale(disc(0.050), 0.92, 1.30), 0.112),
    )
    cheek = hull(
        (rectangle((-0.040, 0.100), (0.040, 0.110), 0.004), 0.0),
        (disc(0.034, 0.0, 0.152), 0.0),
        (disc(0.034, 0.0, 0.152), 0.018),
        (rectangle((-0.040, 0.100), (0.040, 0.110), 0.004), 0.018),
    )
    parts = list(body)
    for y in (0.046, -0.064):
        plate = cheek.copy()
        # drawn in x and z, thick along y
        plate.apply_transform([[1, 0, 0, 0], [0, 0, 1, y], [0, 1, 0, 0], [0, 0, 0, 1]])
        plate.invert()
        parts.append(plate)
    return parts


def arm_5_ring() -> list[Mesh]:
    return [barrel(0.0508, 0.004, 0.011, 0.001)]


def arm_6() -> list[Mesh]:
    """The gimbal between the fork's cheeks."""
    return [barrel(0.036, -0.021, 0.021, 0.004), along_x(barrel(0.018, -0.030, 0.030, 0.003, 20))]


def arm_7() -> list[Mesh]:
    """The shaft that carries the tool."""
    return [barrel(0.022, 0.004, 0.046, 0.003, 24), hull((disc(0.028), 0.010), (disc(0.022), 0.034))]


def gripper_palm() -> list[Mesh]:
    return stack(
        (rectangle((-0.079, -0.035), (0.079, 0.035), 0.012), -0.098),
        (rectangle((-0.080, -0.036), (0.080, 0.036), 0.014), -0.080),
        (rectangle((-0.062, -0.036), (0.062, 0.036), 0.018), -0.030),
        (disc(0.034), -0.004),
    )


def gripper_rail() -> list[Mesh]:
    """The guide of the fingers, and the ring at the wrist."""
    rail = slab(rectangle((-0.076, -0.022), (0.076, 0.022), 0.006), -0.105, -0.097)
    return [rail, barrel(0.030, -0.006, 0.002, 0.001)]


def finger(sign: int) -> list[Mesh]:
    """Carriage and finger; the inner face lies in x = 0, the pad on it."""

    def turned(outline: Polygon, low: float, high: float) -> Mesh:
        part = slab(outline, low, high)  # drawn in x and z, thick along y
        part.apply_transform([[sign, 0, 0, 0], [0, 0, 1, 0], [0, 1, 0, 0], [0, 0, 0, 1]])
        if sign > 0:
            part.invert()
        return part

    blade = Polygon(
        [
            (0.0042, -0.219),
            (0.010, -0.219),
            (0.012, -0.200),
            (0.016, -0.150),
            (0.030, -0.126),
            (0.030, -0.106),
            (0.0042, -0.106),
        ]
    )
    return [turned(blade, -0.018, 0.018), turned(rectangle((0.0045, -0.124), (0.028, -0.105), 0.003), -0.024, 0.024)]


def finger_pad(sign: int) -> list[Mesh]:
    low, high = sorted((0.0, sign * 0.0045))
    return [block((low, -0.025, -0.220), (high, 0.025, -0.112))]
