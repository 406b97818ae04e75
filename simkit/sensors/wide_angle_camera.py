"""Cameras with wide lenses."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from typing import TYPE_CHECKING, Any

from simkit.params import Params
from simkit.sensors import pictures
from simkit.sensors.camera import Camera
from simkit.sensors.cube import CubePicture
from simkit.sensors.lens import WideAngleModel, read_wide_angle_model
from simkit.sensors.picture import Picture
from simkit.sensors.rendering.view import Film, Shot

if TYPE_CHECKING:
    from simkit.runtime import Simulation


class WideAngleCamera(Camera):
    """`wide_angle_camera`: up to all directions through one of SDF's lenses, black beyond its cutoff angle."""

    kinds = ("wide_angle_camera", "wideanglecamera")

    @staticmethod
    def read_model(params: Params, width: int, height: int) -> WideAngleModel:
        return read_wide_angle_model(params, width, height)

    def attach(self, sim: Simulation) -> None:
        super().attach(sim)
        self._cube: CubePicture | None = None

    def describe(self) -> dict[str, Any]:
        found = super().describe()
        model = self.options.model
        assert isinstance(model, WideAngleModel)
        found["camera"]["lens"] = model.lens.type
        return found

    def shots(self) -> Sequence[Shot]:
        """What is drawn for one sample; found out at the first picture, since a lens takes a while."""
        if self._cube is None:
            model = self.options.model
            assert isinstance(model, WideAngleModel)
            self._cube = CubePicture(model)
        return self._cube.shots

    def develop(self, films: Iterator[Film], notes: Any) -> Picture:
        assert self._cube is not None
        colours = self._cube.develop(films, self._spare_colours.take())
        return Picture(pictures.grey(colours) if pictures.is_grey(self.options.encoding) else colours, None)
