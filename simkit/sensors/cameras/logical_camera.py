"""Logical camera: the models in its view and their poses, without an image."""

from __future__ import annotations

import math
from dataclasses import dataclass

import mujoco
import numpy as np
import numpy.typing as npt

from simkit import msgs
from simkit.compiler import Compiled
from simkit.compiler.name_map import NameMap
from simkit.linear_algebra import matmul
from simkit.params import Params
from simkit.pose import Pose, Vector, quat_multiply
from simkit.scene import SceneModel
from simkit.sensors.base import Product, Sensor

IMAGE = "ros_gz_interfaces/msg/LogicalCameraImage"
FRUSTUM = "simkit_msgs/msg/LogicalCameraSensor"

_ROUNDING = 1e-9
"""Tolerance at the frustum's planes [m]; the sensor's own model is often exactly at the frustum's tip."""


@dataclass(frozen=True, slots=True)
class LogicalCameraOptions:
    """The `<logical_camera>` block: a frustum along the sensor's x axis.

    Attributes:
        near, far: distances of its ends along the axis [m].
        horizontal_fov: angle between its left and right side [rad].
        aspect_ratio: ratio of its width to its height.
    """

    near: float
    far: float
    horizontal_fov: float
    aspect_ratio: float


@dataclass(frozen=True, slots=True)
class LogicalImage:
    """Reading of a logical camera.

    Attributes:
        pose: pose of the sensor in the world.
        models: name and pose in the sensor's frame of each model in the frustum, sorted by name.
    """

    pose: Pose
    models: tuple[tuple[str, Pose], ...]


class Frustum:
    """Volume that a logical camera sees.

    Args:
        options: size of the frustum.
        as_gazebo: True computes the planes as Gazebo does. With near = 0 only the far and the right plane remain,
            because Gazebo defines the other planes by coinciding corners.
    """

    def __init__(self, options: LogicalCameraOptions, as_gazebo: bool = False) -> None:
        self._near, self._far = options.near, options.far
        self._across = math.tan(options.horizontal_fov / 2)
        self._up = self._across / options.aspect_ratio
        self._is_broken = as_gazebo and options.near == 0

    def contains(self, points: Vector) -> npt.NDArray[np.bool_]:
        """Check which points, shape (n, 3) [m] in the sensor's frame, are inside or on a plane of the frustum."""
        x, y, z = points.T
        within = (x <= self._far + _ROUNDING) & (-y <= x * self._across + _ROUNDING)
        if not self._is_broken:
            within &= (x >= self._near - _ROUNDING) & (y <= x * self._across + _ROUNDING)
            within &= np.abs(z) <= x * self._up + _ROUNDING
        inside: npt.NDArray[np.bool_] = within
        return inside


class LogicalCamera(Sensor["msgs.LogicalCameraImage"]):
    """Logical camera, `logical_camera`: name and pose of every model with its origin in the frustum, hidden or not.

    gz-sensors has the same rule; Gazebo Classic uses bounding boxes instead. Nested models and the sensor's own model
    are included.
    """

    kinds = ("logical_camera",)
    example = "<logical_camera><far>5</far></logical_camera>"
    options: LogicalCameraOptions

    def read_options(self, params: Params) -> LogicalCameraOptions:
        block = params.block("logical_camera")
        near, far = block.number("near", 0.0, minimum=0.0), block.number("far", 1.0, minimum=0.0)
        if near >= far:
            block.error("SK-PARAM-002", f"found <near> {near:g} and <far> {far:g}; expected near < far")
        fov, aspect = block.number("horizontal_fov", 1.0), block.number("aspect_ratio", 1.0)
        if not 0 < fov < math.pi:
            block.error("SK-PARAM-002", f"found <horizontal_fov> {fov:g}; expected an angle above 0 and below pi")
            fov = 1.0
        if aspect <= 0:
            block.error("SK-PARAM-002", f"found <aspect_ratio> {aspect:g}; expected a number above 0")
            aspect = 1.0
        return LogicalCameraOptions(near, far, fov, aspect)

    def describe(self) -> dict[str, object]:
        """Return the frustum, with lengths in m and the angle in rad."""
        o = self.options
        frustum = {"near": o.near, "far": o.far, "hfov": o.horizontal_fov, "aspect_ratio": o.aspect_ratio}
        return {"logical_camera": frustum}

    def prepare(self) -> None:
        self._frustum = Frustum(self.options, self.sim.world.gazebo_quirks)
        self._pose_types = msgs.Pose, msgs.Point, msgs.Quaternion

    def bind(self, compiled: Compiled) -> None:
        super().bind(compiled)
        carriers: dict[str, tuple[int, Pose]] = {}
        quirks = self.sim.world.gazebo_quirks
        for top in self.sim.engine.structure.models.values():
            poses = {model.scoped: model.pose_world for model in top.all_models()}
            for model in top.all_models():
                # Gazebo publishes only the last part of a model's name, so models with equal last parts replace each
                # other; it also uses a nested model's pose in its parent model as its pose in the world
                if quirks and model is not top:
                    carriers[model.name] = 0, poses[model.scoped.rpartition("::")[0]].inverse() @ model.pose_world
                else:
                    carriers[model.scoped] = self._find_carrier(model, compiled.names)
        self._names = sorted(carriers)
        self._bodies = np.array([carriers[name][0] for name in self._names], dtype=np.intp)
        self._frames = [carriers[name][1] for name in self._names]
        self._origins = np.array([frame.position for frame in self._frames]).reshape(-1, 3)

    def _find_carrier(self, model: SceneModel, names: NameMap) -> tuple[int, Pose]:
        """Return the engine's body that carries a model, and the model's frame in that body."""
        if model.canonical_link not in names.links:  # a model without links has a fixed pose
            return 0, self.sim.model(model.scoped).pose
        body, frame = names.model_frame(model)
        return body, frame

    def products(self) -> dict[str, Product]:
        return {
            "image": Product(IMAGE, self._image_message),
            "frustum": Product(FRUSTUM, self._frustum_message, needs_reading=False),
        }

    def default_topics(self) -> dict[str, str]:
        topic = self._default_topic("logical_camera")
        return {"image": topic, "frustum": topic + "/frustum"}

    def measure(self, model: mujoco.MjModel, data: mujoco.MjData) -> LogicalImage:
        position, rotation = self._frame_in_world(data)
        turn = data.xquat[self._body]
        pose = Pose(position, quat_multiply(turn, self._offset.quaternion))
        bodies = self._bodies
        axes = data.xmat[bodies].reshape(-1, 3, 3)
        origins = data.xpos[bodies] + np.einsum("nij,nj->ni", axes, self._origins)
        inside = np.flatnonzero(self._frustum.contains(matmul(origins - position, rotation)))
        to_sensor = pose.inverse()
        seen = []
        for i in inside.tolist():
            body = bodies[i]
            seen.append((self._names[i], to_sensor @ Pose(data.xpos[body], data.xquat[body]) @ self._frames[i]))
        return LogicalImage(pose, tuple(seen))

    # ------------------------------------------------------------------ messages

    def _pose_message(self, pose: Pose) -> msgs.Pose:
        w, x, y, z = pose.quaternion.tolist()
        make, point, quaternion = self._pose_types
        return make(point(*pose.position.tolist()), quaternion(x, y, z, w))

    def _image_message(self, reading: LogicalImage, time_ns: int) -> msgs.LogicalCameraImage:
        model = msgs.LogicalCameraImageModel
        models = [model(name, self._pose_message(pose)) for name, pose in reading.models]
        return msgs.LogicalCameraImage(msgs.header(time_ns, self.frame_id), self._pose_message(reading.pose), models)

    def _frustum_message(self, _: object, time_ns: int) -> msgs.LogicalCameraSensor:
        o, header = self.options, msgs.header(time_ns, self.frame_id)
        return msgs.LogicalCameraSensor(header, o.near, o.far, o.horizontal_fov, o.aspect_ratio)
