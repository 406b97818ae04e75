"""Occlusion shadow of a depth camera with two eyes: pixels that only one of them sees."""

from __future__ import annotations

import numpy as np

from simkit import Params
from simkit.extend import Sensor
from simkit_realism.depth_images.depth_artefact import NO_RETURN, DepthArtefact, Depths, Exposure


class OcclusionShadow(DepthArtefact):
    """`<simkit:occlusion_shadow>` of a stereo camera, or of a camera with a projector beside it.

    The second eye sees a pixel (u, z) in its column u - f·b/z. A pixel has no return if the second eye sees something
    nearer in that column, or if the column is outside of the second eye's image. The shadow beside the edge of an
    object at z1 before a surface at z2 is f·b·(1/z1 - 1/z2) wide.

    Args:
        params: the element.
        sensor: the camera.
    """

    elements = ("depth/occlusion_shadow",)
    order = 5.0

    def __init__(self, params: Params, sensor: Sensor) -> None:
        super().__init__(params, sensor)
        baseline = params.number("baseline", required=True, minimum=-1e3, maximum=1e3)
        self._focal_length = params.number("focal_length", 0.0, minimum=0.0, maximum=1e9)
        self._is_to_the_right, self._baseline = baseline >= 0, abs(baseline)
        self._margin = np.float32(params.number("margin", 0.0, minimum=0.0, maximum=1e9))

    def change(self, depths: Depths, exposure: Exposure) -> Depths:
        length = np.float32((self._focal_length or exposure.model.fx) * self._baseline)
        with np.errstate(divide="ignore"):
            disparities = length / exposure.depths
        disparities[exposure.depths < 0] = np.float32(length / max(exposure.model.near, 1e-3))  # nearer than the range
        if not self._is_to_the_right:
            disparities = disparities[:, ::-1]
        columns = np.arange(exposure.model.width, dtype=np.float32) - disparities
        # the leftmost column among all pixels to the right of each pixel
        nearest = np.minimum.accumulate(columns[:, ::-1], axis=1)[:, ::-1]
        hidden = columns < -self._margin
        hidden[:, :-1] |= columns[:, :-1] > nearest[:, 1:]
        if not self._is_to_the_right:
            hidden = hidden[:, ::-1]
        changed = depths.copy()
        np.copyto(changed, NO_RETURN, where=hidden)
        return changed
