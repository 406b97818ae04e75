"""Shutter of a camera: the times at which the rows of an image collect light.

An image with a shutter is the mean of several pictures of the moving scene, in linear light. The pictures divide the
time from the beginning of the first row's exposure to the end of the last row's into equal intervals, and each is drawn
in the middle of its interval. The light of a pixel is thus wrong in time by at most half an interval.
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass, replace
from typing import NamedTuple

import mujoco
import numpy as np
import numpy.typing as npt

from simkit.params import Params
from simkit.pose import Vector
from simkit.runtime.engine.pose_history import PoseRows
from simkit.sensors.cameras.image_noise import CameraReading
from simkit.sensors.cameras.tone_curve import colour_table, light_table
from simkit.sensors.rays.sweep_poses import SweepPoses
from simkit.sensors.sample import Memory

GLOBAL, ROLLING = "global", "rolling"
DOWN, UP = "down", "up"
_STRIP = 16  # rows
_WHOLE = 1 << 16  # sum of the weights of the pictures in a row
_MAX_SUB_FRAMES = 2000
_STILL = 1e-6  # bodies that move by less [m], or turn by less than twice this angle [rad], do not change an image

Pictures = tuple[CameraReading, ...]


@dataclass(frozen=True, slots=True)
class Shutter:
    """The `<shutter>` of a camera.

    Attributes:
        is_rolling: True if the rows are exposed one after another.
        line_time: time from the beginning of a row's exposure to that of the next row [s]; 0 for a global shutter.
        exposure: time in which a row collects light [s].
        sub_frames: number of pictures that are drawn for an image of a moving scene.
        is_upward: True if the rows are read from the bottom of the image to its top.
    """

    is_rolling: bool
    line_time: float
    exposure: float
    sub_frames: int
    is_upward: bool

    def duration(self, height: int) -> float:
        """Return the time [s] from the beginning of the first row's exposure to the end of the last row's."""
        return self.line_time * (height - 1) + self.exposure

    def weights(self, height: int, duration: float) -> npt.NDArray[np.uint32]:
        """Return the weight of each picture in each row, shape (sub_frames, height); the sum in a row is 65536.

        Args:
            height: number of rows.
            duration: time of all pictures [s].
        """
        rows = np.arange(float(height))
        starts = (rows[::-1] if self.is_upward else rows) * self.line_time
        ends = np.arange(self.sub_frames + 1.0)[:, None] * (duration / self.sub_frames)
        if self.exposure > 0:
            shares = np.clip((ends - starts) / self.exposure, 0.0, 1.0)
        else:
            shares = (ends > starts).astype(np.float64)  # each row is in one picture
        shares[0], shares[-1] = 0.0, 1.0
        return np.diff(np.rint(shares * _WHOLE), axis=0).astype(np.uint32)


def read_shutter(params: Params, height: int, rate: float) -> Shutter | None:
    """Read the `<shutter>` of a `<sensor>`; None if all rows collect light at one instant.

    Args:
        params: the `<sensor>`.
        height: number of rows of its images.
        rate: update rate [Hz].
    """
    block = params.child("shutter")
    if block is None:
        return None
    is_rolling = block.choice("type", (GLOBAL, ROLLING), GLOBAL) == ROLLING
    line_time, exposure = (block.number(name, 0.0, minimum=0.0, maximum=1.0) for name in ("line_time", "exposure"))
    sub_frames = block.integer("sub_frames", 8, minimum=1, maximum=_MAX_SUB_FRAMES)
    is_upward = block.choice("direction", (DOWN, UP), DOWN) == UP
    if is_rolling != (line_time > 0):
        found = "a rolling shutter without a <line_time>" if is_rolling else "a <line_time> of a global shutter"
        help_ = "write <type>rolling</type>, and a <line_time> in seconds"
        block.warning("SK-SENSOR-240", f"{found} has no effect: all rows begin together", help_)
    shutter = Shutter(is_rolling, line_time if is_rolling else 0.0, exposure, sub_frames, is_upward)
    if not shutter.duration(height) > 0:
        return None
    problem = rate_problem(shutter, height, rate)
    if problem:
        block.error("SK-SENSOR-239", f"{problem}, at {rate:g} Hz", "a shorter time, or another <update_rate>")
        return None
    return shutter


def rate_problem(shutter: Shutter, height: int, rate: float) -> str:
    """Return what is wrong with a shutter at an update rate [Hz]; empty if nothing is."""
    if not rate > 0:
        return "a <shutter> needs a period of the images, and the sensor samples at every step"
    readout = shutter.line_time * (height - 1)
    if max(shutter.exposure, readout) * rate > 1.0 + 1e-9:
        name = "exposure" if shutter.exposure > readout else "readout"
        return f"the {name} takes {max(shutter.exposure, readout):g} s, longer than the period of the images"
    return ""


class Exposure(NamedTuple):
    """Exposure of an image that has ended.

    Attributes:
        surroundings: state besides the physics, see `RenderedSampler.capture_surroundings`, and lights.
        rows: poses of all bodies from the first tick to the last.
        start: tick of the time stamp.
    """

    surroundings: Memory
    lights: Memory
    rows: PoseRows
    start: int

    def is_still(self) -> bool:
        """Check whether nothing moves in the image."""
        return all(bool((np.abs(values - values[-1]) <= _STILL).all()) for values in self.rows.arrays())


def moving_data(
    model: mujoco.MjModel, data: mujoco.MjData, exposure: Exposure, times: Vector, timestep: float
) -> Iterator[mujoco.MjData]:
    """Move the bodies, shapes and lights of `data` to their poses at some times after the stamp [s], one by one."""
    poses, bodies = SweepPoses(exposure.rows, exposure.start, timestep), np.arange(model.nbody)
    for time in times.tolist():
        found = poses.at(bodies, np.full(model.nbody, time))
        place_bodies(model, data, np.ascontiguousarray(found.positions.T), np.ascontiguousarray(found.quaternions.T))
        yield data


def place_bodies(model: mujoco.MjModel, data: mujoco.MjData, positions: Vector, quaternions: Vector) -> None:
    """Set what cameras see of the bodies to poses in the world, without a forward pass.

    Args:
        model: compiled model.
        data: data that is changed; its joints stay as they are.
        positions: positions of all bodies [m], shape (nbody, 3).
        quaternions: orientations of all bodies (w, x, y, z), shape (nbody, 4).
    """
    rotations = _rotations(quaternions)
    data.xpos[:], data.xquat[:], data.xmat[:] = positions, quaternions, rotations.reshape(-1, 9)
    owner = model.geom_bodyid
    frames, offsets = rotations[owner], model.geom_pos
    places = positions[owner]
    for axis in range(3):
        places = places + frames[:, :, axis] * offsets[:, axis, None]
    data.geom_xpos[:] = places
    data.geom_xmat[:] = _products(frames, _rotations(model.geom_quat)).reshape(-1, 9)
    mujoco.mj_camlight(model, data)
    if model.nflex:
        mujoco.mj_flex(model, data)


def _rotations(quaternions: Vector) -> Vector:
    """Return the rotation matrices, shape (n, 3, 3), of unit quaternions, shape (n, 4)."""
    w, x, y, z = quaternions.T
    rows = (
        (w * w + x * x - y * y - z * z, 2 * (x * y - w * z), 2 * (x * z + w * y)),
        (2 * (x * y + w * z), w * w - x * x + y * y - z * z, 2 * (y * z - w * x)),
        (2 * (x * z - w * y), 2 * (y * z + w * x), w * w - x * x - y * y + z * z),
    )
    return np.stack([np.stack(row, axis=-1) for row in rows], axis=-2)


def _products(first: Vector, second: Vector) -> Vector:
    """Return the products of matrices, shape (n, 3, 3)."""
    out: Vector = first[:, :, 0, None] * second[:, 0, None, :]
    for axis in (1, 2):
        out = out + first[:, :, axis, None] * second[:, axis, None, :]
    return out


class PictureMixer:
    """Weighted mean of the pictures of some cameras, in linear light.

    Args:
        weights: weights of each camera's pictures, see `Shutter.weights`.
    """

    def __init__(self, weights: tuple[npt.NDArray[np.uint32], ...]) -> None:
        self._weights, self._count = weights, 0
        self._sums: list[npt.NDArray[np.uint32]] = []
        self._first: Pictures = ()

    def add(self, pictures: Pictures) -> None:
        """Add the next picture of each camera."""
        if not self._count:
            self._first = pictures
            self._sums = [np.zeros(picture.colours.shape, np.uint32) for picture in pictures]
        for picture, total, weights in zip(pictures, self._sums, self._weights, strict=True):
            used = np.flatnonzero(weights[self._count])
            if total.size and len(used):  # colours without a reader are empty
                rows = slice(int(used[0]), int(used[-1]) + 1)
                _add_light(total[rows], picture.colours[rows], weights[self._count][rows])
        self._count += 1

    def result(self) -> Pictures:
        """Return the images; their depths are those of the first picture."""
        return tuple(
            replace(picture, colours=_encode(total)) if total.size else picture
            for picture, total in zip(self._first, self._sums, strict=True)
        )


def _add_light(total: npt.NDArray[np.uint32], colours: npt.NDArray[np.uint8], weights: npt.NDArray[np.uint32]) -> None:
    """Add the light of rows of colours, times a weight for each row, to their sums."""
    import cv2

    table = light_table().astype(np.int32)
    for first in range(0, len(colours), _STRIP):  # so few rows that they stay in a processor's cache
        part = slice(first, first + _STRIP)
        light = cv2.LUT(colours[part], table).view(np.uint32).reshape(colours[part].shape)
        light *= weights[part].reshape((-1,) + (1,) * (light.ndim - 1))
        total[part] += light


def _encode(total: npt.NDArray[np.uint32]) -> npt.NDArray[np.uint8]:
    """Return the colours of sums of light with the weight 65536."""
    return colour_table().take((total + np.uint32(_WHOLE // 2)) >> np.uint32(16))
