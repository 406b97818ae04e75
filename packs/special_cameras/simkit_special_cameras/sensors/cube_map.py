"""Image of all directions, assembled from the faces of a cube around the camera."""

from __future__ import annotations

import math
from collections.abc import Iterator
from dataclasses import dataclass

import numpy as np
import numpy.typing as npt

from simkit.extend import Vector
from simkit.float_sum import float_sum
from simkit.linear_algebra import matmul
from simkit.sensors.cameras.rendering.view import Colours, DrawnView, Shot, View
from simkit_special_cameras.sensors.wide_angle_lens import WideAngleModel

_FORWARD, _LEFT, _UP = np.eye(3)
_FACES = tuple(
    np.stack((forward, left, np.cross(forward, left)), axis=1)
    for forward, left in (
        (_FORWARD, _LEFT), (_LEFT, -_FORWARD), (-_LEFT, _FORWARD), (_UP, _LEFT), (-_UP, _LEFT), (-_FORWARD, -_LEFT),
    )
)  # fmt: skip
"""Frames (x forward, y left, z up) of the faces in the camera frame, shape (3, 3) each; the front face is first."""

_ONE_FACE = 1.75  # tangent of the angle off the axis up to which a single image is cheaper than several
_MOST_TIMES = 4.0  # largest ratio of the pixels of all faces to those of the image
_MOST_PIXELS = 4096  # largest edge of a face [px]
_FINEST = 0.2  # quantile of the pixel density: this part of the image may be finer than the faces
_RIM = 0.02  # [half widths] width over which Gazebo's image fades to black at the cutoff angle


@dataclass(frozen=True, slots=True)
class _Face:
    """Part of a face: the pixels of the image that it provides, and its pixels per unit of tangent."""

    rotation: Vector
    pixels: npt.NDArray[np.bool_]
    right: Vector
    down: Vector
    scale: float


class CubeMap:
    """Image of a wide lens, drawn from the faces of a cube.

    Only the visible parts of the faces are drawn. Each part is drawn with a margin of two pixels, so that no pixel is
    interpolated across the border of two faces.

    Args:
        model: model of the camera.
    """

    def __init__(self, model: WideAngleModel) -> None:
        x, y = model.offsets()
        radius = np.hypot(x, y)
        angle = model.lens.angle(radius)
        known = np.isfinite(angle) & (angle <= model.lens.cutoff)
        along = np.where(known, np.cos(angle, where=known, out=np.zeros_like(angle)), -1.0)
        across = np.where(known, np.sin(angle, where=known, out=np.zeros_like(angle)), 0.0)
        across /= np.maximum(radius, 1e-12)
        directions = np.stack((along, -across * x, -across * y), axis=-1)  # x forward, y left, z up
        faces = _faces(directions, known, model)
        self._is_full = bool(known.all())
        self._lay_out(faces, x.shape, model)
        self._rim = _cutoff_fade(radius, known, model)

    def _lay_out(self, faces: list[_Face], shape: tuple[int, ...], model: WideAngleModel) -> None:
        """Arrange the faces one below the other on a sheet, so that one lookup covers all of them."""
        import cv2

        column, row = (np.full(shape, -100.0, np.float32) for _ in range(2))
        self.shots: list[Shot] = []
        self._places: list[tuple[int, int, int]] = []
        first = widest = 0
        for face in faces:
            (left, width), (top, height) = (_pixel_bounds(values, face.scale) for values in (face.right, face.down))
            column[face.pixels] = (face.right - left) * face.scale - 0.5
            row[face.pixels] = (face.down - top) * face.scale - 0.5 + first
            right, bottom = left + width / face.scale, top + height / face.scale
            view = View(width, height, left, right, -bottom, -top, model.near, model.far)
            self.shots.append(Shot(view, rotation=face.rotation))
            self._places.append((first, height, width))
            first, widest = first + height, max(widest, width)
        self._sheet = np.zeros((max(first, 1), max(widest, 1), 3), np.uint8)
        self._maps = cv2.convertMaps(column, row, cv2.CV_16SC2)

    def assemble(self, drawn_views: Iterator[DrawnView], out: Colours) -> Colours:
        """Return the image, shape (height, width, 3); black where the lens shows nothing.

        Args:
            drawn_views: one drawn view of each of `shots`, in their order.
            out: contiguous output array.
        """
        import cv2

        for drawn_view, (first, height, width) in zip(drawn_views, self._places, strict=True):
            assert drawn_view.colours is not None
            np.copyto(self._sheet[first : first + height, :width], drawn_view.colours)
        border = cv2.BORDER_REPLICATE if self._is_full else cv2.BORDER_CONSTANT
        cv2.remap(self._sheet, *self._maps, cv2.INTER_LINEAR, dst=out, borderMode=border)
        if self._rim is not None:
            rows, weights = self._rim
            part = out[rows]
            cv2.multiply(part, weights[rows], dst=part, scale=1 / 255)
        return out


def _faces(directions: Vector, known: npt.NDArray[np.bool_], model: WideAngleModel) -> list[_Face]:
    """Return the faces of the cube with the pixels of the image that they provide."""
    in_front = known & (directions[..., 0] > 0)
    steepest = np.abs(directions[known][:, 1:]).max(axis=1) <= _ONE_FACE * directions[known][:, 0]
    if (in_front == known).all() and steepest.all():
        owner = np.where(known, 0, -1)
    else:
        along = np.stack([matmul(directions, rotation[:, 0]) for rotation in _FACES])
        owner = np.where(known, along.argmax(axis=0), -1)
    faces = [_face(rotation, owner == i, directions, model) for i, rotation in enumerate(_FACES) if (owner == i).any()]
    if not faces:  # a lens that shows nothing in the middle of any pixel
        return []
    drawn = float_sum(np.ptp(face.right) * np.ptp(face.down) * face.scale**2 for face in faces)
    shrink = 1.0 if model.face_size else min(1.0, math.sqrt(_MOST_TIMES * known.size / max(drawn, 1.0)))
    return [_Face(f.rotation, f.pixels, f.right, f.down, f.scale * shrink) for f in faces]


def _face(rotation: Vector, pixels: npt.NDArray[np.bool_], directions: Vector, model: WideAngleModel) -> _Face:
    ahead, left, up = matmul(directions[pixels], rotation).T
    right, down = -left / ahead, -up / ahead
    extent = max(np.abs(right).max(), np.abs(down).max(), 1e-6)
    scale = model.face_size / 2 if model.face_size else _pixel_density(right, down, pixels)
    return _Face(rotation, pixels, right, down, min(scale, (_MOST_PIXELS - 8) / (2 * extent)))


def _pixel_density(right: Vector, down: Vector, pixels: npt.NDArray[np.bool_]) -> float:
    """Return the pixels per unit of tangent that a face needs for the resolution of nearly all image pixels."""
    number = np.full(pixels.shape, -1, np.int32)
    number[pixels] = np.arange(len(right))
    steps = []
    every = max(1, max(pixels.shape) // 200)  # a regular subset of the pixels is sufficient
    for current, following in ((number[:, :-1], number[:, 1:]), (number[:-1], number[1:])):
        current, following = current[::every, ::every], following[::every, ::every]
        both = (current >= 0) & (following >= 0)
        i, j = current[both], following[both]
        steps.append(np.hypot(right[j] - right[i], down[j] - down[i]))
    step = np.concatenate(steps)
    step = step[step > 1e-9]
    return float(1 / np.quantile(step, _FINEST)) if len(step) else 8.0


def _pixel_bounds(values: Vector, scale: float) -> tuple[float, int]:
    """Return the first pixel of a part of a face, two pixels before the lowest value, and the number of its pixels."""
    low, high = float(values.min()) - 2 / scale, float(values.max()) + 2 / scale
    return low, math.ceil((high - low) * scale)


def _cutoff_fade(
    radius: Vector, known: npt.NDArray[np.bool_], model: WideAngleModel
) -> tuple[slice, npt.NDArray[np.uint8]] | None:
    """Return the rows that fade at the cutoff angle and their weights [1/255]; None if no row fades."""
    lens = model.lens
    if lens.cutoff > lens.widest:
        return None
    end = float(lens.radius(np.array(lens.cutoff)))
    part = np.clip((radius - (end - _RIM)) / _RIM, 0.0, 1.0)
    weight = np.rint(255 * (1 - part * part * (3 - 2 * part))).astype(np.uint8)
    faded = np.flatnonzero(((weight < 255) & known).any(axis=1))
    if not len(faded):
        return None
    return slice(int(faded[0]), int(faded[-1]) + 1), np.repeat(weight[..., None], 3, axis=2)
