"""Colour cameras."""

from __future__ import annotations

from typing import ClassVar

from simkit.sensors.base import Product
from simkit.sensors.cameras.rendered_camera import RenderedCamera
from simkit.sensors.cameras.rendered_sampler import camera_rule
from simkit.sensors.measured_rows import MeasuredRows


class Camera(RenderedCamera):
    """Camera, `camera`: colour or grey images with their `CameraInfo`."""

    kinds: ClassVar[tuple[str, ...]] = ("camera",)
    artefact_families: ClassVar[tuple[str, ...]] = ("colour",)

    def array_rule(self) -> MeasuredRows:
        return camera_rule(self)

    def products(self) -> dict[str, Product]:
        return {"image": self._colour_product(), "camera_info": self._info_product()}
