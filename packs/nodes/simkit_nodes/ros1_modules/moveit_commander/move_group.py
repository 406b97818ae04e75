"""Commands for a group of joints."""

from __future__ import annotations

import math
import random
from collections.abc import Iterable, Mapping, Sequence
from typing import Any, Final

from simkit_nodes.ros1_modules.actionlib.simple_action_client import SimpleActionClient
from simkit_nodes.ros1_modules.moveit_commander.conversions import list_to_pose, list_to_pose_stamped, pose_to_list
from simkit_nodes.ros1_modules.moveit_commander.exception import MoveItCommanderException
from simkit_nodes.ros1_modules.moveit_commander.group_settings import GroupSettings
from simkit_nodes.ros1_modules.moveit_commander.move_group_client import MoveGroupClient, action_message, new_message
from simkit_nodes.ros1_modules.rospy.log import logerr, logwarn
from simkit_nodes.rotations import euler_from_quaternion, quaternion_from_euler

__all__ = ["MoveGroupCommander"]

_POSE, _POSE_STAMPED = "geometry_msgs/Pose", "geometry_msgs/PoseStamped"
_JOINT_STATE: Final = "sensor_msgs/JointState"
_SUCCESS, _FAILURE = 1, 99999  # of moveit_msgs/MoveItErrorCodes


def _is(value: object, kind: str) -> bool:
    return getattr(value, "_type", "") == kind


class MoveGroupCommander(GroupSettings):
    """Commands for a group of joints: targets, plans and their execution.

    Args:
        name: name of the group.
        robot_description: name of the parameter with the description of the robot.
        ns: namespace of `move_group`; empty for that of the program.
        wait_for_servers: longest wait for `move_group` [s]; 0 for no limit.

    Raises:
        RuntimeError: there is no such group, no description, or no `move_group`.
    """

    def __init__(
        self, name: str, robot_description: str = "robot_description", ns: str = "", wait_for_servers: float = 5.0
    ) -> None:
        self._client = MoveGroupClient(robot_description, ns)
        super().__init__(self._client.name(f"{robot_description}_planning"))
        self._group = self._client.group(name)
        self._move: SimpleActionClient = self._client.move_client(wait_for_servers)
        self._execution: SimpleActionClient = self._client.execution_client()
        self._tip = self._group.tip
        self._frame = self._client.groups.planning_frame
        self._kind = "joint"
        self._joint_target = {joint: self._default_position(joint) for joint in self._group.active}
        self._poses: dict[str, list[Any]] = {}
        self._remembered: dict[str, list[float]] = {}
        self._start: Any = None

    def _default_position(self, joint: str) -> float:
        limits = self._client.groups.tree.joints[joint]
        return 0.0 if limits.lower <= 0.0 <= limits.upper else (limits.lower + limits.upper) / 2

    # ------------------------------------------------------------------ group

    def get_name(self) -> str:
        """Return the name of the group."""
        return self._group.name

    def get_active_joints(self) -> list[str]:
        """Return the names of the joints that move by themselves."""
        return list(self._group.active)

    def get_joints(self) -> list[str]:
        """Return the names of all joints of the group."""
        return list(self._group.joints)

    def get_variable_count(self) -> int:
        """Return the number of joints that move."""
        return len(self._group.active)

    def has_end_effector_link(self) -> bool:
        """Check whether poses refer to a link."""
        return bool(self._tip)

    def get_end_effector_link(self) -> str:
        """Return the link that poses refer to; empty without one."""
        return self._tip

    def set_end_effector_link(self, link_name: str) -> None:
        """Set the link that poses refer to.

        Raises:
            MoveItCommanderException: the robot has no such link.
        """
        if link_name not in self._client.groups.tree.links:
            raise MoveItCommanderException(f"Unable to set end effector link: there is no link {link_name}")
        self._tip = link_name

    def get_interface_description(self) -> Any:
        """Return the names of the planners."""
        description = new_message("moveit_msgs/PlannerInterfaceDescription")
        description.name, description.planner_ids = "simkit", ["RRTConnect"]
        return description

    def get_pose_reference_frame(self) -> str:
        """Return the frame of poses without a frame."""
        return self._frame

    def set_pose_reference_frame(self, reference_frame: str) -> None:
        """Set the frame of poses without a frame."""
        self._frame = reference_frame

    def get_planning_frame(self) -> str:
        """Return the frame of plans."""
        return self._client.groups.planning_frame

    def _link(self, link: str) -> str:
        if not link and not self._tip:
            raise MoveItCommanderException(f"group {self._group.name} has no end effector, so a pose needs a link")
        return link or self._tip

    # ------------------------------------------------------------------ state

    def get_current_joint_values(self) -> list[float]:
        """Return the positions of the active joints [rad or m]."""
        positions = self._client.positions()
        return [float(positions[joint]) for joint in self._group.active]

    def get_current_pose(self, end_effector_link: str = "") -> Any:
        """Return the pose of a link in the planning frame, a `PoseStamped`."""
        return list_to_pose_stamped(self._pose_list(end_effector_link), self.get_planning_frame())

    def _pose_list(self, link: str) -> list[float]:
        return pose_to_list(self._client.pose(self._link(link)).pose)

    def get_current_rpy(self, end_effector_link: str = "") -> list[float]:
        """Return roll, pitch and yaw of a link in the planning frame [rad]."""
        return list(euler_from_quaternion(self._pose_list(end_effector_link)[3:]))

    def get_random_joint_values(self) -> list[float]:
        """Return random positions within the limits."""
        joints = [self._client.groups.tree.joints[name] for name in self._group.active]
        return [random.uniform(max(joint.lower, -math.pi), min(joint.upper, math.pi)) for joint in joints]

    def get_random_pose(self, end_effector_link: str = "") -> Any:
        """Return the pose of a link at random positions of the joints, a `PoseStamped`."""
        state = self._state(dict(zip(self._group.active, self.get_random_joint_values(), strict=True)))
        pose = self._client.pose(self._link(end_effector_link), state).pose
        return list_to_pose_stamped(pose_to_list(pose), self.get_planning_frame())

    def get_current_state(self) -> Any:
        """Return the state of the robot, a `RobotState`."""
        return self._client.state()

    def get_current_state_bounded(self) -> Any:
        """Return the state of the robot with positions within the limits."""
        return self.enforce_bounds(self._client.state())

    def enforce_bounds(self, robot_state_msg: Any) -> Any:
        """Return a `RobotState` with positions within the limits."""
        names = robot_state_msg.joint_state.name
        joints = [self._client.groups.tree.joints.get(name) for name in names]
        positions = robot_state_msg.joint_state.position
        robot_state_msg.joint_state.position = [
            value if joint is None else min(max(value, joint.lower), joint.upper)
            for joint, value in zip(joints, positions, strict=True)
        ]
        return robot_state_msg

    def _state(self, positions: Mapping[str, float]) -> Any:
        state = new_message("moveit_msgs/RobotState")
        state.joint_state.name, state.joint_state.position = list(positions), [float(v) for v in positions.values()]
        return state

    def set_start_state_to_current_state(self) -> None:
        """Plan from the present state."""
        self._start = None

    def set_start_state(self, msg: Any) -> None:
        """Plan from a `RobotState`."""
        self._start = msg

    # ------------------------------------------------------------------ targets

    def get_joint_value_target(self) -> list[float]:
        """Return the target positions of the active joints."""
        return [self._joint_target[joint] for joint in self._group.active]

    def set_joint_value_target(self, arg1: Any, arg2: Any = None, arg3: Any = None) -> None:
        """Set a target for the joints.

        Args:
            arg1: positions of all active joints, positions by name, a `JointState`, the name of a joint, or a pose,
                for which inverse kinematics gives the positions.
            arg2: position of the named joint; link of the pose.
            arg3: accepted for poses.

        Raises:
            MoveItCommanderException: an argument is invalid, or a position is outside the limits.
        """
        if _is(arg1, _POSE) or _is(arg1, _POSE_STAMPED):
            link = next((arg for arg in (arg2, arg3) if isinstance(arg, str)), "")
            values = self._inverse_kinematics(arg1, link)
        elif isinstance(arg1, str):
            if arg2 is None:
                raise MoveItCommanderException("Joint value expected when joint name specified")
            values = {arg1: float(arg2[0] if isinstance(arg2, (list, tuple)) else arg2)}
        elif arg2 is not None or arg3 is not None:
            raise MoveItCommanderException("Too many arguments specified")
        elif _is(arg1, _JOINT_STATE):
            values = dict(zip(arg1.name, arg1.position, strict=True))
        elif isinstance(arg1, Mapping):
            values = {str(name): float(value) for name, value in arg1.items()}
        elif isinstance(arg1, Iterable):
            given = [float(value) for value in arg1]
            if len(given) != len(self._group.active):
                counts = f"found {len(given)} positions; expected {len(self._group.active)}"
                raise MoveItCommanderException(f"Error setting joint target: {counts}: {', '.join(self._group.active)}")
            values = dict(zip(self._group.active, given, strict=True))
        else:
            raise MoveItCommanderException(f"Unsupported argument of type {type(arg1)}")
        self._set_positions(values)

    def _set_positions(self, values: Mapping[str, float]) -> None:
        tolerance = self._tolerances[0]
        for name, value in values.items():
            joint = self._client.groups.tree.joints.get(name)
            if joint is None:
                raise MoveItCommanderException(f"Error setting joint target: the robot has no joint {name}")
            if not joint.lower - tolerance <= value <= joint.upper + tolerance:
                text = f"joint {name} shall go to {value:g}; its limits are {joint.lower:g} and {joint.upper:g}"
                raise MoveItCommanderException(f"Error setting joint target. Is the target within bounds? {text}")
        self._joint_target.update({name: value for name, value in values.items() if name in self._joint_target})
        self._kind = "joint"

    def _inverse_kinematics(self, pose: Any, link: str) -> dict[str, float]:
        request = self._client.request("GetPositionIK")
        asked = request.ik_request
        asked.group_name, asked.ik_link_name = self._group.name, self._link(link)
        asked.pose_stamped = self._stamped(pose)
        response = self._client.call("compute_ik", "GetPositionIK", request)
        if response.error_code.val != _SUCCESS:
            reason = response.error_code.message
            raise MoveItCommanderException(f"Error setting joint target. Is the IK solver functional? {reason}")
        return dict(zip(response.solution.joint_state.name, response.solution.joint_state.position, strict=True))

    def _stamped(self, pose: Any) -> Any:
        """Return a pose, or a list of 6 or 7 numbers, as a `PoseStamped`."""
        if _is(pose, _POSE_STAMPED):
            return pose
        stamped = new_message(_POSE_STAMPED)
        stamped.header.frame_id = self._frame
        stamped.pose = pose if _is(pose, _POSE) else list_to_pose(pose)
        return stamped

    def _set_poses(self, kind: str, poses: Iterable[Any], link: str) -> None:
        link = self._link(link)
        if link not in self._client.groups.tree.links:
            raise MoveItCommanderException(f"Unable to set target pose: the robot has no link {link}")
        self._poses[link], self._kind = [self._stamped(pose) for pose in poses], kind

    def _target_or_zero(self, link: str) -> Any:
        known = self._poses.get(self._link(link))
        stamped = self._stamped([0.0] * 6)
        if known:
            stamped.pose = list_to_pose(pose_to_list(known[0].pose))
        return stamped

    def set_rpy_target(self, rpy: Sequence[float], end_effector_link: str = "") -> None:
        """Set a target for the orientation of a link: roll, pitch and yaw [rad]; its position is free."""
        if len(rpy) != 3:
            raise MoveItCommanderException("Expected [roll, pitch, yaw]")
        self.set_orientation_target(
            [float(v) for v in quaternion_from_euler(rpy[0], rpy[1], rpy[2])], end_effector_link
        )

    def set_orientation_target(self, q: Sequence[float], end_effector_link: str = "") -> None:
        """Set a target for the orientation of a link: x, y, z, w of a quaternion; its position is free."""
        if len(q) != 4:
            raise MoveItCommanderException("Expected [qx, qy, qz, qw]")
        stamped = self._target_or_zero(end_effector_link)
        turn = stamped.pose.orientation
        turn.x, turn.y, turn.z, turn.w = (float(value) for value in q)
        self._set_poses("orientation", [stamped], end_effector_link)

    def set_position_target(self, xyz: Sequence[float], end_effector_link: str = "") -> None:
        """Set a target for the position of a link [m]; its orientation is free."""
        stamped = self._target_or_zero(end_effector_link)
        place = stamped.pose.position
        place.x, place.y, place.z = (float(value) for value in xyz)
        self._set_poses("position", [stamped], end_effector_link)

    def set_pose_target(self, pose: Any, end_effector_link: str = "") -> None:
        """Set a target for the pose of a link: a pose, or a list of 6 or 7 numbers (see `list_to_pose`)."""
        self._set_poses("pose", [pose], end_effector_link)

    def set_pose_targets(self, poses: Iterable[Any], end_effector_link: str = "") -> None:
        """Set poses of which a link shall reach one."""
        self._set_poses("pose", poses, end_effector_link)

    def shift_pose_target(self, axis: int, value: float, end_effector_link: str = "") -> None:
        """Set the present pose as target, changed along x, y, z (`axis` 0 to 2) or in roll, pitch, yaw (3 to 5)."""
        if not 0 <= axis < 6:
            raise MoveItCommanderException("An axis value between 0 and 5 expected")
        pose = self._pose_list(end_effector_link)
        if axis > 2:
            pose = [*pose[:3], *euler_from_quaternion(pose[3:])]
        pose[axis] += value
        self.set_pose_target(list_to_pose_stamped(pose, self.get_planning_frame()), end_effector_link)

    def clear_pose_target(self, end_effector_link: str) -> None:
        """Remove the target pose of a link."""
        self._poses.pop(end_effector_link, None)

    def clear_pose_targets(self) -> None:
        """Remove all target poses."""
        self._poses.clear()

    def set_random_target(self) -> None:
        """Set random positions of the joints as target."""
        self.set_joint_value_target(self.get_random_joint_values())

    def get_named_targets(self) -> list[str]:
        """Return the names of the states of the group."""
        return [*self._remembered, *self._group.states]

    def set_named_target(self, name: str) -> None:
        """Set a named state as target.

        Raises:
            MoveItCommanderException: the group has no such state.
        """
        self._set_positions(self.get_named_target_values(name))

    def get_named_target_values(self, target: str) -> dict[str, float]:
        """Return the positions of a named state by joint.

        Raises:
            MoveItCommanderException: the group has no such state.
        """
        if target in self._remembered:
            return dict(zip(self._group.active, self._remembered[target], strict=True))
        if target not in self._group.states:
            known = ", ".join(self.get_named_targets()) or "none"
            text = f"Unable to set target {target}. Is the target within bounds? Group {self._group.name} has {known}"
            raise MoveItCommanderException(text)
        return dict(self._group.states[target])

    def remember_joint_values(self, name: str, values: Sequence[float] | None = None) -> None:
        """Store positions of the active joints, by default the present ones, under a name."""
        self._remembered[name] = self.get_current_joint_values() if values is None else list(values)

    def get_remembered_joint_values(self) -> dict[str, list[float]]:
        """Return the stored positions by name."""
        return dict(self._remembered)

    def forget_joint_values(self, name: str) -> None:
        """Remove stored positions."""
        self._remembered.pop(name, None)

    # ------------------------------------------------------------------ motion

    def go(self, joints: Any = None, wait: bool = True) -> bool:
        """Plan and move to the target.

        Args:
            joints: target, as of `set_joint_value_target`, or the name of stored positions; None for the target that
                was set; a bool stands for `wait`.
            wait: False to return at once.

        Returns:
            True if the target was reached, or if the motion began and `wait` is False.
        """
        if isinstance(joints, bool):
            wait, joints = joints, None
        self._take_target(joints)
        self._move.send_goal(self._move_goal(plan_only=False))
        if not wait:
            return True
        self._move.wait_for_result()
        return self._is_success(self._move)

    def _take_target(self, joints: Any) -> None:
        if _is(joints, _POSE):
            self.set_pose_target(joints)
        elif isinstance(joints, str):
            self.set_joint_value_target(self._remembered[joints])
        elif joints is not None:
            self.set_joint_value_target(joints)

    def plan(self, joints: Any = None) -> tuple[bool, Any, float, Any]:
        """Plan to the target.

        Args:
            joints: target, as of `go`.

        Returns:
            Whether a plan was found, the `RobotTrajectory`, the planning time [s] and the `MoveItErrorCodes`.
        """
        self._take_target(joints)
        self._move.send_goal(self._move_goal(plan_only=True))
        self._move.wait_for_result()
        is_found, result = self._is_success(self._move), self._move.get_result()
        if result is None:
            code = new_message("moveit_msgs/MoveItErrorCodes")
            code.val = _FAILURE
            return False, new_message("moveit_msgs/RobotTrajectory"), 0.0, code
        return is_found, result.planned_trajectory, result.planning_time, result.error_code

    def _is_success(self, client: SimpleActionClient) -> bool:
        result = client.get_result()
        if result is not None and result.error_code.val == _SUCCESS:
            return True
        reason = "" if result is None else result.error_code.message
        logwarn("Fail: %s", reason or client.get_goal_status_text() or "the goal was rejected")
        return False

    def construct_motion_plan_request(self) -> Any:
        """Return the request for a plan to the target, a `MotionPlanRequest`."""
        request = new_message("moveit_msgs/MotionPlanRequest")
        request.group_name, request.allowed_planning_time = self._group.name, self._planning_time
        request.num_planning_attempts = self._attempts
        request.planner_id, request.pipeline_id = self._planner, self._pipeline
        request.max_velocity_scaling_factor = self._speed
        request.max_acceleration_scaling_factor = self._acceleration
        request.cartesian_speed_limited_link, request.max_cartesian_speed = self._tip_speed_link, self._tip_speed
        request.path_constraints = self._path_constraints
        request.trajectory_constraints = self._trajectory_constraints
        if self._workspace:
            box = request.workspace_parameters
            box.header.frame_id = self.get_planning_frame()
            for corner, values in ((box.min_corner, self._workspace[:3]), (box.max_corner, self._workspace[3:])):
                corner.x, corner.y, corner.z = (float(value) for value in values)
        if self._start is not None:
            request.start_state = self._start
        request.goal_constraints = [self._joint_constraints()] if self._kind == "joint" else self._pose_constraints()
        return request

    def _joint_constraints(self) -> Any:
        constraints = new_message("moveit_msgs/Constraints")
        for name in self._group.active:
            constraint = new_message("moveit_msgs/JointConstraint")
            constraint.joint_name, constraint.position = name, self._joint_target[name]
            constraint.tolerance_above = constraint.tolerance_below = self._tolerances[0]
            constraint.weight = 1.0
            constraints.joint_constraints.append(constraint)
        return constraints

    def _pose_constraints(self) -> list[Any]:
        """Return constraints for each of the target poses."""
        found = []
        for link, poses in self._poses.items():
            for stamped in poses:
                constraints = new_message("moveit_msgs/Constraints")
                if self._kind != "orientation":
                    constraints.position_constraints = [self._position_constraint(link, stamped)]
                if self._kind != "position":
                    constraints.orientation_constraints = [self._orientation_constraint(link, stamped)]
                found.append(constraints)
        return found

    def _position_constraint(self, link: str, stamped: Any) -> Any:
        constraint, ball = new_message("moveit_msgs/PositionConstraint"), new_message("shape_msgs/SolidPrimitive")
        constraint.header.frame_id, constraint.link_name, constraint.weight = stamped.header.frame_id, link, 1.0
        ball.type, ball.dimensions = ball.SPHERE, [self._tolerances[1]]
        at = new_message(_POSE)
        at.position, at.orientation.w = stamped.pose.position, 1.0
        constraint.constraint_region.primitives, constraint.constraint_region.primitive_poses = [ball], [at]
        return constraint

    def _orientation_constraint(self, link: str, stamped: Any) -> Any:
        constraint = new_message("moveit_msgs/OrientationConstraint")
        constraint.header.frame_id, constraint.link_name, constraint.weight = stamped.header.frame_id, link, 1.0
        constraint.orientation = stamped.pose.orientation
        for axis in "xyz":
            setattr(constraint, f"absolute_{axis}_axis_tolerance", self._tolerances[2])
        return constraint

    def _move_goal(self, *, plan_only: bool) -> Any:
        goal = action_message("MoveGroupGoal")
        goal.request = self.construct_motion_plan_request()
        options = goal.planning_options
        options.plan_only, options.look_around, options.replan = plan_only, self._looks_around, self._replans
        options.planning_scene_diff.is_diff = options.planning_scene_diff.robot_state.is_diff = True
        return goal

    def compute_cartesian_path(
        self,
        waypoints: Iterable[Any],
        eef_step: float,
        jump_threshold: float | bool = 0.0,
        avoid_collisions: Any = True,
        path_constraints: Any = None,
    ) -> tuple[Any, float]:
        """Compute a path along straight lines.

        Args:
            waypoints: poses of the end effector.
            eef_step: largest distance between two positions of the path [m].
            jump_threshold: largest change of a joint in a step as a multiple of the mean; 0 for no limit. A bool
                stands for `avoid_collisions`, and the arguments after it move up, as in newer versions.
            avoid_collisions: True to end before a collision.
            path_constraints: constraints of the path.

        Returns:
            The `RobotTrajectory`, and the fraction of the way; -1 if the path cannot be computed.
        """
        if isinstance(jump_threshold, bool):
            path_constraints = path_constraints if isinstance(avoid_collisions, bool) else avoid_collisions
            jump_threshold, avoid_collisions = 0.0, jump_threshold
        request = self._client.request("GetCartesianPath")
        request.header.frame_id, request.group_name = self._frame, self._group.name
        request.link_name = self._link("")
        request.waypoints = [self._stamped(pose).pose for pose in waypoints]
        request.max_step, request.jump_threshold = float(eef_step), float(jump_threshold)
        request.avoid_collisions = bool(avoid_collisions)
        request.max_velocity_scaling_factor = self._speed
        request.max_acceleration_scaling_factor = self._acceleration
        request.cartesian_speed_limited_link, request.max_cartesian_speed = self._tip_speed_link, self._tip_speed
        if self._start is not None:
            request.start_state = self._start
        if path_constraints is not None:
            request.path_constraints = path_constraints
        response = self._client.call("compute_cartesian_path", "GetCartesianPath", request)
        if response.error_code.val != _SUCCESS:
            logwarn("Fail: %s", response.error_code.message)
            return new_message("moveit_msgs/RobotTrajectory"), -1.0
        return response.solution, response.fraction

    def execute(self, trajectory: Any, wait: bool = True) -> bool:
        """Execute a trajectory.

        Args:
            trajectory: `RobotTrajectory` or `JointTrajectory`.
            wait: False to return at once.

        Returns:
            True if the end was reached, or if the motion began and `wait` is False.
        """
        goal = action_message("ExecuteTrajectoryGoal")
        if _is(trajectory, "trajectory_msgs/JointTrajectory"):
            goal.trajectory.joint_trajectory = trajectory
        else:
            goal.trajectory = trajectory
        self._execution.send_goal(goal)
        if not wait:
            return True
        self._execution.wait_for_result()
        return self._is_success(self._execution)

    def stop(self) -> None:
        """Stop the motion."""
        for client in (self._move, self._execution):
            client.cancel_all_goals()

    # ------------------------------------------------------------------ objects

    def attach_object(self, object_name: str, link_name: str = "", touch_links: Sequence[str] = ()) -> bool:
        """Attach an object of the planning scene to a link, by default to the end effector; return True on success."""
        link = link_name or self._tip or next(iter(self._group.links), "")
        attached = new_message("moveit_msgs/AttachedCollisionObject")
        attached.object.id, attached.link_name, attached.touch_links = object_name, link, list(touch_links) or [link]
        return self._client.apply_attached(attached)

    def detach_object(self, name: str = "") -> bool:
        """Detach an object, the objects of a link, or all objects; return True on success."""
        attached = new_message("moveit_msgs/AttachedCollisionObject")
        attached.object.operation = attached.object.REMOVE
        if name in self._client.groups.tree.links:
            attached.link_name = name
        else:
            attached.object.id = name
        return self._client.apply_attached(attached)

    def pick(self, object_name: str, grasp: Any = (), plan_only: bool = False) -> int:
        """Report that simkit does not plan grasps; return the error code."""
        logerr("simkit does not plan grasps: the object %s is not picked", object_name)
        return _FAILURE

    def place(self, object_name: str, location: Any = None, plan_only: bool = False) -> int:
        """Report that simkit does not plan grasps; return the error code."""
        logerr("simkit does not plan grasps: the object %s is not placed", object_name)
        return _FAILURE
