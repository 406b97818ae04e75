"""Multi-path error of a depth camera: concave corners appear rounded, because light arrives after two reflections."""

from __future__ import annotations

import cv2
import numpy as np
import numpy.typing as npt

from simkit import Params
from simkit.extend import Sensor
from simkit_realism.depth_images.depth_artefact import DepthArtefact, Depths, Exposure

# number that stands for a reciprocal depth of 1/m: 32-bit floats hold integers up to 2^24 without rounding, so the
# sums do not depend on the order in which a processor adds
_UNIT, _LARGEST = np.float32(2.0**20), np.float32(2.0**24)


class DepthMultipath(DepthArtefact):
    """`<simkit:multipath>` of a time-of-flight camera: z' = z + strength·z²·max(0, m - 1/z).

    m is the mean of the reciprocal depths in a square of 2·radius + 1 pixels. On a plane, m is 1/z, so planes and
    convex edges are unchanged. Squares with an edge (a jump of the depth between neighbours) are unchanged too.

    Args:
        params: the element.
        sensor: the camera.
    """

    elements = ("depth/multipath",)
    order = -4.0

    def __init__(self, params: Params, sensor: Sensor) -> None:
        super().__init__(params, sensor)
        self._strength = np.float32(params.number("strength", 1.0, minimum=0.0, maximum=100.0))
        self._radius = params.integer("radius", 10, minimum=1, maximum=200)
        self._jump = np.float32(params.number("min_jump", 0.1, minimum=1e-3, maximum=1e3))

    def change(self, depths: Depths, exposure: Exposure) -> Depths:
        true = exposure.depths
        seen = np.isfinite(true)
        inverse = np.zeros(true.shape, np.float32)
        np.divide(np.float32(1.0), true, out=inverse, where=seen)
        side = 2 * self._radius + 1
        whole = np.minimum(np.rint(inverse * _UNIT), _LARGEST)
        border = cv2.BORDER_REPLICATE
        sums = np.asarray(cv2.boxFilter(whole, cv2.CV_64F, (side, side), normalize=False, borderType=border))
        surplus = (sums * (1.0 / (float(_UNIT) * side * side))).astype(np.float32)
        surplus -= inverse
        surplus[~self._is_smooth(true, seen)] = 0.0
        # a plane has no surplus except for rounding
        surplus[surplus < np.float32(2e-6)] = 0.0
        changed = depths.copy()
        np.add(changed, self._strength * surplus * np.square(np.where(seen, true, np.float32(0.0))), out=changed)
        return changed

    def _is_smooth(self, true: Depths, seen: npt.NDArray[np.bool_]) -> npt.NDArray[np.bool_]:
        """Return True for the pixels whose square has no edge and no pixel without a return."""
        shown = np.where(seen, true, np.float32(0.0))
        cross = cv2.getStructuringElement(cv2.MORPH_CROSS, (3, 3))
        steps = np.asarray(cv2.dilate(shown, cross)) - np.asarray(cv2.erode(shown, cross))
        edges = ((steps >= self._jump) | ~seen).astype(np.uint8)
        side = 2 * self._radius + 1
        smooth: npt.NDArray[np.bool_] = np.asarray(cv2.dilate(edges, np.ones((side, side), np.uint8))) == 0
        return smooth
