"""Depth cameras without colours."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace

import numpy as np

from simkit.diagnostics import Diagnostics
from simkit.runtime import Simulation
from simkit.scene import SceneSensor
from simkit.sensors.cameras.rendered_sampler import camera_rule
from simkit.sensors.cameras.rendering.view import Colours, Depths, Shot
from simkit.sensors.cameras.rgbd_camera import RgbdCamera
from simkit.sensors.measured_rows import MeasuredRows
from simkit.sensors.sample import Reading


class DepthCamera(RgbdCamera):
    """Depth camera: depth images, and point clouds in shades of grey, in which near points are bright."""

    kinds = ("depth_camera", "depth")
    artefact_families = ("depth",)

    def __init__(self, scene: SceneSensor, diagnostics: Diagnostics) -> None:
        super().__init__(scene, diagnostics)
        options = self.options
        depth_range, camera = (options.depth_near, options.depth_far), (options.model.near, options.model.far)
        if depth_range != camera:
            message = f"depths are from {depth_range[0]:g} to {depth_range[1]:g} m, as in <depth_camera><clip>"
            where = scene.params.block("camera").block("depth_camera").block("clip").where
            hint = "Gazebo's depth_camera uses the <clip> of <camera> instead; write the range there"
            diagnostics.note("SK-SENSOR-110", f"sensor {self.scoped!r}: {message}", where, hint)

    def attach(self, sim: Simulation) -> None:
        if sim.world.gazebo_quirks:
            model = self.options.model
            self.options = replace(self.options, depth_near=model.near, depth_far=model.far)
        super().attach(sim)

    def array_rule(self) -> MeasuredRows:
        return camera_rule(self)

    def shots(self) -> Sequence[Shot]:
        # without a reader of the colours, only depths are drawn
        has_reader = self._is_classic or self.needs_colours or "image" in self._topics
        return self._with_geoms(with_colours=has_reader)

    def default_topics(self) -> dict[str, str]:
        topic = self._default_topic("depth_image")
        return {"depth_image": topic, "points": topic + "/points", "camera_info": self._info_topic(topic)}

    def _cloud_colours(self, reading: Reading) -> Colours:
        """Return shades from white at the camera to black at the farthest point (gz-sensors, DepthCameraSensor.cc).

        Points without a depth are black. Gazebo Classic's clouds have the image's colours.
        """
        if self._is_classic:
            return super()._cloud_colours(reading)
        depths: Depths = reading.depths
        finite = np.isfinite(depths)
        farthest = np.max(depths, where=finite, initial=np.float32(0))
        with np.errstate(invalid="ignore"):
            shades = np.multiply(depths, np.float32(-255.0 / farthest if farthest > 0 else 0.0))
        shades += np.float32(255.0)
        np.copyto(shades, np.float32(0.0), where=~finite)
        return shades.astype(np.uint8)
