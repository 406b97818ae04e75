"""Cameras with depth alone."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace

import numpy as np

from simkit.diagnostics import Diagnostics
from simkit.runtime import Simulation
from simkit.scene import SceneSensor
from simkit.sensors.cameras.rendering.view import Colours, Depths, Shot
from simkit.sensors.cameras.rgbd_camera import RgbdCamera
from simkit.sensors.sample import Reading


class DepthCamera(RgbdCamera):
    """Depth alone, and its cloud in shades of grey: near is bright."""

    kinds = ("depth_camera", "depth")

    def __init__(self, scene: SceneSensor, diagnostics: Diagnostics) -> None:
        super().__init__(scene, diagnostics)
        options = self.options
        own, camera = (options.depth_near, options.depth_far), (options.model.near, options.model.far)
        if own != camera:
            message = f"depths are from {own[0]:g} to {own[1]:g} m, by <depth_camera><clip>"
            where = scene.params.block("camera").block("depth_camera").block("clip").where
            hint = "Gazebo's depth_camera passes that over and takes the camera's <clip>; write the range there"
            diagnostics.note("SK-SENSOR-110", f"sensor {self.scoped!r}: {message}", where, hint)

    def attach(self, sim: Simulation) -> None:
        if sim.world.gazebo_quirks:
            model = self.options.model
            self.options = replace(self.options, depth_near=model.near, depth_far=model.far)
        super().attach(sim)

    def shots(self) -> Sequence[Shot]:
        if self._is_classic or "image" in self._topics:
            return super().shots()
        return (Shot(self._drawn_view(), depth=True, sharp=True),)  # nobody asks for colours

    def default_topics(self) -> dict[str, str]:
        topic = self._default_topic("depth_image")
        return {"depth_image": topic, "points": topic + "/points", "camera_info": self._info_topic(topic)}

    def _cloud_colours(self, reading: Reading) -> Colours:
        """White at the camera, black at the farthest point and at infinite ones (gz-sensors, DepthCameraSensor.cc).

        Gazebo Classic's clouds have the picture's colours.
        """
        if self._is_classic:
            return super()._cloud_colours(reading)
        depths: Depths = reading.depths
        infinite = np.isinf(depths)
        farthest = np.max(depths, where=~infinite, initial=np.float32(0))
        with np.errstate(invalid="ignore"):
            shades = np.multiply(depths, np.float32(-255.0 / farthest if farthest > 0 else 0.0))
        shades += np.float32(255.0)
        np.copyto(shades, np.float32(0.0), where=infinite)
        return shades.astype(np.uint8)
