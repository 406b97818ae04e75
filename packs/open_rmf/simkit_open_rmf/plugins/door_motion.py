"""Doors of Open-RMF: one or two leaves that move between the limits of their joints."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING, Final

from simkit.extend import JointAxis, Options, number
from simkit.plugins.find_entities import find_axis_joint
from simkit_open_rmf.plugins.motion_profile import GuidedJoint, read_limits

if TYPE_CHECKING:
    from simkit import Params, Simulation
    from simkit.compiler import ActuatorRef
    from simkit.extend import SceneJoint, SceneModel, SpecBuilder

CLOSED: Final = 0
MOVING: Final = 1
OPEN: Final = 2
"""Values of `rmf_door_msgs/msg/DoorMode` and of the door state in `rmf_lift_msgs`."""

_NO_JOINT: Final = ("", "empty_joint")
_FARTHEST: Final = 1e6  # [m or rad]; larger limits mean no limit


class DoorOptions(Options):
    """Options of a door."""

    v_max_door: float = number(0.2, "m/s or rad/s", minimum=1e-6)
    a_max_door: float = number(0.2, "m/s² or rad/s²", minimum=1e-6)
    a_nom_door: float = number(0.08, "m/s² or rad/s²", minimum=1e-6)
    dx_min_door: float = number(0.01, "m or rad", minimum=1e-4)
    f_max_door: float = number(100.0, "N or N·m", minimum=0.0)


@dataclass(frozen=True)
class Leaf:
    """Leaf of a door.

    Attributes:
        joint: scoped name of its joint.
        closed, opened: positions of the joint [m or rad].
        servo: position servo of the joint.
    """

    joint: str
    closed: float
    opened: float
    servo: ActuatorRef


def read_leaves(scene: SceneModel, params: Params, builder: SpecBuilder, owner: str) -> tuple[Leaf, ...]:
    """Return the leaves of the joints that `<door>` names, and add their servos.

    A left joint is closed at its upper limit, a right joint at its lower limit.
    """
    force = DoorOptions(params).f_max_door
    door = params.child("door")
    if door is None:
        params.text("door", required=True)
        return ()
    _ = door.attribute("name"), door.attribute("type")
    leaves = []
    for side in ("left", "right"):
        name = door.attribute(f"{side}_joint_name")
        joint = None if name in _NO_JOINT else _find_joint(scene, name, door, builder)
        if joint is None:
            continue
        axis = joint.axes[0]
        if max(abs(axis.lower), abs(axis.upper)) > _FARTHEST:
            message = f"joint {name!r} of a door has no limits; the door is open at one limit and closed at the other"
            door.error("SK-PLUGIN-003", message, "add <limit> with <lower> and <upper> to its axis")
            continue
        ends = (axis.upper, axis.lower) if side == "left" else (axis.lower, axis.upper)
        servo = builder.add_position_servo(joint.scoped, max_effort=force, owner=owner)
        leaves.append(Leaf(joint.scoped, *ends, servo))
    if all(door.attribute(f"{side}_joint_name") in _NO_JOINT for side in ("left", "right")):
        message = "<door> names no joint; expected the attribute left_joint_name, right_joint_name or both"
        door.error("SK-PLUGIN-003", message)
    return tuple(leaves)


def _find_joint(scene: SceneModel, name: str, door: Params, builder: SpecBuilder) -> SceneJoint | None:
    """Return a joint of the model, or of the model around it, as for the cabin doors of lifts."""
    if not any(joint.name == name for joint in scene.all_joints()):
        top = builder.records.get(scene.scoped.split("::")[0])
        if top is not None:
            scene = top.scene
    return find_axis_joint(scene, name, door)


class DoorMotion:
    """Motion of the leaves of one door.

    Args:
        name: name of the door in messages.
        leaves: leaves of the door.
        options: options of the door.

    Attributes:
        target: commanded mode, OPEN or CLOSED.
        mode: present mode.
        is_active: true while the door follows a command.
    """

    def __init__(self, name: str, leaves: tuple[Leaf, ...], options: DoorOptions, sim: Simulation) -> None:
        self.name, self._leaves = name, leaves
        accelerations = options.a_nom_door, options.a_max_door
        limits = read_limits(options.params, options.v_max_door, *accelerations, "a_max_door")
        self._joints = [
            GuidedJoint(JointAxis(sim.joint(leaf.joint)), leaf.servo, limits, options.dx_min_door) for leaf in leaves
        ]
        self.target = CLOSED
        self.mode = self._present_mode()
        self.is_active = self.mode != CLOSED

    @property
    def references(self) -> list[tuple[ActuatorRef, float]]:
        """Servos of the leaves and their position references [m or rad]."""
        return [(joint.servo, joint.reference) for joint in self._joints]

    def command(self, target: int) -> None:
        """Open or close the door."""
        if target != self.target or target != self.mode:
            self.target, self.is_active = target, True

    def step(self, period: float) -> None:
        """Advance the references of the leaves by one step of `period` [s], and update the mode."""
        for leaf, joint in zip(self._leaves, self._joints, strict=True):
            joint.advance(leaf.opened if self.target == OPEN else leaf.closed, period)
        self.mode = self._present_mode()
        self.is_active = any(joint.speed for joint in self._joints) or self.mode != self.target

    def _present_mode(self) -> int:
        pairs = list(zip(self._leaves, self._joints, strict=True))
        if all(joint.is_at(leaf.opened) for leaf, joint in pairs):
            return OPEN
        return CLOSED if all(joint.is_at(leaf.closed) for leaf, joint in pairs) else MOVING
