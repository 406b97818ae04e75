"""Colour cameras."""

from __future__ import annotations

from typing import TYPE_CHECKING, ClassVar

from simkit.sensors.base import Product
from simkit.sensors.cameras.rendered_camera import RenderedCamera
from simkit.sensors.cameras.rendered_sampler import camera_rule
from simkit.sensors.measured_rows import MeasuredRows

if TYPE_CHECKING:
    from simkit import msgs  # noqa: F401 (in the type parameter)


class Camera(RenderedCamera["msgs.Image"]):
    """Camera, `camera`: colour or grey images with their `CameraInfo`."""

    kinds: ClassVar[tuple[str, ...]] = ("camera",)
    artefact_families: ClassVar[tuple[str, ...]] = ("colour",)

    def array_rule(self) -> MeasuredRows:
        return camera_rule(self)

    def products(self) -> dict[str, Product]:
        return {"image": self._colour_product(), "camera_info": self._info_product()}
