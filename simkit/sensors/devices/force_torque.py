"""Force and torque transmitted through a joint."""

from __future__ import annotations

from dataclasses import dataclass

import mujoco
import numpy as np

from simkit import msgs
from simkit.compiler import Compiled
from simkit.linear_algebra import matmul
from simkit.params import Params
from simkit.pose import Vector
from simkit.runtime.handles.joint_mechanics import torque_about, transmitted_wrench
from simkit.sensors.measured_rows import MeasuredRows
from simkit.sensors.noise import ThreeAxes, read_axes
from simkit.sensors.vector_sensor import VectorSensor

_TYPES = "geometry_msgs/msg/WrenchStamped", "geometry_msgs/msg/Wrench", "geometry_msgs/msg/Vector3"


@dataclass(frozen=True, slots=True)
class ForceTorqueOptions:
    """The `<force_torque>` block.

    Attributes:
        frame: frame of the axes, `parent` link, `child` link or `sensor`; the torque is about the sensor's origin.
        from_parent: True for the wrench that the parent exerts on the child, False for its opposite.
        force, torque: noise per axis [N, N·m].
    """

    frame: str
    from_parent: bool
    force: ThreeAxes
    torque: ThreeAxes


class ForceTorque(VectorSensor["msgs.WrenchStamped"]):
    """Force and torque sensor, `force_torque`, under a joint: the wrench that the parent link exerts on the child link.

    `<measure_direction>` can reverse the wrench. The torque is about the sensor's origin. Gazebo's formula for the
    torque agrees only if the sensor's axes are parallel to the joint frame's, or if the two origins coincide. A world
    with `<gazebo_quirks>` uses Gazebo's formula.
    """

    kinds = ("force_torque",)
    example = "<force_torque/>"
    product, message_type = "forcetorque", _TYPES[0]
    belongs_to = ("joint",)
    sees_scene = False
    has_dynamic_bias = True
    needs_acceleration = True
    # a sleeping load on a static body has no contact forces, so its weight would not be measured
    reads_contacts = True
    options: ForceTorqueOptions

    def read_options(self, params: Params) -> ForceTorqueOptions:
        block = params.block("force_torque")
        direction = block.choice("measure_direction", ("child_to_parent", "parent_to_child"), "child_to_parent")
        return ForceTorqueOptions(
            frame=block.choice("frame", ("child", "parent", "sensor"), "child"),
            from_parent=direction == "parent_to_child",
            force=read_axes(block.block("force")),
            torque=read_axes(block.block("torque")),
        )

    def describe(self) -> dict[str, object]:
        """Return the frame and the direction."""
        direction = "parent_to_child" if self.options.from_parent else "child_to_parent"
        return {"force_torque": {"frame": self.options.frame, "measure_direction": direction}}

    def prepare(self) -> None:
        self.noise = self._make_noise((*self.options.force, *self.options.torque), "force_torque")

    def bind(self, compiled: Compiled) -> None:
        super().bind(compiled)
        names = compiled.names
        joint = self._joint = names.joint(self.scene.parent)
        if joint.moved_body <= 0:
            message = f"sensor {self.scoped!r} reads zero: joint {joint.scoped!r} ({joint.type}) transmits no force"
            hint = (
                "use a joint that holds a link; floating joints, gearboxes and joints of static links transmit no force"
            )
            self.diagnostics.warning("SK-SENSOR-050", message, self.scene.where, hint)
        self._link = names.link(joint.scene.child_link)
        # the wrench is expressed in the axes of this body, rotated by `_axes_turn`; without a link, in the world's axes
        frame = self.options.frame
        link = names.links.get(joint.scene.parent_link) if frame == "parent" else self._link
        self._axes_body = link.body if link is not None else 0
        self._axes_turn: Vector = np.eye(3) if link is None else link.offset.matrix
        if frame == "sensor":
            self._axes_turn = self._offset_rotation
        # joint frame in the child link's body, for Gazebo's formula
        self._joint_frame = self._link.offset @ joint.pose_child
        self._is_turned = not np.array_equal(self._axes_turn, np.eye(3))
        self._viewed: mujoco.MjData | None = None

    def array_rule(self) -> MeasuredRows:
        return MeasuredRows(self)

    def measure(self, model: mujoco.MjModel, data: mujoco.MjData) -> Vector:
        """Return the force [N] and the torque [N·m], six numbers."""
        if data is not self._viewed:
            self._bind_views(model, data)
        if self.sim.world.gazebo_quirks or self._joint.moved_body <= 0:
            force, torque = self._forces(model, data)
        else:  # same as `transmitted_wrench`, on the cached views
            wrench = -self._wrench if self._joint.is_reversed else self._wrench
            force, torque = (
                wrench[3:],
                torque_about(wrench, self._centre, self._position + matmul(self._attitude, self._arm)),
            )
        axes = matmul(self._axes, self._axes_turn) if self._is_turned else self._axes
        if not self.options.from_parent:
            axes = -axes
        return np.concatenate((matmul(force, axes), matmul(torque, axes)))

    def _bind_views(self, model: mujoco.MjModel, data: mujoco.MjData) -> None:
        """Store views of the data that a measurement reads; creating views at every sample would be slower."""
        self._viewed, body, moved = data, self._body, max(self._joint.moved_body, 0)
        self._wrench, self._centre = data.cfrc_int[moved], data.subtree_com[model.body_rootid[moved]]
        self._position, self._attitude = data.xpos[body], data.xmat[body].reshape(3, 3)
        self._arm, self._axes = self._offset_position, data.xmat[self._axes_body].reshape(3, 3)

    def _forces(self, model: mujoco.MjModel, data: mujoco.MjData) -> tuple[Vector, Vector]:
        """Return the force and torque through the joint, about the sensor's origin, in world axes."""
        if self.sim.world.gazebo_quirks:
            return self._as_gazebo(model, data)
        return transmitted_wrench(model, data, self._joint, self._position + matmul(self._attitude, self._arm))

    def _as_gazebo(self, model: mujoco.MjModel, data: mujoco.MjData) -> tuple[Vector, Vector]:
        """Return the force and torque as Gazebo computes them.

        Gazebo multiplies a lever arm in the joint's axes by a force in the sensor's axes.
        """
        body = data.xmat[self._body].reshape(3, 3)
        origin = data.xpos[self._body] + matmul(body, self._joint_frame.position)
        force, torque = transmitted_wrench(model, data, self._joint, origin)
        turn = matmul(body, self._offset_rotation)
        arm = matmul(self._offset_position - self._joint_frame.position, self._joint_frame.matrix)
        return force, torque - matmul(turn, np.cross(arm, matmul(force, turn)))

    def _message_of(self, reading: Vector, time_ns: int) -> msgs.WrenchStamped:
        stamped, wrench, vector = msgs.types_of(*_TYPES)
        force, torque = vector(*reading[:3].tolist()), vector(*reading[3:].tolist())
        message: msgs.WrenchStamped = stamped(msgs.header(time_ns, self.frame_id), wrench(force, torque))
        return message
