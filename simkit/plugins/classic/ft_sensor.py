"""Force-torque sensors of Gazebo Classic: `libgazebo_ros_ft_sensor.so`, and ROS 1's `libgazebo_ros_f3d.so`."""

from __future__ import annotations

from functools import partial
from typing import TYPE_CHECKING, ClassVar

import mujoco
import numpy as np

from simkit import msgs
from simkit.linear_algebra import matmul
from simkit.params import LARGEST, Params
from simkit.plugins.base import ModelPlugin
from simkit.plugins.endpoints import publishes
from simkit.plugins.find_entities import find_joint, find_link, find_named_link
from simkit.plugins.options import Options, OptionsOf, number, text, without_effect
from simkit.pose import Vector
from simkit.runtime.handles.joint_mechanics import transmitted_wrench

if TYPE_CHECKING:
    from simkit.compiler import SpecBuilder
    from simkit.runtime import Model
    from simkit.scene import SceneModel

TYPE = "geometry_msgs/msg/WrenchStamped"
_BODY = int(mujoco.mjtObj.mjOBJ_BODY)


class GazeboRosFtSensorOptions(Options):
    """Options of `GazeboRosFtSensor`."""

    ros_1_marks = ("jointName", "topicName", "updateRate")

    joint_name: str = text(required=True, ros_1="jointName")
    topic_name: str = text(element="topicName", required=True)
    update_rate: float = number(0.0, "Hz", minimum=0.0, ros_1="updateRate")
    gaussian_noise: float = number(0.0, minimum=0.0, maximum=LARGEST, ros_1="gaussianNoise")
    body_name: str = text()
    frame_name: str = text("world")


class GazeboRosFtSensor(ModelPlugin):
    """Publishes the wrench in a joint, or the sum of all wrenches on a link, on `wrench` (after `<remapping>`).

    With `<joint_name>`, the message has the wrench of the child link on the joint, about the joint's origin, in the
    axes of the child link, whose name is the `frame_id`. With `<body_name>`, the message has the sum of all wrenches on
    the link, in the world's axes; `<frame_name>` sets only the `frame_id`. This sum includes gravity: the force is the
    link's mass times the acceleration of its centre of mass, and the torque is the rate of change of its angular
    momentum. `<gaussian_noise>` is the standard deviation of the noise on each of the six numbers [N, N·m].

    Attributes:
        reads_contacts: keeps resting bodies awake, because a sleeping body has no contact forces and its weight would
            not be measured.
    """

    endpoints = (publishes("wrench", TYPE, named_by=("topicName",)),)
    options = OptionsOf(GazeboRosFtSensorOptions)
    filenames = ("libgazebo_ros_ft_sensor.so",)
    reads_contacts: ClassVar[bool] = True

    def prepare(self, scene: SceneModel, params: Params, builder: SpecBuilder) -> None:
        options = self.options
        self._topic = options.topic_name if options.is_ros_1 else "wrench"
        self.after_step_rate = options.update_rate
        self._deviation = options.gaussian_noise
        self._joint = self._link = ""
        body = "" if options.is_ros_1 else options.body_name
        if body:
            link = find_link(scene, body, params)
            self._link = link.scoped if link is not None else ""
            self._frame = options.frame_name
            return
        name = options.joint_name
        if not name:
            return
        joint = find_joint(scene, name, params)
        if joint is not None:
            self._joint = joint.scoped
            self._frame = joint.child_link.rsplit("::", 1)[-1]

    def load(self, parent: Model, params: Params) -> None:
        self._out = self.advertise(self._topic, TYPE)
        self._stream = self.random("gaussian_noise", 6) if self._deviation > 0 else None
        self._index = 0

    def after_step(self) -> None:
        self._index += 1  # counted even without subscribers, because the noise depends on this number
        if not self._out.wanted:
            return
        data = self.sim.engine.physics.fresh_accelerations()
        values = np.concatenate(self._of_joint(data) if self._joint else self._of_link(data))
        self._out.publish_later(partial(self._message, self.sim.time_ns, values, self._index))

    def _of_joint(self, data: mujoco.MjData) -> tuple[Vector, Vector]:
        names = self.sim.engine.names
        joint = names.joint(self._joint)
        child = names.link(joint.scene.child_link)
        turn = data.xmat[child.body].reshape(3, 3)
        axes = matmul(turn, child.offset.matrix)
        origin = data.xpos[child.body] + matmul(turn, (child.offset @ joint.pose_child).position)
        force, torque = transmitted_wrench(self.sim.mj_model, data, joint, origin)
        return matmul(-force, axes), matmul(-torque, axes)

    def _of_link(self, data: mujoco.MjData) -> tuple[Vector, Vector]:
        model, body = self.sim.mj_model, self.sim.engine.names.link(self._link).body
        if not body:
            return np.zeros(3), np.zeros(3)
        velocity, acceleration = np.empty(6), np.empty(6)
        # in the principal axes, at the centre of mass; the engine adds gravity as an upward acceleration
        mujoco.mj_objectVelocity(model, data, _BODY, body, velocity, 1)
        mujoco.mj_objectAcceleration(model, data, _BODY, body, acceleration, 1)
        axes, moments, turning = data.ximat[body].reshape(3, 3), model.body_inertia[body], velocity[:3]
        force = model.body_mass[body] * (matmul(axes, acceleration[3:]) + model.opt.gravity)
        torque = moments * acceleration[:3] + np.cross(turning, moments * turning)
        return force, matmul(axes, torque)

    def _message(self, time_ns: int, values: Vector, index: int) -> object:
        if self._stream is not None:
            values = values + self._deviation * self._stream.normal(index)
        names = ("geometry_msgs/msg/Wrench", "geometry_msgs/msg/Vector3")
        wrench, vector = map(msgs.type_of, names)
        force, torque = vector(*values[:3].tolist()), vector(*values[3:].tolist())
        return msgs.type_of(TYPE)(msgs.header(time_ns, self._frame), wrench(force, torque))


class GazeboRosF3DOptions(Options):
    """Options of `GazeboRosF3D`."""

    topic_name: str = text(element="topicName", required=True)
    body_name: str = text(element="bodyName", required=True)
    frame_name: str = text("world", element="frameName")
    always_on: bool = without_effect(element="alwaysOn")


class GazeboRosF3D(GazeboRosFtSensor):
    """Publishes on `<topicName>` the sum of all wrenches on the link `<bodyName>`, at every step.

    The sum is in the world's axes and includes gravity. The force [N] is the link's mass times the acceleration of its
    centre of mass. The torque [N·m] is the rate of change of the link's angular momentum. `<frameName>` (`world`) sets
    only the `frame_id`.
    """

    endpoints = (publishes("{topicName}", "geometry_msgs/msg/WrenchStamped", named_by=("topicName",)),)
    options = OptionsOf(GazeboRosF3DOptions)  # type: ignore[assignment]  # this class reads no option of its base class
    filenames = ("libgazebo_ros_f3d.so",)

    def prepare(self, scene: SceneModel, params: Params, builder: SpecBuilder) -> None:
        self._topic = self.options.topic_name
        self._joint, self._link = "", find_named_link(scene, "bodyName", params)
        self._frame = self.options.frame_name.strip("/") or "world"
        self._deviation = 0.0
        _ = self.options.always_on
