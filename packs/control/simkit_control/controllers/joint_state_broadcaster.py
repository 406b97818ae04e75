"""Joint state broadcaster: the states of the joints as topics."""

from __future__ import annotations

from collections.abc import Sequence
from typing import TYPE_CHECKING, ClassVar, Final

import numpy as np

from simkit import msgs
from simkit.plugins.ros_parameter_block import read_names
from simkit_control.plugins.ros2_control.controller import Controller
from simkit_control.plugins.ros2_control.hardware_interfaces import EFFORT, POSITION, VELOCITY

if TYPE_CHECKING:
    from simkit.extend import Vector
    from simkit.msgs import DynamicJointState

JOINT_STATE: Final = "sensor_msgs/msg/JointState"
DYNAMIC: Final = "control_msgs/msg/DynamicJointState"
_FIELDS: Final = (POSITION, VELOCITY, EFFORT)


class JointStateBroadcaster(Controller):
    """Publishes state interfaces of the joints on `joint_states` and `dynamic_joint_states`.

    All state interfaces are published, or those that `joints` and `interfaces` select. In `joint_states`, a joint has
    NaN for an interface that it lacks, as in ros2_controllers. Joints in `extra_joints`, which the hardware does not
    have, are published with zeros.
    """

    types: ClassVar[tuple[str, ...]] = ("joint_state_broadcaster/JointStateBroadcaster",)

    def configure(self) -> None:
        params = self.params
        prefix = "~/" if params.boolean("use_local_topics", False) else ""
        self._frame = params.text("frame_id", "")
        self._states = self._chosen_joints(read_names(params, "joints"), read_names(params, "interfaces"))
        mapping = params.block("map_interface_to_joint_state")
        fields = {(mapping.text(field, field) or field): field for field in _FIELDS}
        params.child("use_urdf_to_filter")  # no effect: only joints of the hardware are published
        params.child("publish_dynamic_joint_states")
        owners = [(owner, interface) for owner, _, interface in (name.rpartition("/") for name in self._states)]
        joints = list(dict.fromkeys(owner for owner, interface in owners if interface in fields))
        extra = [name for name in read_names(params, "extra_joints") if name and name not in joints]
        self._names = [*joints, *extra]
        self._columns = np.full((3, len(self._names)), np.nan)
        self._columns[:, len(joints) :] = 0.0
        self._indices = np.array(
            [_FIELDS.index(fields[i]) * len(self._names) + joints.index(o) for o, i in owners if i in fields], np.intp
        )
        self._state_names = [f"{owner}/{interface}" for owner, interface in owners if interface in fields]
        self._by_owner: dict[str, list[tuple[int, str]]] = {}
        for k, (owner, interface) in enumerate(owners):
            self._by_owner.setdefault(owner, []).append((k, interface))
        self._publisher = self.advertise(f"{prefix}joint_states", JOINT_STATE)
        self._dynamic = self.advertise(f"{prefix}dynamic_joint_states", DYNAMIC)

    def _chosen_joints(self, joints: Sequence[str], interfaces: Sequence[str]) -> list[str]:
        """Return the state interfaces to publish; all interfaces, if one of both lists is empty."""
        all_names = self.hardware.states.names
        if any(joints) and any(interfaces):
            return [f"{joint}/{interface}" for joint in joints for interface in interfaces]
        if any(joints) or any(interfaces):
            message = f"controller {self.name!r}: set 'joints' and 'interfaces' together; all interfaces are published"
            self.params.diagnostics.warning("SK-CONTROL-011", message, self.params.where)
        return [name for name in all_names if name.rpartition("/")[0] not in self.hardware.actuators]

    def state_interfaces(self) -> Sequence[str]:
        return self._states

    def activate(self) -> None:
        self._joint_states = self.hardware.states.select(self._state_names)

    def update(self, now_ns: int, period: float) -> None:
        if self._publisher.wanted:
            columns = self._columns.copy()
            columns.ravel()[self._indices] = self._joint_states.values
            position, velocity, effort = columns
            message = msgs.type_of(JOINT_STATE)(
                msgs.header(now_ns, self._frame), self._names, position, velocity, effort
            )
            self._publisher.publish(message)
        if self._dynamic.wanted:
            self._dynamic.publish(self._dynamic_message(now_ns, self.states.values))

    def _dynamic_message(self, now_ns: int, values: Vector) -> DynamicJointState:
        interface_value = msgs.type_of("control_msgs/msg/InterfaceValue")
        values_by_owner = [
            interface_value([interface for _, interface in interfaces], np.array([values[k] for k, _ in interfaces]))
            for interfaces in self._by_owner.values()
        ]
        dynamic: type[DynamicJointState] = msgs.type_of(DYNAMIC)
        return dynamic(msgs.header(now_ns, self._frame), list(self._by_owner), values_by_owner)


class JointStateController(JointStateBroadcaster):
    """Publishes joint states at `publish_rate`, with extra joints as named blocks, as in ROS 1."""

    types = ("joint_state_controller/JointStateController",)

    def configure(self) -> None:
        params = self.params
        self.update_rate = max(1, round(params.number("publish_rate", 50.0, minimum=0.0) or 0.0))
        for element in params.all("extra_joints"):
            if element.children:
                element.value = element.text("name", "")
                for field in (POSITION, VELOCITY, EFFORT):
                    element.child(field)
        super().configure()
