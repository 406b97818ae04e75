"""Flying pixels of a depth camera: depths between an object and its background, at the object's edge."""

from __future__ import annotations

import cv2
import numpy as np

from simkit import Params
from simkit.extend import Sensor
from simkit_realism.depth_images.depth_artefact import DepthArtefact, Depths, Exposure
from simkit_realism.depth_images.random_images import random_words


class FlyingPixels(DepthArtefact):
    """`<simkit:flying_pixels>` of a time-of-flight camera, which mixes the light of both surfaces in a pixel.

    A pixel within `width` of an edge gets, with the given probability, z1 + w·(z2 - z1), where z1 and z2 are the
    nearest and the farthest depth around it and w is uniform from 0 to 1.

    Args:
        params: the element.
        sensor: the camera.
    """

    elements = ("depth/flying_pixels",)
    order = -5.0

    def __init__(self, params: Params, sensor: Sensor) -> None:
        super().__init__(params, sensor)
        self._width = params.integer("width", 1, minimum=1, maximum=50)
        self._jump = np.float32(params.number("min_jump", 0.1, minimum=1e-3, maximum=1e3))
        self._probability = params.number("probability", 1.0, minimum=0.0, maximum=1.0)

    def prepare(self) -> None:
        self._mixtures, self._chances = self.stream("mixtures"), self.stream("chances")

    def change(self, depths: Depths, exposure: Exposure) -> Depths:
        true, side = exposure.depths, 2 * self._width + 1
        square = np.ones((side, side), np.uint8)
        finite = np.isfinite(true)
        nearest = np.asarray(cv2.erode(np.where(finite, true, np.float32(np.inf)), square), np.float32)
        farthest = np.asarray(cv2.dilate(np.where(finite, true, np.float32(-np.inf)), square), np.float32)
        with np.errstate(over="ignore"):  # OpenCV's border is the largest float, where nothing is seen
            is_edge = farthest - nearest >= self._jump
        rows, columns = np.nonzero(is_edge)
        if self._probability < 1:
            words = random_words(self._chances, exposure.index, exposure.shape)
            is_mixed = words[rows, columns] < self._probability * 65536.0
            rows, columns = rows[is_mixed], columns[is_mixed]
        share = random_words(self._mixtures, exposure.index, exposure.shape)[rows, columns]
        weights = (share.astype(np.float32) + np.float32(0.5)) / np.float32(65536.0)
        near, far = nearest[rows, columns], farthest[rows, columns]
        changed = depths.copy()
        changed[rows, columns] = near + weights * (far - near)
        return changed
