"""Zoom lens of a camera: `CameraZoomPlugin` of ardupilot_gazebo."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING

from simkit import Params, SensorPlugin
from simkit.extend import NEVER, Options, OptionsOf, listens, number, text
from simkit.msgs import valid_topic

if TYPE_CHECKING:
    from simkit.extend import SceneSensor, SpecBuilder
    from simkit.msgs import Float64
    from simkit.sensors.cameras.rendered_camera import RenderedCamera

_COMMAND = "std_msgs/msg/Float64"
_REFERENCE = 2.0  # [rad] opening angle at zoom 1 of every camera in ardupilot_gazebo, whatever its file says
_KINDS = (
    "camera", "depth_camera", "depth", "rgbd_camera", "multicamera", "thermal_camera", "thermal",
    "segmentation_camera", "segmentation", "boundingbox_camera", "boundingbox",
)  # fmt: skip


class CameraZoomOptions(Options):
    """Options of `CameraZoomPlugin`."""

    topic: str = text()
    max_zoom: float = number(10.0, minimum=1.0, maximum=1e6)
    slew_rate: float = number(
        math.inf, "m/s", minimum=0, finite=False, description="change of the focal length; by default at once"
    )


class CameraZoom(SensorPlugin):
    """Changes the opening angle of its camera by commands.

    The command is a `Float64` from 1 to `<max_zoom>` on `/model/<model>/sensor/<sensor>/zoom/cmd_zoom`, or on
    `<topic>`. The camera turns to the opening angle of its file divided by the command. On the way, its focal length
    changes by `<slew_rate>`, relative to the lens's focal length `<f>` (1 m without `<custom_function>`). Images,
    depths, clouds and `CameraInfo` follow.
    """

    endpoints = (listens("/model/…/sensor/…/zoom/cmd_zoom", _COMMAND, named_by=("topic",)),)
    options = OptionsOf(CameraZoomOptions)
    filenames = ("CameraZoomPlugin",)
    names = ("gz::sim::systems::CameraZoomPlugin",)

    def prepare(self, scene: SceneSensor, params: Params, builder: SpecBuilder) -> None:
        self.options.read_all()
        if scene.kind not in _KINDS:
            message = f"plugin {self.name!r} needs a camera without a wide lens; this sensor is {scene.kind!r}"
            params.error("SK-PLUGIN-003", message)

    def load(self, parent: RenderedCamera, params: Params) -> None:
        options = self.options
        self._camera = parent
        angle = parent.options.model.hfov
        self._unzoomed = self._tangent = math.tan(angle / 2)
        self._reference = _REFERENCE if self.sim.world.gazebo_quirks else angle
        self._goal = math.tan(self._reference / 2)
        lens = parent.scene.params.block("camera").block("lens").block("custom_function")
        self._focal_length = lens.number("f", 1.0, minimum=1e-9)
        model = parent.scene.parent.rpartition("::")[0].rpartition("::")[2]
        topic = options.topic or f"/model/{model}/sensor/{parent.name}/zoom/cmd_zoom"
        self.listen(valid_topic(topic), _COMMAND, self._on_command)
        self._wait_or_turn()

    def _on_command(self, message: Float64) -> None:
        zoom = float(message.data)
        if math.isnan(zoom):
            self._once.not_finite()
            return
        self._goal = math.tan(self._reference / max(1.0, min(zoom, self.options.max_zoom)) / 2)
        self._wait_or_turn()

    def _wait_or_turn(self) -> None:
        """Run `before_step` only while the camera is not at its goal."""
        self._set_before_step_rate(NEVER if self._tangent == self._goal else None)

    def before_step(self) -> None:
        """Change the focal length by the way of one step."""
        tangent, goal, focal_length = self._tangent, self._goal, self._focal_length
        missing = focal_length * tangent / goal - focal_length
        change = self.options.slew_rate * self.period
        if abs(missing) <= change:
            self._tangent = goal
        else:
            # the focal length of each step is relative to the lens's own one, as in ardupilot_gazebo
            self._tangent = tangent * focal_length / (focal_length + math.copysign(change, missing))
        self._camera.set_zoom(self._unzoomed / self._tangent)
        self._wait_or_turn()
