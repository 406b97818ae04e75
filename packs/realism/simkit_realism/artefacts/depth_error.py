"""Errors of depths: scale, offset, and noise that grows with the depth and is correlated between pixels."""

from __future__ import annotations

import numpy as np

from simkit import Params
from simkit.elementary_functions import power
from simkit.extend import Sensor
from simkit_realism.depth_images.depth_artefact import DepthArtefact, Depths, Exposure, PerModel
from simkit_realism.depth_images.depth_laws import LawTable, law_of_points, power_law
from simkit_realism.depth_images.image_buffers import new_image, strips
from simkit_realism.depth_images.random_images import LARGEST_WINDOW, NormalImages
from simkit_realism.depth_images.surface_angles import SurfaceAngles

_STEEPEST = np.float32(0.05)  # cosine of the largest angle of incidence up to which the noise grows: 87°
_LARGEST = 1e3  # [m] limit of all lengths


class DepthError(DepthArtefact):
    """`<simkit:depth_error>` of a depth camera: z' = (1 + scale)·z + offset + noise.

    The standard deviation of the noise is a power law of the depth after scale and offset, or a table of measured
    points. It applies before the noise of the file, so that the `<step>` of `<disparity_noise>` rounds the result.

    Args:
        params: the element.
        sensor: the camera.
    """

    elements = ("depth/depth_error",)
    order = -2.0

    def __init__(self, params: Params, sensor: Sensor) -> None:
        super().__init__(params, sensor)
        self._factor = np.float32(1.0 + params.number("scale", 0.0, minimum=-0.9, maximum=10.0))
        self._offset = np.float32(params.number("offset", 0.0, minimum=-_LARGEST, maximum=_LARGEST))
        self._law = _read_law(params)
        exponent = params.number("incidence_exponent", 0.0, minimum=0.0, maximum=4.0)
        self._angle_law = LawTable(lambda cosines: power(cosines, -exponent)) if exponent > 0 else None
        self._contrast = params.number("contrast", 0.0, minimum=0.0, maximum=1.0)
        self._window = params.integer("correlation_length", 1, minimum=1, maximum=LARGEST_WINDOW)
        self._angles = PerModel(SurfaceAngles)

    def prepare(self) -> None:
        self._normals = NormalImages(self.stream("noise"), self._window)
        self.sensor.needs_colours |= self._contrast > 0

    def change(self, depths: Depths, exposure: Exposure) -> Depths:
        changed = new_image(exposure.shape, np.float32)
        normals = None if self._law is None else self._normals.image(exposure.index, exposure.shape)
        factors = _contrast_factors(self._contrast)[exposure.contrast] if self._contrast > 0 else None
        for rows in strips(exposure.shape):
            part = changed[rows]
            np.multiply(depths[rows], self._factor, out=part)
            part += self._offset
            if self._law is None or normals is None:
                continue
            noise = self._law.of(part)
            if self._angle_law is not None:
                cosines = self._angles.of(exposure.model).cosines(exposure.depths, rows)
                noise *= self._angle_law.of(np.maximum(cosines, _STEEPEST, out=cosines))
            if factors is not None:
                noise *= factors[rows]
            noise *= normals[rows]
            part += noise
        return self.sensor.limit_depths(changed)


def _read_law(params: Params) -> LawTable | None:
    """Return the standard deviation as a function of the depth [m]; None without noise."""
    floor = params.number("stddev", 0.0, minimum=0.0, maximum=_LARGEST)
    coefficient = params.number("coefficient", 0.0, minimum=0.0, maximum=_LARGEST)
    exponent = params.number("exponent", 2.0, minimum=0.0, maximum=8.0)
    start = params.number("start", 0.0, minimum=0.0, maximum=_LARGEST)
    points = [block.vector("point", 2) for block in params.each("point")]
    if not points:
        return power_law(floor, coefficient, exponent, start) if floor > 0 or coefficient > 0 else None
    if floor > 0 or coefficient > 0:
        message = "<stddev> and <coefficient> have no effect beside <point>, which gives the standard deviation"
        params.warning("SK-SENSOR-229", message, "remove the <point> elements, or the law")
    depths = [point[0] for point in points]
    if min(min(point) for point in points) <= 0 or depths != sorted(set(depths)):
        message = "the <point> elements need depths and standard deviations above 0 [m], in ascending order of depth"
        params.error("SK-SENSOR-225", message, "write one <point>DEPTH STDDEV</point> for each measured depth")
        return None
    return law_of_points([(depth, stddev) for depth, stddev in points])


def _contrast_factors(reference: float) -> Depths:
    """Return the factor of the noise for each contrast from 0 to 255: less contrast than the reference adds noise."""
    return np.array([max(reference * 255.0 / max(shade, 1), 1.0) for shade in range(256)], np.float32)
