"""Holes of depth images: pixels without a return, by chance, place, surface, brightness, angle and range."""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import dataclass, replace

import numpy as np
import numpy.typing as npt

from simkit import Params
from simkit.extend import Compiled, Sensor
from simkit.sensors.surface_optics import surface_optics
from simkit_realism.depth_images.depth_artefact import NO_RETURN, DepthArtefact, Depths, Exposure, PerModel
from simkit_realism.depth_images.image_buffers import new_image, strips
from simkit_realism.depth_images.loss_places import read_places, read_wedge
from simkit_realism.depth_images.loss_ramps import LossRamp, read_ramp
from simkit_realism.depth_images.random_images import LARGEST_WINDOW, NormalImages, threshold
from simkit_realism.depth_images.surface_angles import SurfaceAngles

_OPTICS = ("reflectivity", "specularity", "transmittance")
_MOST_REFLECTIVE = 1e3


@dataclass(frozen=True, slots=True)
class NamedSurface:
    """Visuals whose pixels have no return with a probability.

    Attributes:
        params: element of the name, for reports.
        name: scoped name of a visual, a link or a model.
        probability: probability of a loss.
    """

    params: Params
    name: str
    probability: float

    def contains(self, scoped: str) -> bool:
        """Check whether a visual is, or belongs to, the named entity."""
        return scoped == self.name or scoped.startswith(self.name + "::")


class DepthHoles(DepthArtefact):
    """`<simkit:depth_holes>` of a depth camera: pixels without a return.

    The reasons are independent: a pixel has a return with the product of the probabilities that no reason takes it.
    One random image decides for all reasons, so holes have the size and the duration of its correlation.

    Args:
        params: the element.
        sensor: the camera.
    """

    elements = ("depth/depth_holes",)
    order = 6.0

    def __init__(self, params: Params, sensor: Sensor) -> None:
        super().__init__(params, sensor)
        self._kept = np.float32(1.0 - params.number("probability", 0.0, minimum=0.0, maximum=1.0))
        self._window = params.integer("correlation_length", 1, minimum=1, maximum=LARGEST_WINDOW)
        self._time = params.number("correlation_time", 0.0, minimum=0.0, maximum=1e6)
        self._places = PerModel(read_places(params).valid)
        self._wedge = read_wedge(params)
        self._positions = PerModel(self._wedge.positions) if self._wedge is not None else None
        self._incidence = _in_cosines(read_ramp(params, "incidence", 0.0, math.pi / 2))
        self._depth = read_ramp(params, "depth", 0.0, 1e6)
        self._brightness = _in_shades(read_ramp(params, "brightness", 0.0, 1.0))
        self._contrast = _in_shades(read_ramp(params, "contrast", 0.0, 1.0))
        self._optics = {name: read_ramp(params, name, 0.0, _MOST_REFLECTIVE) for name in _OPTICS}
        self._surfaces = [
            NamedSurface(
                block.block("name"),
                block.text("name", required=True),
                block.number("probability", 1.0, minimum=0.0, maximum=1.0),
            )
            for block in params.all("surface")
        ]
        self._angles = PerModel(SurfaceAngles)
        self._kept_by_geom: Depths | None = None

    def prepare(self) -> None:
        rate = self.sensor.update_rate or 1.0 / self.sensor.sim.timestep
        self._normals = NormalImages(self.stream("holes"), self._window, self._time * rate)
        self.sensor.needs_colours |= self._brightness is not None or self._contrast is not None
        self.sensor.needs_geoms |= bool(self._surfaces) or any(self._optics.values())

    def bind(self, compiled: Compiled) -> None:
        if not (self._surfaces or any(self._optics.values())):
            return
        optics = surface_optics(compiled, of_visuals=True)
        kept = np.ones(compiled.model.ngeom + 1, np.float32)
        for name, ramp in self._optics.items():
            if ramp is not None:
                kept[:-1] *= 1.0 - ramp.of(getattr(optics, name))[:-1]
        for surface in self._surfaces:
            geoms = [
                geom for geom in range(compiled.model.ngeom) if surface.contains(compiled.names.geom_owner(geom)[1])
            ]
            kept[geoms] *= np.float32(1.0 - surface.probability)
            if not geoms:
                message = f"sensor {self.sensor.scoped!r}: no visual belongs to <name>{surface.name}</name>"
                self.sensor.sim.engine.reports.warning(
                    "SK-SENSOR-228",
                    message,
                    surface.params.where,
                    "give the scoped name of a model, a link or a visual",
                )
        self._kept_by_geom = kept

    def change(self, depths: Depths, exposure: Exposure) -> Depths:
        changed = new_image(exposure.shape, np.float32)
        normals = self._normals.image(exposure.index, exposure.shape)
        parts = self._kept_parts(exposure)
        for rows in strips(exposure.shape):
            kept = np.full((rows.stop - rows.start, exposure.shape[1]), self._kept, np.float32)
            for part in parts:
                kept *= part(rows)
            np.subtract(np.float32(1.0), kept, out=kept)
            lost = normals[rows] < threshold(kept)
            if self._wedge is not None and self._positions is not None:
                lost |= self._wedge.hides(exposure.depths[rows], self._positions.of(exposure.model)[rows])
            np.copyto(changed[rows], depths[rows])
            np.copyto(changed[rows], NO_RETURN, where=lost)
        return changed

    def _kept_parts(self, exposure: Exposure) -> list[Callable[[slice], Depths]]:
        """Return the functions from rows of the image to the probability that each reason leaves a return."""
        parts: list[Callable[[slice], Depths]] = []
        by_place, angles = self._places.of(exposure.model), self._angles.of
        if by_place is not None:
            parts.append(lambda rows: by_place[rows])
        if self._incidence is not None:
            incidence = self._incidence
            parts.append(lambda rows: incidence.kept(angles(exposure.model).cosines(exposure.depths, rows)))
        for ramp, image in (
            (self._depth, lambda: exposure.depths),
            (self._brightness, lambda: exposure.brightness),
            (self._contrast, lambda: exposure.contrast),
        ):
            if ramp is not None:
                parts.append(_kept_of(ramp, image()))
        by_geom, geoms = self._kept_by_geom, exposure.truth.geoms
        if by_geom is not None and geoms is not None:
            parts.append(lambda rows: by_geom.take(geoms[rows], mode="wrap"))  # -1 is no geom, the last entry
        return parts


def _kept_of(ramp: LossRamp, image: npt.NDArray[np.generic]) -> Callable[[slice], Depths]:
    """Return the function from rows to the probability that a ramp over an image leaves a return."""
    return lambda rows: ramp.kept(image[rows])


def _in_cosines(ramp: LossRamp | None) -> LossRamp | None:
    """Return a ramp over angles [rad] as a ramp over their cosines."""
    if ramp is None:
        return None
    start = math.cos(ramp.start)
    # a ramp without width is a step, whose direction only its ends show
    return replace(ramp, start=start, end=min(math.cos(ramp.end), start - 1e-6))


def _in_shades(ramp: LossRamp | None) -> LossRamp | None:
    """Return a ramp over brightness from 0 to 1 as a ramp over bytes."""
    return None if ramp is None else replace(ramp, start=ramp.start * 255.0, end=ramp.end * 255.0)
