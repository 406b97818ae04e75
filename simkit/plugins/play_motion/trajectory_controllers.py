"""Who moves which joint: the active controllers that follow trajectories, and what else may be asked of a robot."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

from simkit.plugins.ros2_control.control_plugin import ControlPlugin
from simkit.plugins.ros2_control.controllers.joint_trajectory import JointTrajectoryController

if TYPE_CHECKING:
    from simkit.runtime import Model, Simulation
    from simkit.scene.model import Mimic


@dataclass(frozen=True, slots=True)
class TrajectoryController:
    """An active controller that follows trajectories.

    Attributes:
        name: the controller's.
        action: name of its action.
        joints: all that it moves, in its order.
    """

    name: str
    action: str
    joints: tuple[str, ...]


def active_controllers(sim: Simulation, robot: Model) -> list[TrajectoryController]:
    """The active trajectory controllers of a robot, in the order in which they were loaded."""
    found = []
    for host in sim.structure.all_plugins():
        if (
            not isinstance(host, ControlPlugin)
            or not _is_within(host.scoped, robot.scoped)
            or not hasattr(host, "manager")
        ):
            continue
        for name, loaded in host.manager.controllers.items():
            controller: Any = loaded.controller
            if loaded.state != "active" or not isinstance(controller, JointTrajectoryController):
                continue
            joints = dict.fromkeys(one.rpartition("/")[0] for one in controller.command_interfaces() if "/" in one)
            action = host.ros.topic(controller.topic("~/follow_joint_trajectory"))
            found.append(TrajectoryController(name, action, tuple(joints)))
    return found


def _is_within(scoped: str, robot: str) -> bool:
    return scoped == robot or scoped.startswith(f"{robot}::")


def unclaimed_joints(robot: Model, joints: Sequence[str], movers: Sequence[TrajectoryController]) -> list[str]:
    """Which of these joints no active controller moves, itself or by a joint that they mimic."""
    moved = {joint for mover in movers for joint in mover.joints}
    laws = {joint: mimic_of(robot, joint) for joint in joints if joint not in moved}
    return [joint for joint, law in laws.items() if law is None or leader_name(law) not in moved]


def mimic_of(robot: Model, joint: str) -> Mimic | None:
    """How a joint follows another one; None where it follows none."""
    axes = robot.joints[joint].scene.axes if joint in robot.joints else ()
    return axes[0].mimic if axes else None


def leader_name(law: Mimic) -> str:
    """The plain name of the joint that is followed."""
    return law.joint.rpartition("::")[2]
