"""Colour cameras."""

from __future__ import annotations

from typing import ClassVar

from simkit.sensors.base import Product
from simkit.sensors.cameras.rendered_camera import RenderedCamera


class Camera(RenderedCamera):
    """Camera, `camera`: colour or grey images with their `CameraInfo`."""

    kinds: ClassVar[tuple[str, ...]] = ("camera",)
    artefact_families: ClassVar[tuple[str, ...]] = ("colour",)

    def products(self) -> dict[str, Product]:
        return {"image": self._colour_product(), "camera_info": self._info_product()}
