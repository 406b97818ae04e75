"""States that the robot Baxter publishes: its arms, head, grippers, and whether it is enabled.

The numbers of a gripper's properties are those of the electric gripper in `baxter_emulator.cpp` of
RethinkRobotics/baxter_simulator.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from functools import partial
from typing import TYPE_CHECKING, Any, Final, Protocol

import mujoco
import numpy as np

from simkit import Pose, msgs
from simkit.extend import SharedByCopies, Vector
from simkit.matrix_decompositions import lstsq
from simkit_control.plugins.ros2_control.gravity_efforts import GravityEfforts
from simkit_control.plugins.ros2_control.hardware_interfaces import EFFORT, POSITION, VELOCITY
from simkit_robots.controllers.baxter_controllers import (
    BaxterGripperController,
    finger_joint,
    limb_joints,
)

if TYPE_CHECKING:
    from simkit import Link, Model, Publisher, Simulation
    from simkit.msgs import Message
    from simkit_control.plugins.ros2_control.controller_manager import ControllerManager
    from simkit_control.plugins.ros2_control.hardware import Hardware

_CORE: Final = "baxter_core_msgs/msg/"
_TIPS: Final = ("{}_gripper", "{}_gripper_tip", "{}_gripper_base", "{}_hand")
"""Links that can be the end of an arm; the first of them that the robot has is used."""
_GRIPPER_ID: Final = 65538
_ELECTRIC: Final = 2
_TURNING: Final = 0.045  # speed of the head above which it turns [rad/s]: 0.0009 rad between two joint states
_MOVING: Final = 0.02  # speed of a gripper above which it moves, as a share of its travel per second
_STOP_UNKNOWN: Final = 2


class BaxterPlugin(Protocol):
    """Plugin that drives the robot.

    Attributes:
        sim: simulation.
        hardware: joints of the robot.
        manager: controller manager.
        enabled: true if the robot follows commands.
        stopped: true after a stop, until the next reset.
        nods_until: end of the present nod [ns].
    """

    sim: Simulation
    hardware: Hardware
    manager: ControllerManager
    enabled: bool
    stopped: bool
    nods_until: int

    def advertise(self, topic: str, type_name: str) -> Publisher:
        """Open a publisher."""

    def controller(self, name: str) -> Any:
        """Return a controller by its name."""


class BaxterStates(SharedByCopies):
    """Publishers of the robot's states; a message is built only for a topic with subscribers.

    Args:
        plugin: plugin that drives the robot.
        model: robot.
        sides: sides with an arm, left or right.
        gripper_sides: sides with an electric gripper.
        has_head: true if the robot has the joint of the head.
    """

    def __init__(
        self, plugin: BaxterPlugin, model: Model, sides: Sequence[str], gripper_sides: Sequence[str], *, has_head: bool
    ) -> None:
        self._plugin, self._sim, self._model = plugin, plugin.sim, model
        self._outputs: list[tuple[Publisher, Callable[[], Message]]] = []
        self._gravity = {side: GravityEfforts(self._sim, self._scoped(side)) for side in sides}
        self._add("state", "AssemblyState", self._assembly)
        for side in sides:
            self._add(f"limb/{side}/endpoint_state", "EndpointState", partial(self._endpoint, side))
            self._add(f"limb/{side}/gravity_compensation_torques", "SEAJointState", partial(self._torques, side))
        for side in gripper_sides:
            gripper = f"end_effector/{side}_gripper"
            self._add(f"{gripper}/state", "EndEffectorState", partial(self._gripper, side))
            self._add(f"{gripper}/properties", "EndEffectorProperties", self._properties)
        if has_head:
            self._add("head/head_state", "HeadState", self._head)

    def _add(self, topic: str, kind: str, message: Callable[[], Message]) -> None:
        self._outputs.append((self._plugin.advertise(topic, f"{_CORE}{kind}"), message))

    def _scoped(self, side: str) -> list[str]:
        return [self._plugin.hardware.joints[joint].scoped for joint in limb_joints(side)]

    def publish(self) -> None:
        """Publish the present states."""
        for publisher, message in self._outputs:
            if publisher.wanted:
                publisher.publish(message())

    # ------------------------------------------------------------------ robot and head

    def _assembly(self) -> Message:
        plugin = self._plugin
        source = _STOP_UNKNOWN if plugin.stopped else 0
        fields = {"ready": plugin.enabled, "enabled": plugin.enabled, "stopped": plugin.stopped}
        return msgs.make(f"{_CORE}AssemblyState", **fields, estop_source=source)

    def _head(self) -> Message:
        plugin = self._plugin
        joint = plugin.hardware.joints["head_pan"].handle
        position, velocity, _ = joint.reading()
        return msgs.make(
            f"{_CORE}HeadState",
            pan=float(position),
            is_turning=abs(float(velocity)) > _TURNING,
            is_nodding=self._sim.time_ns < plugin.nods_until,
            is_pan_enabled=plugin.enabled,
        )

    # ------------------------------------------------------------------ arms

    def _readings(self, side: str) -> tuple[Vector, Vector, Vector]:
        """Return positions [rad], velocities [rad/s] and efforts [N·m] of an arm."""
        hardware, joints = self._plugin.hardware, limb_joints(side)
        position, velocity, effort = (hardware.reading(kind, joints)() for kind in (POSITION, VELOCITY, EFFORT))
        return position, velocity, effort

    def _torques(self, side: str) -> Message:
        plugin = self._plugin
        position, velocity, effort = self._readings(side)
        gravity = self._gravity[side].efforts() if plugin.enabled else np.zeros(len(position))
        commanded = {
            kind: plugin.controller(f"{side}_joint_{kind}_controller").commanded
            if plugin.manager.controllers[f"{side}_joint_{kind}_controller"].state == "active"
            else np.zeros(len(position))
            for kind in ("position", "velocity", "effort")
        }
        return msgs.make(
            f"{_CORE}SEAJointState",
            header=msgs.header(self._sim.time_ns, "base"),
            name=list(limb_joints(side)),
            **{f"commanded_{kind}": values for kind, values in commanded.items()},
            actual_position=position,
            actual_velocity=velocity,
            actual_effort=effort,
            gravity_model_effort=gravity,
            gravity_only=gravity,
        )

    def _base_pose(self) -> Pose:
        links = self._model.links
        return links["base"].pose if "base" in links else self._model.pose

    def _endpoint(self, side: str) -> Message:
        tip, into_base = tip_of(self._model, side), self._base_pose().inverse()
        pose = into_base @ tip.pose
        turn = Pose(quaternion=into_base.quaternion)
        linear, angular = turn.transform(tip.linear_velocity), turn.transform(tip.angular_velocity)
        wrench = self._wrench(side, tip)
        force, torque = turn.transform(wrench[:3]), turn.transform(wrench[3:])
        return msgs.make(
            f"{_CORE}EndpointState",
            header=msgs.header(self._sim.time_ns, "base"),
            pose={"position": _xyz(pose.position), "orientation": dict(zip("wxyz", pose.quaternion, strict=True))},
            twist={"linear": _xyz(linear), "angular": _xyz(angular)},
            wrench={"force": _xyz(force), "torque": _xyz(torque)},
        )

    def _wrench(self, side: str, tip: Link) -> Vector:
        """Return force [N] and torque [N·m] of the surroundings on the end of an arm at rest, in the world frame.

        They follow from the efforts that gravity and the damping of the joints do not explain.
        """
        physics, names = self._sim.engine.physics, self._sim.engine.names
        _, velocity, effort = self._readings(side)
        gravity = self._gravity[side].efforts()
        model, data = physics.model, physics.fresh()
        dofs = [names.joint(name).dofs[0] for name in self._scoped(side)]
        jacobian = np.zeros((6, model.nv))
        point = np.array(tip.pose.position, float)
        mujoco.mj_jac(model, data, jacobian[:3], jacobian[3:], point, names.link(tip.scoped).body)
        unexplained = gravity - effort + model.dof_damping[dofs] * velocity
        return lstsq(jacobian[:, dofs].T, unexplained, rcond=1e-3)

    # ------------------------------------------------------------------ grippers

    def _gripper(self, side: str) -> Message:
        plugin = self._plugin
        gripper: BaxterGripperController = plugin.controller(f"{side}_gripper_controller")
        joint = plugin.hardware.joints[finger_joint(side)]
        position, velocity, effort = (float(value) for value in joint.handle.reading())
        opening = gripper.opening(position)
        is_moving = abs(velocity) > _MOVING * (joint.upper - joint.lower)
        has_target = plugin.enabled and gripper.target == gripper.target  # NaN before the first activation
        is_gripping = has_target and not is_moving and abs(gripper.target - opening) > gripper.dead_zone
        is_missed = has_target and not is_moving and gripper.target == 0.0 and opening < gripper.dead_zone
        command, sender, sequence = gripper.last
        return msgs.make(
            f"{_CORE}EndEffectorState",
            timestamp=msgs.time(self._sim.time_ns),
            id=_GRIPPER_ID,
            enabled=int(plugin.enabled),
            calibrated=int(gripper.is_calibrated),
            ready=int(plugin.enabled and gripper.is_calibrated),
            moving=int(is_moving),
            gripping=int(is_gripping),
            missed=int(is_missed),
            position=100.0 * opening,
            force=min(100.0, 100.0 * abs(effort) / joint.max_effort) if joint.max_effort > 0.0 else 0.0,
            command=command,
            command_sender=sender,
            command_sequence=sequence,
        )

    def _properties(self) -> Message:
        able = ("controls_grip", "senses_grip", "controls_position", "senses_position", "senses_force")
        return msgs.make(
            f"{_CORE}EndEffectorProperties",
            id=_GRIPPER_ID,
            ui_type=_ELECTRIC,
            manufacturer="Rethink Research Robot",
            product="SDK End Effector",
            **dict.fromkeys(able, True),
        )


def tip_of(model: Model, side: str) -> Link:
    """Return the link at the end of an arm: between the tips of the fingers, or the hand of a robot without them."""
    names = [name.format(side) for name in _TIPS]
    last = model.joints[f"{side}_w2"].scene.child_link
    return next(model.links[name] for name in (*names, last.rpartition("::")[2]) if name in model.links)


def _xyz(values: Vector) -> dict[str, float]:
    return dict(zip("xyz", (float(v) for v in values), strict=True))
