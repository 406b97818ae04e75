"""Base of the sensors of uuv_simulator that are plugins of a model.

Parameters, defaults and topics are those of `ROSBasePlugin.cc` and `ROSBaseModelPlugin.cc`.
"""

from __future__ import annotations

import math
from abc import abstractmethod
from typing import TYPE_CHECKING, Any, ClassVar, Final

import numpy as np

from simkit import ModelPlugin, Params, Pose, msgs
from simkit.extend import (
    Options,
    OptionsOf,
    Vector,
    boolean,
    find_link,
    find_named_link,
    number,
    offers,
    publishes,
    text,
    without_effect,
)
from simkit.pose import quat_from_rpy

if TYPE_CHECKING:
    from simkit import Model
    from simkit.extend import SceneModel, SpecBuilder
    from simkit.msgs import Message

TRANSFORMS: Final = "tf2_msgs/msg/TFMessage"
"""Type of messages on `/tf_static`."""
_BOOL: Final = "std_msgs/msg/Bool"
_CHANGE: Final = "uuv_sensor_ros_plugins_msgs/srv/ChangeSensorState"
_NED: Final = "world_ned"
_NED_POSE: Final = Pose((0.0, 0.0, 0.0), quat_from_rpy(math.pi, 0.0, math.pi / 2))
"""North, east and down, as `publish_world_ned_frame.launch` of uuv_assistants publishes it."""
REVERSED: Final = np.array((1.0, -1.0, -1.0))
"""Factors from the axes of a link to its axes with y and z reversed."""


class UuvSensorOptions(Options):
    """Options of all sensors."""

    namespace: str = text(element="robot_namespace", required=True)
    link: str = text(None, element="link_name", required=True)
    topic: str = text(element="sensor_topic", required=True)
    rate: float = number(30.0, "Hz", element="update_rate", minimum=1e-6, maximum=1e9)
    is_on: bool = boolean(True)
    has_ned_frame: bool = boolean(True, element="enable_local_ned_frame")
    reference_frame: str = text("world", element="static_reference_frame")
    reference_link: str = text(element="reference_link_name")
    sigma: float = number(0.0, element="noise_sigma", minimum=0.0, maximum=1e9)
    amplitude: float = number(0.0, element="noise_amplitude", minimum=0.0, maximum=1e9)
    gazebo_messages: bool = without_effect(element="enable_gazebo_messages")


class UuvSensor(ModelPlugin):
    """Base class of the sensors.

    A reading is due 1 / `<update_rate>` after the last one. The service `<sensor_topic>/change_state` switches the
    sensor off and on, and `<sensor_topic>/state` is its state. Noise has the standard deviation `<noise_amplitude>`
    times `<noise_sigma>`. With `<enable_local_ned_frame>`, vectors are in the frame `<link>_ned`, whose y and z axes
    are reversed.

    Attributes:
        width: number of normal numbers that a reading needs.
    """

    options = OptionsOf(UuvSensorOptions)
    endpoints: ClassVar[tuple[Any, ...]] = (
        publishes("/{robot_namespace}/{sensor_topic}/state", _BOOL),
        offers("/{robot_namespace}/{sensor_topic}/change_state", _CHANGE),
    )
    width: int = 3
    _settings: Any

    def prepare(self, scene: SceneModel, params: Params, builder: SpecBuilder) -> None:
        options = self._settings = self.options.read_all()
        self._link_name = find_named_link(scene, "link_name", params)
        self._reference_name = ""
        if options.reference_link:
            link = find_link(scene, options.reference_link, params.block("reference_link_name"))
            self._reference_name = "" if link is None else link.scoped

    def load(self, parent: Model, params: Params) -> None:
        options = self._settings
        self.link = self.sim.link(self._link_name)
        self._reference = self.sim.link(self._reference_name) if self._reference_name else None
        self._frame_pose: Pose | None = Pose()
        if self._reference is None and options.reference_frame != "world":
            self._frame_pose = _NED_POSE if options.reference_frame == _NED else None
            self.listen("/tf_static", TRANSFORMS, self._on_transforms)
        self._is_on, self._last, self._readings = options.is_on, 0.0, 0
        self._stream = self.random("noise", self.width)
        base = f"/{options.namespace.strip('/')}/{options.topic.strip('/')}"
        self._state = self.advertise(f"{base}/state", _BOOL)
        self.offer(f"{base}/change_state", _CHANGE, self._change)
        if options.has_ned_frame:
            self._publish_frame()
        self.start(base)

    @abstractmethod
    def start(self, base: str) -> None:
        """Open the topics of the readings, whose names begin with `base`."""

    @abstractmethod
    def measure(self, drawn: Vector, elapsed: float) -> None:
        """Publish a reading.

        Args:
            drawn: normal numbers with the standard deviation 1, shape (width,).
            elapsed: time since the last reading [s].
        """

    def noise(self, drawn: Vector) -> Vector:
        """Return the noise of a vector, from normal numbers."""
        noise: Vector = self._settings.amplitude * self._settings.sigma * drawn
        return noise

    @property
    def frame_id(self) -> str:
        """Frame of vectors."""
        return self.link.name + ("_ned" if self._settings.has_ned_frame else "")

    @property
    def reference_pose(self) -> Pose:
        """Pose of the frame of positions, in the world."""
        pose = self._reference.pose if self._reference is not None else self._frame_pose
        return Pose() if pose is None else pose

    @property
    def reference_frame_id(self) -> str:
        """Name of the frame of positions."""
        return self._reference.name if self._reference is not None else self._settings.reference_frame

    def in_axes_of_link(self, vector: Vector) -> Vector:
        """Return a vector in the link's axes in those of `frame_id`."""
        return REVERSED * vector if self._settings.has_ned_frame else vector

    def _publish_frame(self) -> None:
        w, x, y, z = quat_from_rpy(math.pi, 0.0, 0.0).tolist()
        transform = {
            "header": msgs.header(self.sim.time_ns, self.link.name),
            "child_frame_id": f"{self.link.name}_ned",
            "transform": {"rotation": {"x": x, "y": y, "z": z, "w": w}},
        }
        self.advertise("/tf_static", TRANSFORMS, latched=True).publish(msgs.make(TRANSFORMS, transforms=[transform]))

    def _on_transforms(self, message: Message) -> None:
        for transform in message.transforms:
            names = transform.header.frame_id.strip("/"), transform.child_frame_id.strip("/")
            if names == ("world", self._settings.reference_frame):
                place, turn = transform.transform.translation, transform.transform.rotation
                self._frame_pose = Pose((place.x, place.y, place.z), (turn.w, turn.x, turn.y, turn.z))

    def _change(self, request: Message) -> dict[str, object]:
        self._is_on = bool(request.on)
        return {"success": True, "message": f"{self._settings.topic}: {'on' if self._is_on else 'off'}"}

    def after_step(self) -> None:
        """Publish the state, and a reading if it is due."""
        if self._state.wanted:
            self._state.publish(msgs.make(_BOOL, data=self._is_on))
        elapsed = self.sim.time - self._last
        if not self._is_on or self._frame_pose is None or elapsed < 1.0 / self._settings.rate - 1e-9:
            return
        self._last = self.sim.time
        self.measure(np.asarray(self._stream.normal(self._readings)), elapsed)
        self._readings += 1
