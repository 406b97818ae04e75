"""Joint state publishers: `libgazebo_ros_joint_state_publisher.so` and gz's JointStatePublisher."""

from __future__ import annotations

from collections.abc import Callable
from functools import lru_cache, partial
from typing import TYPE_CHECKING

import numpy as np

from simkit import msgs
from simkit.msgs.cdr_template import CdrTemplate, packs
from simkit.msgs.topic_names import valid_topic
from simkit.params import Params
from simkit.plugins.base import ModelPlugin
from simkit.plugins.endpoints import publishes
from simkit.plugins.find_entities import find_joint
from simkit.plugins.options import Options, OptionsOf, number, text, texts
from simkit.runtime.array_rules import CannotBatchError, PluginRule, PresentNumbers, TopicRule

if TYPE_CHECKING:
    from collections.abc import Sequence

    from simkit.compiler import SpecBuilder
    from simkit.pose import Vector
    from simkit.runtime import Joint, Model
    from simkit.runtime.state_arrays import StateArrays
    from simkit.scene import SceneJoint, SceneModel

JOINT_STATE = "sensor_msgs/msg/JointState"
JointReading = tuple[str, "float | Vector", "float | Vector", "float | Vector"]
"""Name, position, velocity and applied effort of a joint."""
_NS = 1_000_000_000
_MOST_GROUPS = 256  # templates that are kept, one for each group of joints


def joint_readings(joints: Sequence[Joint]) -> list[JointReading]:
    """Return the current name, position, velocity and applied effort of each joint."""
    return [(joint.name, *joint.reading()) for joint in joints]


def joint_state_message(time_ns: int, joints: list[JointReading]) -> msgs.JointState:
    """Return a `sensor_msgs/msg/JointState` with the values from `joint_readings`, in the same order.

    A joint with several degrees of freedom becomes several joints `name[0]`, `name[1]`, …. A fixed joint has the
    position, velocity and effort 0.
    """
    if joints and all(type(position) is float for _, position, _, _ in joints):  # the usual case
        first, *numbers_of_all = zip(*joints, strict=True)
        simple: msgs.JointState = msgs.type_of(JOINT_STATE)(
            msgs.header(time_ns, ""), list(first), *map(np.array, numbers_of_all)
        )
        return simple
    names: list[str] = []
    columns: tuple[list[float], list[float], list[float]] = ([], [], [])
    for name, *values in joints:
        read = [[v] if isinstance(v, float) else list(v) for v in values]
        count = len(read[0])
        names += [name] if count < 2 else [f"{name}[{i}]" for i in range(count)]
        for column, numbers in zip(columns, read, strict=True):
            column += numbers or [0.0]
    arrays = (np.array(column) for column in columns)
    message: msgs.JointState = msgs.type_of(JOINT_STATE)(msgs.header(time_ns, ""), names, *arrays)
    return message


@packs(joint_state_message)
def _pack_joint_states(time_ns: int, joints: list[JointReading]) -> tuple[str, bytes]:
    if not joints or any(type(position) is not float for _, position, _, _ in joints):
        return JOINT_STATE, msgs.serialize(joint_state_message(time_ns, joints))
    names, positions, velocities, efforts = zip(*joints, strict=True)
    return JOINT_STATE, _joint_states_packer(names)(*divmod(time_ns, _NS), *positions, *velocities, *efforts)


@lru_cache(_MOST_GROUPS)
def _joint_states_packer(names: tuple[str, ...]) -> Callable[..., bytes]:
    count = range(len(names))
    fields = (f"{field}[{i}]" for field in ("position", "velocity", "effort") for i in count)
    message = joint_state_message(0, [(name, 0.0, 0.0, 0.0) for name in names])
    return CdrTemplate(message, ("header.stamp.sec", "header.stamp.nanosec", *fields)).packer()


class JointStates(ModelPlugin):
    """Base class of plugins that publish joint states after a step; a subclass chooses the joints and the topic.

    Attributes:
        joint_names: scoped names of the joints.
    """

    joint_names: list[str]
    _handles: list[Joint]
    _topic: str

    def load(self, parent: Model, params: Params) -> None:
        self._handles = [self.sim.joint(name) for name in self.joint_names]
        self._states = self.advertise(self._topic, JOINT_STATE)

    def array_rule(self) -> JointStatesRule:
        return JointStatesRule(self)

    def after_step(self) -> None:
        if self._states.wanted:
            self._states.publish_later(partial(joint_state_message, self.sim.time_ns, joint_readings(self._handles)))


class JointStatesRule(PluginRule):
    """Joint states in n simulations: positions, then velocities."""

    reads_poses = False

    def __init__(self, plugin: JointStates) -> None:
        self._plugin, self._topic = plugin, plugin._states.topic

    def bind(self, states: StateArrays) -> None:
        self._states = states

    def reading(self, topic: str) -> TopicRule | None:
        if topic != self._topic:
            return None
        plugin, states = self._plugin, self._states
        joints = [plugin.sim.engine.names.joint(name) for name in plugin.joint_names]
        if any(len(joint.dofs) != 1 or len(joint.qpos) != 1 for joint in joints):
            raise CannotBatchError("joint states of joints with several degrees of freedom")
        places, dofs = (np.array([getattr(j, name)[0] for j in joints], np.intp) for name in ("qpos", "dofs"))
        grid = plugin.sim.engine.clock.grid(plugin.after_step_rate or 0.0)
        return PresentNumbers(
            grid, lambda ids, _: np.hstack((states.qpos[np.ix_(ids, places)], states.qvel[np.ix_(ids, dofs)]))
        )


class GazeboRosJointStatePublisherOptions(Options):
    """Options of `GazeboRosJointStatePublisher`."""

    joint_name: str = text(required=True)
    joint_name_ros_1: tuple[str, ...] = texts(element="jointName")
    update_rate: float = number(100.0, "Hz", minimum=0.0, ros_1="updateRate")


class GazeboRosJointStatePublisher(JointStates):
    """Publishes the states of the listed joints, in that order, on `joint_states` (Gazebo Classic).

    ROS 1 lists the joints in `<jointName>`, separated by commas.
    """

    options = OptionsOf(GazeboRosJointStatePublisherOptions)
    filenames = ("libgazebo_ros_joint_state_publisher.so",)
    only_publishes = True
    array_rule = JointStates.array_rule

    def prepare(self, scene: SceneModel, params: Params, builder: SpecBuilder) -> None:
        names = [c.value for c in params.all("joint_name")]
        names += [name for value in self.options.joint_name_ros_1 for name in value.replace(",", " ").split()]
        if not names:
            _ = self.options.joint_name
        named_joints = [find_joint(scene, name, params) for name in names]
        self.joint_names = [joint.scoped for joint in named_joints if joint is not None]
        self._topic = "joint_states"
        self.after_step_rate = self.options.update_rate


class JointStatePublisherOptions(Options):
    """Options of `JointStatePublisher`."""

    joint_name: tuple[str, ...] = texts()
    topic: str = text()
    update_rate: float = number(0.0, "Hz", minimum=0)


class JointStatePublisher(JointStates):
    """Publishes the states of the listed joints, or of all joints of the model (gz).

    The topic is `/world/<world>/model/<model>/joint_state`.
    """

    endpoints = (publishes("/world/{world}/model/{model}/joint_state", JOINT_STATE, named_by=("topic",)),)
    options = OptionsOf(JointStatePublisherOptions)
    filenames = ("gz-sim-joint-state-publisher-system",)
    names = ("gz::sim::systems::JointStatePublisher",)
    only_publishes = True
    array_rule = JointStates.array_rule

    def prepare(self, scene: SceneModel, params: Params, builder: SpecBuilder) -> None:
        named = params.all("joint_name")
        named_joints: list[SceneJoint | None] = [find_joint(scene, element.value, params) for element in named]
        joints = [joint.scoped for joint in (named_joints if named else scene.joints) if joint is not None]
        self.joint_names = list(dict.fromkeys(joints))
        for scoped in self.joint_names if len(self.joint_names) < len(joints) else ():
            again = [
                element for element, joint in zip(named, named_joints, strict=True) if joint and joint.scoped == scoped
            ]
            for element in again[1:]:
                message = f"joint {element.value!r} is listed twice; its state is published once"
                params.diagnostics.warning("SK-PLUGIN-063", message, element.where)
        self._topic_in_file = self.options.topic
        self._path = "".join(f"/model/{name}" for name in scene.scoped.split("::"))
        self.after_step_rate = self.options.update_rate

    def load(self, parent: Model, params: Params) -> None:
        self._topic = valid_topic(self._topic_in_file or f"/world/{self.sim.world.name}{self._path}/joint_state")
        super().load(parent, params)
