"""Joint positions that satisfy the goal constraints of a request."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np

from simkit import Pose, msgs
from simkit.errors import InputError
from simkit.extend import Vector, counted
from simkit.pose import IDENTITY
from simkit_control.plugins.ros2_control.head_pointing import frame_pose
from simkit_motion.plugins.move_group.error_codes import Code, PlanningFailed
from simkit_motion.plugins.move_group.inverse_kinematics import PoseGoal
from simkit_motion.plugins.move_group.planning import Group, Planner, find_link, root_link
from simkit_motion.plugins.move_group.state_copy import se3

if TYPE_CHECKING:
    from simkit import Model, Simulation
    from simkit.msgs import Message


@dataclass(frozen=True, slots=True)
class Frames:
    """Frames of requests, at their present poses.

    Attributes:
        sim: Simulation.
        robot: Robot whose frames are searched first.
        root_name: Further name of the robot's root link, which counts if there is no such frame.
    """

    sim: Simulation
    robot: Model
    root_name: str = ""

    def pose(self, name: str) -> Pose:
        """Return the present pose of a frame in the world; an empty name is the root link of the robot.

        Raises:
            PlanningFailed: The frame does not exist.
        """
        try:
            return frame_pose(self.sim, self.robot.scoped, name or root_link(self.robot))
        except InputError as error:
            if name.lstrip("/") == self.root_name:
                return self.pose("")
            raise PlanningFailed(Code.FRAME_TRANSFORM_FAILURE, str(error)) from None

    def in_world(self, frame: str, message: Message) -> Pose:
        """Return a `geometry_msgs/msg/Pose` of a frame in the world.

        Raises:
            PlanningFailed: The frame does not exist, a number is NaN or infinite, or the quaternion is zero.
        """
        return self.pose(frame) @ pose_of_message(message)


def pose_of_message(message: Message) -> Pose:
    """Convert a `geometry_msgs/msg/Pose`.

    Raises:
        PlanningFailed: A number is NaN or infinite, or the quaternion is zero.
    """
    try:
        return msgs.pose(message)
    except InputError as error:
        raise PlanningFailed(Code.INVALID_GOAL_CONSTRAINTS, str(error)) from None


def goal_positions(planner: Planner, group: Group, constraints: Message, frames: Frames) -> list[Vector]:
    """Return joint positions that satisfy a `moveit_msgs/msg/Constraints`, the nearest to the start first.

    The tolerances of the constraints are not used: the goal is their centre.

    Raises:
        PlanningFailed: The constraints are invalid or unsupported, or no joint positions satisfy them.
    """
    joints, positions = constraints.joint_constraints, constraints.position_constraints
    turns = constraints.orientation_constraints
    if len(constraints.visibility_constraints):
        raise PlanningFailed(Code.INVALID_GOAL_CONSTRAINTS, "visibility constraints are not supported")
    if len(joints) and not len(positions) and not len(turns):
        return [planner.joint_positions(joints)]
    if len(joints) or len(positions) > 1 or len(turns) > 1 or not (len(positions) or len(turns)):
        counts = (
            f"found {len(joints)} joint, {len(positions)} position and {counted(len(turns), 'orientation constraint')}"
        )
        needed = "a goal needs joint constraints, or at most one position and one orientation constraint"
        raise PlanningFailed(Code.INVALID_GOAL_CONSTRAINTS, f"{needed}; {counts}")
    if len(positions):
        goal = _pose_goal(group, positions[0], turns, frames)
    else:
        goal = _rotation_goal(group, turns[0], frames)
    return planner.pose_solutions(goal, planner.model.start, avoids_collisions=True)


def _pose_goal(group: Group, place: Message, turns: Sequence[Message], frames: Frames) -> PoseGoal:
    """Return the goal of a position constraint, at the centre of its region, and an orientation constraint."""
    regions = place.constraint_region.primitive_poses
    if len(regions) != 1:
        text = f"a position constraint needs one pose in constraint_region.primitive_poses; found {len(regions)}"
        raise PlanningFailed(Code.INVALID_GOAL_CONSTRAINTS, text)
    target = Pose(frames.in_world(place.header.frame_id, regions[0]).position, IDENTITY.quaternion)
    if len(turns):
        if turns[0].link_name not in ("", place.link_name):
            text = f"position of {place.link_name!r} but orientation of {turns[0].link_name!r}"
            raise PlanningFailed(Code.INVALID_GOAL_CONSTRAINTS, f"constraints of different links: {text}")
        turn = msgs.make("geometry_msgs/msg/Pose", orientation=turns[0].orientation)
        target = Pose(target.position, frames.in_world(turns[0].header.frame_id, turn).quaternion)
    link = find_link(frames.robot, place.link_name or group.tip)
    p = place.target_point_offset
    return PoseGoal(link, se3(target), np.array([p.x, p.y, p.z], dtype=float), bool(len(turns)))


def _rotation_goal(group: Group, turn: Message, frames: Frames) -> PoseGoal:
    """Return the goal of an orientation constraint; the position is free."""
    pose = frames.in_world(turn.header.frame_id, msgs.make("geometry_msgs/msg/Pose", orientation=turn.orientation))
    return PoseGoal(find_link(frames.robot, turn.link_name or group.tip), se3(pose), np.zeros(3), places=False)
