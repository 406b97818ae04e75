"""Active trajectory controllers of a robot, and the joints that each of them moves."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import TYPE_CHECKING

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
    """List the active trajectory controllers of a robot in the order in which they were loaded."""
    found = []
    plugins = (plugin for plugin in sim.engine.structure.all_plugins() if isinstance(plugin, ControlPlugin))
    for plugin in plugins:
        if not _is_within(plugin.scoped, robot.scoped) or not hasattr(plugin, "manager"):
            continue
        for name, loaded in plugin.manager.controllers.items():
            controller = loaded.controller
            if loaded.state != "active" or not isinstance(controller, JointTrajectoryController):
                continue
            joints = dict.fromkeys(one.rpartition("/")[0] for one in controller.command_interfaces() if "/" in one)
            action = plugin.ros.topic(controller.topic("~/follow_joint_trajectory"))
            found.append(TrajectoryController(name, action, tuple(joints)))
    return found


def _is_within(scoped: str, robot: str) -> bool:
    return scoped == robot or scoped.startswith(f"{robot}::")


def unclaimed_joints(robot: Model, joints: Sequence[str], controllers: Sequence[TrajectoryController]) -> list[str]:
    """List the joints that no active controller moves, neither itself nor by a joint that they mimic."""
    moved = {joint for controller in controllers for joint in controller.joints}
    laws = {joint: mimic_of(robot, joint) for joint in joints if joint not in moved}
    return [joint for joint, law in laws.items() if law is None or leader_name(law) not in moved]


def mimic_of(robot: Model, joint: str) -> Mimic | None:
    """Return how a joint mimics another one; None where it mimics none."""
    axes = robot.joints[joint].scene.axes if joint in robot.joints else ()
    return axes[0].mimic if axes else None


def leader_name(law: Mimic) -> str:
    """Return the plain name of the joint that is mimicked."""
    return law.joint.rpartition("::")[2]
