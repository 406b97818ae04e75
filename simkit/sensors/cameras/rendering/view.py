"""View, shot and drawn view: the content of an image, its request and its result."""

from __future__ import annotations

from dataclasses import dataclass

import mujoco
import numpy as np
import numpy.typing as npt

from simkit.linear_algebra import norm
from simkit.pose import Vector

Colours = npt.NDArray[np.uint8]
Depths = npt.NDArray[np.float32]
Ids = npt.NDArray[np.int32]


@dataclass(frozen=True, slots=True)
class View:
    """Frustum and image size [px] of an image.

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
    """Request for one drawn view; a camera's sample needs one or several of them.

    Attributes:
        view: image size and frustum.
        depth: True reads depths besides the colours.
        ids: True draws geom ids instead of colours.
        sharp: True draws only depths, with one sample in the middle of each pixel. With several samples per pixel, the
            depth would belong to a sample beside the middle.
        position: position of the view in the sensor's frame [m], shape (3,); None is the origin.
        rotation: rotation matrix of the view (x forward, y left, z up) in the sensor's frame, shape (3, 3); None is
            the identity.
    """

    view: View
    depth: bool = False
    ids: bool = False
    sharp: bool = False
    position: Vector | None = None
    rotation: Vector | None = None


@dataclass(frozen=True, slots=True)
class DrawnView:
    """Drawn result of one shot, rows from the top, as views of buffers that the next shot overwrites.

    Attributes:
        view: view that it was drawn through.
        colours: colours, shape (height, width, 3); None for a shot of ids, or of depths only.
        depths: raw depths, shape (height, width), which `DepthRange.metres` converts: 0 is the far plane or nothing, 1
            the near plane; None if not requested.
        ids: geom id at each pixel, shape (height, width), -1 for none; None for a shot of colours.
    """

    view: View
    colours: Colours | None
    depths: Depths | None = None
    ids: Ids | None = None


def depth_line(near: float, far: float) -> tuple[np.float32, np.float32]:
    """Return slope and offset of z = slope/(raw + offset), as the graphics library computes it.

    The library's matrix is that of `glFrustum`, shifted and scaled by ½ (mjr_render): raw = slope/z - offset with slope
    = near·far/(far - near) and offset = ½·((far + near)/(far - near) - 1), where the quotient is a 32-bit float.
    """
    near, far = float(np.float32(near)), float(np.float32(far))
    quotient = float(np.float32((far + near) / (far - near)))
    return np.float32(near * far / (far - near)), np.float32(0.5 * (quotient - 1.0))


def look_at(eye: Vector, target: Vector) -> Vector:
    """Return the rotation (3, 3) of an upright camera frame (x forward, y left, z up) at `eye` that faces `target`."""
    forward = np.asarray(target, dtype=np.float64) - eye
    forward /= max(norm(forward), 1e-12)
    up = np.array((0.0, 0.0, 1.0)) if abs(forward[2]) < 0.999 else np.array((1.0, 0.0, 0.0))
    left = np.cross(up, forward)
    left /= norm(left)
    return np.stack((forward, left, np.cross(forward, left)), axis=1)


def aim(scene: mujoco.MjvScene, position: Vector, rotation: Vector, view: View) -> None:
    """Set both eyes of the scene's camera, because the engine draws their mean."""
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
