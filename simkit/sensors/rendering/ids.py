"""Which geom is seen at each pixel."""

from __future__ import annotations

from typing import Any

import mujoco
import numpy as np

from simkit.sensors.rendering.sight import without_looks
from simkit.sensors.rendering.view import Colours, Depths, Film, Ids, Shot


def draw_ids(scene: Any, context: Any, shot: Shot, rectangle: Any, colours: Colours, depths: Depths) -> Film:
    """Which geom is seen at each pixel: edges must not be blended, so the context is one without multisampling."""
    with without_looks(scene):
        mujoco.mjr_render(rectangle, scene, context)
        mujoco.mjr_readPixels(colours, depths if shot.depth else None, rectangle, context)
    names = np.full(scene.ngeom + 1, -1, np.int32)  # the engine draws a shape's number in the list, from 1
    for geom in scene.geoms[: scene.ngeom]:
        if geom.objtype == mujoco.mjtObj.mjOBJ_GEOM and 0 <= geom.segid < scene.ngeom:
            names[geom.segid + 1] = geom.objid
    ids = names.take(_numbers(colours), mode="clip")
    return Film(shot.view, None, depths[::-1] if shot.depth else None, ids[::-1])


def _numbers(colours: Colours) -> Ids:
    """Red, green and blue as the bytes of one number, from the lowest; ten times as fast as a product of matrices."""
    import cv2

    numbers: Ids = cv2.cvtColor(colours, cv2.COLOR_RGB2RGBA).view(np.int32)[..., 0]
    np.bitwise_and(numbers, 0xFFFFFF, out=numbers)
    return numbers
