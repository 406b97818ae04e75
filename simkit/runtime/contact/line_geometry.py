"""Contacts along lines: cylinders and capsules with nearly parallel axes, and cylinders on the edges of boxes.

MuJoCo reports one contact for two parallel cylinders, anywhere on their common line. From step to step it jumps, so
that a pile of logs never rests. At the edge of a box, MuJoCo reports the normal of a side face for a cylinder, up to
90° wrong. The functions of this module compute these contacts exactly: one at each end of the common length, and one
where the axes cross if the bodies are nearest there.

All points and vectors are in one frame. Lengths are in metres.
"""

from __future__ import annotations

import math
from typing import Final, NamedTuple

PARALLEL: Final = math.cos(math.radians(2.0))
"""Least cosine between nearly parallel directions. At larger angles, bodies meet in one point."""

_MIN_LENGTH: Final = 0.02
"""Least common length in units of the radii; at a shorter one, the bodies may touch with their caps."""

_CROSSING: Final = 1e-6
"""Least additional depth [m] of the point where two axes cross; without it, that point jumps for parallel axes."""

_WRONG_NORMAL: Final = 0.9995
"""Cosine of the least error of a normal (1.8°) at an edge that is oblique to the axis."""

Vector = tuple[float, float, float]


class Rod(NamedTuple):
    """Cylinder or capsule.

    Attributes:
        centre: its centre.
        axis: unit vector along its axis.
        radius: its radius [m].
        half: half the length of its straight part [m].
        has_balls: True for a capsule.
    """

    centre: Vector
    axis: Vector
    radius: float
    half: float
    has_balls: bool


class LineContact(NamedTuple):
    """Contact point.

    Attributes:
        distance: distance of the surfaces [m]; negative for a penetration.
        position: point half way between the surfaces.
        normal: unit vector from the first body to the second one.
    """

    distance: float
    position: Vector
    normal: Vector


def rod_contacts(one: Rod, other: Rod) -> list[LineContact] | None:
    """Return the contacts of two rods with nearly parallel axes; None if the axes or the common length differ too much.

    Args:
        one: first rod.
        other: second rod.
    """
    (p, q, r), (a, b, c), radius, half, balls = one
    (u, v, w), (d, e, f), other_radius, other_half, other_balls = other
    cosine = a * d + b * e + c * f
    if abs(cosine) < PARALLEL:
        return None
    x, y, z = u - p, v - q, w - r
    middle, span = x * a + y * b + z * c, other_half * abs(cosine)
    low, high = max(-half, middle - span), min(half, middle + span)
    if high - low < _MIN_LENGTH * (radius + other_radius):
        return None
    found: list[LineContact] = []
    for sign in (-1.0, 1.0):
        if half <= span + sign * middle:  # the first rod ends here
            t = sign * half
            found.append(_end_contact((p + t * a, q + t * b, r + t * c), one, other, 1.0))
        else:
            t = sign * other_half if cosine > 0.0 else -sign * other_half
            found.append(_end_contact((u + t * d, v + t * e, w + t * f), other, one, -1.0))
    least = min(found[0].distance, found[1].distance)
    square = 1.0 - cosine * cosine
    if square > 1e-12:
        along, across = x * a + y * b + z * c, x * d + y * e + z * f
        t, s = (along - cosine * across) / square, (cosine * along - across) / square
        if low < t < high and abs(s) < other_half:
            x, y, z = x + s * d - t * a, y + s * e - t * b, z + s * f - t * c
            size = math.sqrt(x * x + y * y + z * z)
            distance = size - radius - other_radius
            if size > 0.0 and distance < least - _CROSSING:
                x, y, z, reach = x / size, y / size, z / size, radius + distance / 2.0
                point = p + t * a + reach * x, q + t * b + reach * y, r + t * c + reach * z
                found.append(LineContact(distance, point, (x, y, z)))
                least = distance
    return found if -least < high - low else None


def _end_contact(end: Vector, one: Rod, other: Rod, sign: float) -> LineContact:
    """Return the contact between the end of a rod and the side of another rod.

    Args:
        end: centre of the end.
        one: rod that ends.
        other: rod whose side the end touches.
        sign: -1 to reverse the normal.
    """
    p, q, r = end
    (u, v, w), (d, e, f), side, _, _ = other
    s = (p - u) * d + (q - v) * e + (r - w) * f
    u, v, w = u + s * d, v + s * e, w + s * f
    x, y, z = u - p, v - q, w - r
    size = max(math.sqrt(x * x + y * y + z * z), 1e-12)
    x, y, z = x / size, y / size, z / size
    a, b, c = one.axis
    tilt = 0.0 if one.has_balls else a * x + b * y + c * z
    distance = size - side - one.radius * math.sqrt(max(0.0, 1.0 - tilt * tilt))
    reach = side + distance / 2.0
    return LineContact(distance, (u - reach * x, v - reach * y, w - reach * z), (sign * x, sign * y, sign * z))


def edge_contacts(rod: Rod, sizes: Vector, contacts: list[LineContact]) -> list[LineContact] | None:
    """Return the contacts of a cylinder with an edge of a box, in the frame of the box; None elsewhere on the box.

    Args:
        rod: cylinder.
        sizes: half the lengths of the box.
        contacts: the engine's contacts of both.
    """
    centre, axis, radius, half, _ = rod
    k = max(range(3), key=lambda i: abs(axis[i]))
    if abs(axis[k]) >= PARALLEL:
        return _parallel_edge(rod, sizes, k)
    position = contacts[0].position
    k = max(range(3), key=lambda i: sizes[i] - abs(position[i]))
    i, j = (k + 1) % 3, (k + 2) % 3
    corner = math.copysign(sizes[i], position[i]), math.copysign(sizes[j], position[j])
    t = _nearest(rod, corner, k)
    if not (abs(t) < half and abs(centre[k] + t * axis[k]) < sizes[k]):
        return None
    x, y = centre[i] + t * axis[i] - corner[0], centre[j] + t * axis[j] - corner[1]
    if not (x * corner[0] > 0.0 and y * corner[1] > 0.0):
        return None
    exact = _point_contact(rod, sizes, k, t, radius)
    if exact is None or all(_cosine(one.normal, exact.normal) > _WRONG_NORMAL for one in contacts):
        return None
    return [exact]


def _cosine(one: Vector, other: Vector) -> float:
    return one[0] * other[0] + one[1] * other[1] + one[2] * other[2]


def _nearest(rod: Rod, corner: tuple[float, float], k: int) -> float:
    """Return the place along the axis of a rod that is nearest to an edge [m].

    Args:
        rod: rod that is not parallel to the edge.
        corner: both other coordinates of the edge.
        k: number of the coordinate along the edge.
    """
    i, j = (k + 1) % 3, (k + 2) % 3
    centre, axis = rod.centre, rod.axis
    square = axis[i] * axis[i] + axis[j] * axis[j]
    if square < 1e-12:
        return math.inf
    return ((corner[0] - centre[i]) * axis[i] + (corner[1] - centre[j]) * axis[j]) / square


def _parallel_edge(rod: Rod, sizes: Vector, k: int) -> list[LineContact] | None:
    """Return the contacts of a cylinder whose axis is nearly parallel to an edge along coordinate k."""
    centre, axis, radius, half, _ = rod
    i, j = (k + 1) % 3, (k + 2) % 3
    ends = sorted(((-sizes[k] - centre[k]) / axis[k], (sizes[k] - centre[k]) / axis[k]))
    low, high = max(-half, ends[0]), min(half, ends[1])
    if high - low < _MIN_LENGTH * radius:
        return None
    x, y = centre[i] + low * axis[i], centre[j] + low * axis[j]
    u, v = centre[i] + high * axis[i], centre[j] + high * axis[j]
    at_low, at_high = abs(x) > sizes[i] and abs(y) > sizes[j], abs(u) > sizes[i] and abs(v) > sizes[j]
    if not (at_low or at_high) or x * u < 0.0 or y * v < 0.0:
        return None
    found: list[LineContact] = []
    for t, is_own in ((low, low == -half), (high, high == half)):
        one = _point_contact(rod, sizes, k, t, radius, at_own_end=is_own)
        if one is None:
            return None
        found.append(one)
    least = min(found[0].distance, found[1].distance)
    t = _nearest(rod, (math.copysign(sizes[i], x), math.copysign(sizes[j], y)), k)
    if low < t < high:
        one = _point_contact(rod, sizes, k, t, radius)
        if one is not None and one.distance < least - _CROSSING:
            found.append(one)
            least = one.distance
    return found if -least < high - low else None


def _point_contact(
    rod: Rod, sizes: Vector, k: int, t: float, radius: float, *, at_own_end: bool = False
) -> LineContact | None:
    """Return the contact of a box with the circle around a point of a cylinder's axis; None if the point is inside.

    Args:
        rod: cylinder in the frame of the box.
        sizes: half the lengths of the box.
        k: number of the coordinate along the nearest edge.
        t: place on the axis [m].
        radius: radius [m].
        at_own_end: True for the rim of the cylinder.
    """
    i, j = (k + 1) % 3, (k + 2) % 3
    centre, axis = rod.centre, rod.axis
    point = [centre[n] + t * axis[n] for n in range(3)]
    x, y = abs(point[i]) - sizes[i], abs(point[j]) - sizes[j]
    if x <= 0.0 and y <= 0.0:
        return None
    if x > 0.0 and y > 0.0:
        size = math.sqrt(x * x + y * y)
        x, y = x / size, y / size
    else:
        size, x, y = (x, 1.0, 0.0) if x > y else (y, 0.0, 1.0)
    outwards = [0.0, 0.0, 0.0]
    outwards[i], outwards[j] = math.copysign(x, point[i]), math.copysign(y, point[j])
    tilt = outwards[i] * axis[i] + outwards[j] * axis[j]
    cosine = math.sqrt(1.0 - tilt * tilt)
    reach = radius * cosine if at_own_end else radius / cosine
    distance = size - reach
    a, b, c = (point[n] - outwards[n] * (reach + distance / 2.0) for n in range(3))
    return LineContact(distance, (a, b, c), (-outwards[0], -outwards[1], -outwards[2]))
