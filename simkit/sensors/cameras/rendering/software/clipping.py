"""Clipping of triangles at the near plane and around the image.

OpenCV's rasteriser clips nothing. A triangle that reaches behind the camera would fill the image, and rounding opens
pixels along the edges of a triangle that is much larger than the image.
"""

from __future__ import annotations

from typing import Final

import numpy as np
import numpy.typing as npt

from simkit.sensors.cameras.rendering.software.frame import Frame
from simkit.sensors.cameras.rendering.software.vectors import Array, Floats, Integers

_MARGIN: Final = 1.5
"""Size of the frustum at which triangles are cut, relative to the frustum of the image."""


def clip(frame: Frame, points: Floats, values: Floats, faces: Integers) -> tuple[Integers, Floats, Floats, Integers]:
    """Clip triangles at the near plane and at a frustum around the image.

    Args:
        frame: pose and frustum of the image.
        points: corners relative to the frame's origin [m], shape (n, 3).
        values: values at the corners, which are interpolated, shape (n, k).
        faces: triangles, shape (m, 3).

    Returns:
        Faces that stay whole; new corners with their values; for each three new corners the number of their face in
        `faces`, shape (j,).
    """
    corners, across, along, ahead = _places(frame, points, faces)
    seen = np.flatnonzero(_are_inside(frame, across, along, ahead, corners, len(points), faces))
    bits = _bits(frame, across, along, ahead, _MARGIN, corners, len(points))
    a, b, c = (bits.take(faces[seen, k]) for k in range(3))
    crosses = (a | b | c) != 0
    uncut_faces, cut = faces[seen[~crosses]], seen[crosses]
    place = np.zeros(len(points), np.intp)
    place[corners] = np.arange(len(corners))
    rows = place[faces[cut]]
    in_camera = np.stack((across, along, ahead), axis=-1)
    numbers = np.broadcast_to(cut[:, None, None].astype(np.float64), (len(cut), 3, 1))
    data = np.concatenate((in_camera[rows], values[faces[cut]].astype(np.float64), numbers), axis=2)
    for plane in range(5):
        if not len(data):
            break
        flat = data.reshape(-1, data.shape[2])
        away = _distances(frame, flat[:, 0], flat[:, 1], flat[:, 2], _MARGIN)[plane]
        data = _cut(data, away.reshape(-1, 3))
    flat = data.reshape(-1, data.shape[2])
    middle = _middle(frame)
    new_points = frame.from_camera(flat[:, 0] + middle[0] * flat[:, 2], flat[:, 1] + middle[1] * flat[:, 2], flat[:, 2])
    sources: Integers = np.rint(flat[::3, -1]).astype(np.int32)
    return uncut_faces, new_points, flat[:, 3:-1].astype(np.float32), sources


def are_in_view(frame: Frame, points: Floats, faces: Integers) -> npt.NDArray[np.bool_]:
    """Return True for each face that is not outside of the image, and that `clip` therefore keeps, shape (m,)."""
    corners, across, along, ahead = _places(frame, points, faces)
    return _are_inside(frame, across, along, ahead, corners, len(points), faces)


def _middle(frame: Frame) -> tuple[float, float]:
    """Return the tangents of the middle of the image."""
    return frame.view.left + frame.half[0], frame.view.bottom + frame.half[1]


def _places(frame: Frame, points: Floats, faces: Integers) -> tuple[Array, Array, Array, Array]:
    """Return the corners of faces, and their coordinates relative to the axis through the middle of the image [m]."""
    used = np.zeros(len(points), bool)
    used[faces.ravel()] = True
    corners = np.flatnonzero(used)
    right, up, ahead = frame.in_camera(points[corners])
    middle = _middle(frame)
    return corners, right - middle[0] * ahead, up - middle[1] * ahead, ahead


def _are_inside(
    frame: Frame, across: Array, along: Array, ahead: Array, corners: Array, count: int, faces: Integers
) -> npt.NDArray[np.bool_]:
    """Return False for each face whose corners are all outside of the same plane of the frustum."""
    bits = _bits(frame, across, along, ahead, 1.0, corners, count)  # one bit for each plane a corner is outside of
    a, b, c = (bits.take(faces[:, k]) for k in range(3))
    inside: npt.NDArray[np.bool_] = (a & b & c) == 0
    return inside


def _distances(frame: Frame, right: Array, up: Array, ahead: Array, margin: float) -> tuple[Array, ...]:
    """Return how far points are inside the near plane and the four sides of a frustum, shape (n,) each."""
    wide, high = margin * frame.half[0] * ahead, margin * frame.half[1] * ahead
    return ahead - frame.view.near, wide + right, wide - right, high + up, high - up


def _bits(
    frame: Frame, right: Array, up: Array, ahead: Array, margin: float, corners: Array, count: int
) -> npt.NDArray[np.uint8]:
    """Return one bit for each plane that a corner is outside of, shape (count,); 0 for corners without a face."""
    bits = np.zeros(len(corners), np.uint8)
    for plane, distance in enumerate(_distances(frame, right, up, ahead, margin)):
        bits |= (distance < 0.0).astype(np.uint8) << np.uint8(plane)
    bits_of_corners = np.zeros(count, np.uint8)
    bits_of_corners[corners] = bits
    return bits_of_corners


def _cut(data: Array, away: Array) -> Array:
    """Return the parts of triangles (m, 3, k) at non-negative distances (m, 3)."""
    inside = away >= 0.0
    count = inside.sum(axis=1)
    parts = [data[count == 3]]
    for inner in (1, 2):
        chosen = np.flatnonzero(count == inner)
        if not len(chosen):
            continue
        # the first corner is the only one on its side
        first = (inside[chosen] if inner == 1 else ~inside[chosen]).argmax(axis=1)
        order = (first[:, None] + np.arange(3)) % 3
        row = chosen[:, None]
        (a, b, c), (da, db, dc) = np.moveaxis(data[row, order], 1, 0), away[row, order].T
        if inner == 1:
            parts.append(np.stack((a, _between(a, b, da, db), _between(a, c, da, dc)), axis=1))
        else:
            on_b, on_c = _between(b, a, db, da), _between(c, a, dc, da)
            parts.append(np.stack((on_b, b, c), axis=1))
            parts.append(np.stack((on_b, c, on_c), axis=1))
    return np.concatenate(parts)


def _between(inner: Array, outer: Array, inner_distance: Array, outer_distance: Array) -> Array:
    """Return the points at distance 0 between inner and outer corners; always in this direction, for equal bits."""
    share = inner_distance / (inner_distance - outer_distance)
    point: Array = inner + share[:, None] * (outer - inner)
    return point
