"""Contacts along lines: cylinders and capsules with nearly parallel axes, and cylinders on the edges of boxes.

MuJoCo reports one contact for two parallel cylinders, anywhere on their common line. From step to step it jumps, so
that a pile of logs never rests. At the edge of a box, MuJoCo reports the normal of a side face for a cylinder, up to
90° wrong. The functions of this module compute these contacts exactly: one at each end of the common length, and one
where the axes cross if the bodies are nearest there.

All points and vectors are in one frame. Lengths are in metres.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from typing import Final, NamedTuple

PARALLEL: Final = math.cos(math.radians(2.0))
"""Least cosine between nearly parallel directions. At larger angles, bodies meet in one point."""

_MIN_LENGTH: Final = 0.02
"""Least common length in units of the radii; at a shorter one, the bodies may touch with their caps."""

_MOST_OVERLAP: Final = 0.5
"""Largest penetration in units of the radii; deeper than that, the normal depends on small errors."""

_CROSSING: Final = 1e-6
"""Least additional depth [m] of the point where two axes cross; without it, that point jumps for parallel axes."""

_WRONG_NORMAL: Final = 0.9995
"""Cosine of the least error of a normal (1.8°) at an edge that is oblique to the axis."""

_NEWTON_STEPS: Final = 4

_ALONG_EDGE: Final = 0.9
"""Least cosine between an axis and an edge that a cylinder rolls over."""

_SQUARE_OF_CROSSING: Final = 1e-10
"""Square of the least angle between axes that cross, so that the crossing is well determined."""

Vector = tuple[float, float, float]
Frame = tuple[float, float, float, float, float, float, float, float, float]


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


LineContact = tuple[float, Vector, Frame]
"""Contact point of two bodies.

- Distance of the surfaces [m]; negative for a penetration.
- Point half way between the surfaces.
- Unit vector from the first body to the second one, and two tangents.
"""


def rod_contacts(rod: Rod, other: Rod) -> list[LineContact] | None:
    """Return the contacts of two rods with nearly parallel axes; None if the axes or the common length differ too much.

    Args:
        rod: first rod.
        other: second rod.
    """
    (p, q, r), (a, b, c), radius, half, _ = rod
    (u, v, w), (d, e, f), other_radius, other_half, _ = other
    cosine = a * d + b * e + c * f
    if -PARALLEL < cosine < PARALLEL:
        return None
    x, y, z = u - p, v - q, w - r
    middle, span = x * a + y * b + z * c, other_half * abs(cosine)
    low, high = max(-half, middle - span), min(half, middle + span)
    if high - low < _MIN_LENGTH * (radius + other_radius):
        return None
    contacts: list[LineContact] = []
    for sign in (-1.0, 1.0):
        if half <= span + sign * middle:  # the first rod ends here
            t = sign * half
            contacts.append(_end_contact((p + t * a, q + t * b, r + t * c), rod, other, 1.0))
        else:
            t = sign * other_half if cosine > 0.0 else -sign * other_half
            contacts.append(_end_contact((u + t * d, v + t * e, w + t * f), other, rod, -1.0))
    least, square = min(contacts[0][0], contacts[1][0]), 1.0 - cosine * cosine
    if square > _SQUARE_OF_CROSSING:
        along, across = middle, x * d + y * e + z * f
        t, s = (along - cosine * across) / square, (cosine * along - across) / square
        if low < t < high and -other_half < s < other_half:
            crossing = _end_contact((p + t * a, q + t * b, r + t * c), rod, other, 1.0)
            if crossing[0] < least - _CROSSING:
                contacts.append(crossing)
                least = crossing[0]
    return contacts if -least < min(high - low, _MOST_OVERLAP * (radius + other_radius)) else None


def _end_contact(end: Vector, rod: Rod, other: Rod, sign: float) -> LineContact:
    """Return the contact between the rim around a point of a rod's axis and the side of another rod.

    Args:
        end: point on the axis.
        rod: rod of the point.
        other: rod whose side is touched.
        sign: -1 to reverse the normal.
    """
    p, q, r = end
    (u, v, w), (d, e, f), side, _, _ = other
    s = (p - u) * d + (q - v) * e + (r - w) * f
    u, v, w = u + s * d, v + s * e, w + s * f
    x, y, z = u - p, v - q, w - r
    size = max(math.sqrt(x * x + y * y + z * z), 1e-12)
    x, y, z = x / size, y / size, z / size
    _, (a, b, c), radius, _, has_balls = rod
    if not has_balls:
        tilt = a * x + b * y + c * z
        radius *= math.sqrt(max(0.0, 1.0 - tilt * tilt))
    distance = size - side - radius
    reach = side + distance / 2.0
    point = u - reach * x, v - reach * y, w - reach * z
    x, y, z = sign * x, sign * y, sign * z
    return distance, point, (x, y, z, d, e, f, y * f - z * e, z * d - x * f, x * e - y * d)


def is_near_edge(rod: Rod, sizes: Sequence[float], reach: float) -> bool:
    """Check whether a cylinder lies on a face of a box and within a distance of an edge along its axis.

    Args:
        rod: cylinder in the frame of the box.
        sizes: half the lengths of the box.
        reach: distance [m].
    """
    centre, axis, _, half, _ = rod
    k = longest_coordinate(axis)
    i, j = (k + 1) % 3, (k + 2) % 3
    if abs(axis[k]) < _ALONG_EDGE:
        return False
    n = i if abs(centre[i]) - sizes[i] < abs(centre[j]) - sizes[j] else j  # across the axis, on the face
    return abs(abs(centre[n]) - sizes[n]) < reach + half * abs(axis[n])


EdgeContact = tuple[float, Vector, Vector]
"""Contact point with an edge of a box, in the frame of the box: distance, position and normal as in `LineContact`."""


def longest_coordinate(vector: Vector) -> int:
    """Return the number of the coordinate with the largest amount."""
    a, b, c = abs(vector[0]), abs(vector[1]), abs(vector[2])
    return 0 if a > b and a > c else 1 if b > c else 2


def oblique_edge_contact(
    rod: Rod, sizes: Sequence[float], place: Vector, normals: list[Vector]
) -> tuple[int, EdgeContact] | None:
    """Return the contact of a cylinder with an edge of a box that is not parallel to its axis.

    Args:
        rod: cylinder in the frame of the box.
        sizes: half the lengths of the box.
        place: position of one of the engine's contacts.
        normals: normals of the engine's contacts.

    Returns:
        Number of the coordinate along the edge, and the contact. None if another part of the box or an end of the
        cylinder is nearer, or if the engine's normals are right.
    """
    centre, axis, half = rod.centre, rod.axis, rod.half
    candidates = []
    k = longest_coordinate(axis)
    if abs(axis[k]) >= _ALONG_EDGE:  # the engine's contact may be far from the edge
        t = max(-half, min(half, -centre[k] / axis[k]))
        candidates.append((k, (centre[0] + t * axis[0], centre[1] + t * axis[1], centre[2] + t * axis[2])))
    candidates.append((max((sizes[n] - abs(place[n]), n) for n in range(3))[1], place))
    for k, near in candidates:
        contact = _edge_contact(rod, sizes, k, near)
        if contact is not None:
            return None if all(_product(normal, contact[2]) > _WRONG_NORMAL for normal in normals) else (k, contact)
    return None


def _edge_contact(rod: Rod, sizes: Sequence[float], k: int, place: Vector) -> EdgeContact | None:
    """Return the contact of a cylinder with an edge of a box; None if the edge is not the nearest part of the box.

    Args:
        rod: cylinder in the frame of the box.
        sizes: half the lengths of the box.
        k: number of the coordinate along the edge.
        place: point on the side of the edge.
    """
    centre, axis, radius, half, _ = rod
    i, j = (k + 1) % 3, (k + 2) % 3
    side, other = math.copysign(1.0, place[i]), math.copysign(1.0, place[j])
    t = max(-half, min(half, _nearest(rod, k, side * sizes[i], other * sizes[j])))
    x, y = side * (centre[i] + t * axis[i]) - sizes[i], other * (centre[j] + t * axis[j]) - sizes[j]
    a, b = side * axis[i], other * axis[j]
    if x <= 0.0 or y <= 0.0:
        return None
    x, y, distance = _farthest_direction(x, y, a, b, radius)
    tilt = x * a + y * b
    along = centre[k] + t * axis[k] + radius * tilt / math.sqrt(1.0 - tilt * tilt) * axis[k]
    outwards, corner = [0.0, 0.0, 0.0], [0.0, 0.0, 0.0]
    outwards[i], outwards[j] = side * x, other * y
    corner[i], corner[j], corner[k] = side * sizes[i], other * sizes[j], max(-sizes[k], min(sizes[k], along))
    if corner[k] != along:  # beyond the end of the edge
        t = _product((corner[0] - centre[0], corner[1] - centre[1], corner[2] - centre[2]), axis)
        outwards = [centre[n] + t * axis[n] - corner[n] for n in range(3)]
        size = math.sqrt(outwards[0] * outwards[0] + outwards[1] * outwards[1] + outwards[2] * outwards[2])
        if not -half < t < half or size <= 0.0:
            return None
        outwards, distance = [value / size for value in outwards], size - radius
    if outwards[i] * side <= 0.0 or outwards[j] * other <= 0.0 or -distance > _MOST_OVERLAP * radius:
        return None
    normal = (-outwards[0], -outwards[1], -outwards[2])
    reach = distance / 2.0  # half way between the edge and the deepest point of the cylinder
    position = corner[0] + reach * outwards[0], corner[1] + reach * outwards[1], corner[2] + reach * outwards[2]
    return distance, position, normal


def _farthest_direction(x: float, y: float, a: float, b: float, radius: float) -> tuple[float, float, float]:
    """Return the direction from an edge in which a disc is farthest, and its distance [m].

    The direction is that of the shortest way to separate both. The distance along a unit vector n is n·p - r sqrt(1 -
    (n·v)²), for the centre p and the axis v of the disc. Newton's method finds the maximum.

    Args:
        x: first coordinate of the centre across the edge [m].
        y: second coordinate of the centre across the edge [m].
        a: first coordinate of the axis across the edge.
        b: second coordinate of the axis across the edge.
        radius: radius of the disc [m].
    """
    size = math.sqrt(x * x + y * y)
    u, v = x / size, y / size
    for _ in range(_NEWTON_STEPS):
        tilt, change = u * a + v * b, u * b - v * a
        root = math.sqrt(max(1.0 - tilt * tilt, 1e-6))
        slope = u * y - v * x + radius * tilt * change / root
        bend = -(u * x + v * y) + radius * ((change * change - tilt * tilt) / root + (tilt * change / root) ** 2 / root)
        if bend >= 0.0:
            break
        turn = -slope / bend
        u, v = u - turn * v, v + turn * u
        size = math.sqrt(u * u + v * v)
        u, v = u / size, v / size
    tilt = u * a + v * b
    return u, v, u * x + v * y - radius * math.sqrt(1.0 - tilt * tilt)


def _product(first: Vector, other: Vector) -> float:
    """Return the scalar product of two vectors."""
    return first[0] * other[0] + first[1] * other[1] + first[2] * other[2]


def _nearest(rod: Rod, k: int, x: float, y: float) -> float:
    """Return the place along the axis of a rod that is nearest to an edge [m]; infinity if both are parallel.

    Args:
        rod: rod in the frame of a box.
        k: number of the coordinate along the edge.
        x: the next coordinate of the edge.
        y: the coordinate of the edge after that.
    """
    i, j = (k + 1) % 3, (k + 2) % 3
    centre, axis = rod.centre, rod.axis
    square = axis[i] * axis[i] + axis[j] * axis[j]
    if square < _SQUARE_OF_CROSSING:
        return math.inf
    return ((x - centre[i]) * axis[i] + (y - centre[j]) * axis[j]) / square


def common_length(rod: Rod, size: float, k: int) -> tuple[float, float]:
    """Return the part of a rod's axis that lies within a box along one coordinate, from the centre of the rod [m].

    Args:
        rod: rod in the frame of the box.
        size: half the length of the box.
        k: number of the coordinate, along which the axis points.
    """
    enter, other = (-size - rod.centre[k]) / rod.axis[k], (size - rod.centre[k]) / rod.axis[k]
    return max(-rod.half, min(enter, other)), min(rod.half, max(enter, other))


def parallel_edge_contacts(rod: Rod, sizes: Sequence[float], k: int) -> list[EdgeContact] | None:
    """Return the contacts of a cylinder with an edge of a box that is nearly parallel to its axis.

    Args:
        rod: cylinder in the frame of the box.
        sizes: half the lengths of the box.
        k: number of the coordinate along the edge.

    Returns:
        One contact at each end of the common length, and one where the axis crosses the edge, if it is the deepest.
        None if a face of the box or an end of the cylinder is nearer.
    """
    i, j = (k + 1) % 3, (k + 2) % 3
    centre, axis, radius, half, _ = rod
    low, high = common_length(rod, sizes[k], k)
    if high - low < _MIN_LENGTH * radius:
        return None
    x, y = centre[i] + low * axis[i], centre[j] + low * axis[j]
    u, v = centre[i] + high * axis[i], centre[j] + high * axis[j]
    is_low, is_high = abs(x) > sizes[i] and abs(y) > sizes[j], abs(u) > sizes[i] and abs(v) > sizes[j]
    if not (is_low or is_high) or x * u < 0.0 or y * v < 0.0:
        return None
    contacts: list[EdgeContact] = []
    for t, is_rim in ((low, low == -half), (high, high == half)):
        contact = _point_contact(rod, sizes, k, t, is_rim)
        if contact is None:
            return None
        contacts.append(contact)
    least = min(contacts[0][0], contacts[1][0])
    t = _nearest(rod, k, math.copysign(sizes[i], x), math.copysign(sizes[j], y))
    if low < t < high:
        contact = _point_contact(rod, sizes, k, t, True)
        if contact is not None and contact[0] < least - _CROSSING:
            contacts.append(contact)
            least = contact[0]
    return contacts if -least < min(high - low, _MOST_OVERLAP * radius) else None


def _point_contact(rod: Rod, sizes: Sequence[float], k: int, t: float, is_rim: bool) -> EdgeContact | None:
    """Return the contact of a box with the section of a cylinder around a point of its axis.

    Args:
        rod: cylinder in the frame of the box.
        sizes: half the lengths of the box.
        k: number of the coordinate along the nearest edge.
        t: place of the point on the axis [m].
        is_rim: True for a section across the cylinder, False for one across the edge.

    Returns:
        The contact; None if the point is inside the box.
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
    elif x > y:
        size, x, y = x, 1.0, 0.0
    else:
        size, x, y = y, 0.0, 1.0
    normal = [0.0, 0.0, 0.0]  # from the cylinder to the box
    normal[i], normal[j] = -math.copysign(x, point[i]), -math.copysign(y, point[j])
    tilt = normal[i] * axis[i] + normal[j] * axis[j]
    cosine = math.sqrt(1.0 - tilt * tilt)
    reach = rod.radius * cosine if is_rim else rod.radius / cosine
    distance = size - reach
    reach += distance / 2.0
    place = point[0] + reach * normal[0], point[1] + reach * normal[1], point[2] + reach * normal[2]
    return distance, place, (normal[0], normal[1], normal[2])
