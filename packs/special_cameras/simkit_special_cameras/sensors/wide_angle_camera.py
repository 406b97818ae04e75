"""Cameras with wide lenses."""

from __future__ import annotations

from collections.abc import Iterator, Sequence

from simkit import Params, Simulation
from simkit.sensors.cameras import image_messages
from simkit.sensors.cameras.camera import Camera
from simkit.sensors.cameras.image_noise import CameraReading
from simkit.sensors.cameras.rendering.view import DrawnView, Shot
from simkit_special_cameras.sensors.cube_map import CubeMap
from simkit_special_cameras.sensors.wide_angle_lens import WideAngleModel, read_wide_angle_model


class WideAngleCamera(Camera):
    """Wide-angle camera, `wide_angle_camera`: up to all directions, through a lens of SDF with a cutoff angle."""

    kinds = ("wide_angle_camera", "wideanglecamera")

    @staticmethod
    def read_model(params: Params, width: int, height: int) -> WideAngleModel:
        return read_wide_angle_model(params, width, height)

    def attach(self, sim: Simulation) -> None:
        super().attach(sim)
        self._cube: CubeMap | None = None

    def describe(self) -> dict[str, object]:
        model = self.options.model
        assert isinstance(model, WideAngleModel)
        return {"camera": {**self._describe_image(), "lens": model.lens.type}}

    def shots(self) -> Sequence[Shot]:
        """Return the views to draw for one sample, computed at the first image because the computation takes long."""
        if self._cube is None:
            model = self.options.model
            assert isinstance(model, WideAngleModel)
            self._cube = CubeMap(model)
        return self._cube.shots

    def make_reading(self, drawn_views: Iterator[DrawnView], context: object) -> CameraReading:
        assert self._cube is not None
        colours = self._cube.assemble(drawn_views, self._pictures.spares.take())
        return CameraReading(
            image_messages.grey(colours) if image_messages.is_grey(self.options.encoding) else colours, None
        )
