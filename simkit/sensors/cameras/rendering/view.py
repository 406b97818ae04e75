"""View frustum, shot and film: what a picture shows and what is read from it."""

from __future__ import annotations

from dataclasses import dataclass

import mujoco
import numpy as np
import numpy.typing as npt

from simkit.pose import Vector

Colours = npt.NDArray[np.uint8]
Depths = npt.NDArray[np.float32]
Ids = npt.NDArray[np.int32]


@dataclass(frozen=True, slots=True)
class View:
    """What a camera looks through: image size [px] and the frustum's edges at a distance of 1.

    Attributes:
        left, right, bottom, top: edges on the plane at distance 1 in front of the camera.
        near, far: clip planes [m].
    """

    width: int
    height: int
    left: float
    right: float
    bottom: float
    top: float
    near: float
    far: float


@dataclass(frozen=True, slots=True)
class Shot:
    """One of the views that a sample of a camera is made of.

    Attributes:
        view: image size and frustum.
        depth: whether depths are read beside the colours.
        ids: whether, instead of colours, each pixel tells which geom is seen there.
        sharp: whether depths are all that is wanted: they are of each pixel's middle then, also where the quality has
            several samples of a pixel, of which a depth is but one.
        position: of the view in the sensor's frame [m], shape (3,); None is its origin.
        rotation: of the view (x forward, y left, z up) in the sensor's frame, shape (3, 3); None is the sensor's own.
    """

    view: View
    depth: bool = False
    ids: bool = False
    sharp: bool = False
    position: Vector | None = None
    rotation: Vector | None = None


@dataclass(frozen=True, slots=True)
class Film:
    """What was drawn of one shot, rows from the top; views of buffers that the next shot overwrites.

    Attributes:
        view: that it was drawn through.
        colours: (height, width, 3); None for a shot of ids, or of depths alone.
        depths: raw, (height, width): 0 is the far plane or nothing, 1 the near plane, `metres` converts; None where
            they were not asked for.
        ids: (height, width): the model's geom at each pixel, -1 where there is none; None for a shot of colours.
    """

    view: View
    colours: Colours | None
    depths: Depths | None = None
    ids: Ids | None = None


def look_at(eye: Vector, target: Vector) -> Vector:
    """Rotation (3, 3) of a camera frame (x forward, y left, z up) at `eye` that looks at `target`, upright."""
    forward = np.asarray(target, dtype=np.float64) - eye
    forward /= max(float(np.linalg.norm(forward)), 1e-12)
    up = np.array((0.0, 0.0, 1.0)) if abs(forward[2]) < 0.999 else np.array((1.0, 0.0, 0.0))
    left = np.cross(up, forward)
    left /= np.linalg.norm(left)
    return np.stack((forward, left, np.cross(forward, left)), axis=1)


def aim(scene: mujoco.MjvScene, position: Vector, rotation: Vector, view: View) -> None:
    """Sets both eyes of the scene's camera; their mean is what is drawn."""
    near = view.near
    for camera in scene.camera:
        camera.pos = position
        camera.forward = rotation[:, 0]
        camera.up = rotation[:, 2]
        camera.orthographic = 0
        camera.frustum_near, camera.frustum_far = near, view.far
        camera.frustum_bottom, camera.frustum_top = view.bottom * near, view.top * near
        camera.frustum_center = (view.left + view.right) / 2 * near
        camera.frustum_width = (view.right - view.left) / 2 * near
