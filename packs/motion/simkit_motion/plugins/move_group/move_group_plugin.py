"""Plugin that answers the services and actions of MoveIt's node `move_group` for one robot."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from typing import TYPE_CHECKING, Final

import numpy as np

from simkit import ModelPlugin, Params, msgs
from simkit.extend import Options, OptionsOf, acts, blocks, choice, did_you_mean, number, offers, text
from simkit.msgs.goal_status import GoalStatus
from simkit_motion.plugins.move_group.cartesian_path import follow_line, limit_tip_speed, line_options
from simkit_motion.plugins.move_group.error_codes import Code, PlanningFailed, check_packages, error_fields
from simkit_motion.plugins.move_group.execution import Execution, course_of_message, split_trajectory
from simkit_motion.plugins.move_group.goal_constraints import Frames, goal_positions
from simkit_motion.plugins.move_group.inverse_kinematics import PoseGoal
from simkit_motion.plugins.move_group.planning import (
    CHECKS_PER_SECOND,
    Group,
    Limits,
    Plan,
    Planner,
    Surroundings,
    find_link,
    refuse_constraints,
    root_link,
    start_positions,
)
from simkit_motion.plugins.move_group.planning_scene import PlanningScene
from simkit_motion.plugins.move_group.state_copy import copied_state, link_pose_at, se3
from simkit_motion.plugins.play_motion.motion_planning import active_controllers

if TYPE_CHECKING:
    from simkit import Model
    from simkit.extend import GoalHandle
    from simkit.msgs import Message

FK: Final = "moveit_msgs/srv/GetPositionFK"
IK: Final = "moveit_msgs/srv/GetPositionIK"
PLAN: Final = "moveit_msgs/srv/GetMotionPlan"
LINE: Final = "moveit_msgs/srv/GetCartesianPath"
APPLY: Final = "moveit_msgs/srv/ApplyPlanningScene"
SCENE: Final = "moveit_msgs/srv/GetPlanningScene"
MOVE: Final = "moveit_msgs/action/MoveGroup"
EXECUTE: Final = "moveit_msgs/action/ExecuteTrajectory"
_FINGERS: Final = ("gripper", "finger", "hand")
_OWN_PLANNER: Final = "RRTConnect"


class GroupOptions(Options):
    """Options of a group of joints.

    `joints` are the names of the joints from the base to the tip. Poses refer to `tip_link`, by default to the link
    that the last joint moves.
    """

    group_name: str = text(element="name", required=True)
    joints: str = text(required=True)
    tip_link: str = text()


class JointLimitOptions(Options):
    """Options of a joint, instead of the limits of the robot's file and of all joints; 0 for those."""

    joint: str = text(required=True)
    max_velocity: float = number(0.0, "rad/s or m/s", minimum=0.0)
    max_acceleration: float = number(0.0, "rad/s² or m/s²", minimum=0.0)


class DisabledCollisionOptions(Options):
    """Options of two links of the robot that are not checked for collisions with each other."""

    link1: str = text(required=True)
    link2: str = text(required=True)


class MoveGroupOptions(Options):
    """Options of `MoveGroup`.

    `robot` is the scoped name of the robot, by default the model of the plugin. `planning_frame` is a further name of
    its root link, which counts if no frame has this name. With `obstacles` = `world`, the collisions of all other
    models are obstacles, besides those of the planning scene. `default_robot_padding` is the distance that a plan keeps
    to obstacles.
    """

    robot: str = text()
    planning_frame: str = text()
    groups: tuple[GroupOptions, ...] = blocks(GroupOptions, element="group")
    joint_limits: tuple[JointLimitOptions, ...] = blocks(JointLimitOptions)
    disable_collisions: tuple[DisabledCollisionOptions, ...] = blocks(DisabledCollisionOptions)
    obstacles: str = choice(("world", "scene"))
    max_acceleration: float = number(2.0, "rad/s²", minimum=1e-3)
    max_linear_acceleration: float = number(0.2, "m/s²", minimum=1e-3)
    default_robot_padding: float = number(0.01, "m", minimum=0.0)


class MoveGroup(ModelPlugin):
    """Answers the services and actions of MoveIt's `move_group`: kinematics, collision-free plans and their execution.

    A group is one of the options, the joints of a trajectory controller (`arm` of `arm_controller`), or several
    controllers (`torso_arm`).

    Attributes:
        robot: Robot.
    """

    filenames = ("libsimkit_move_group.so",)
    names = ("simkit::MoveGroup",)
    options = OptionsOf(MoveGroupOptions)
    endpoints = (
        offers("compute_fk", FK),
        offers("compute_ik", IK),
        offers("plan_kinematic_path", PLAN),
        offers("compute_cartesian_path", LINE),
        offers("apply_planning_scene", APPLY),
        offers("get_planning_scene", SCENE),
        acts("move_action", MOVE),
        acts("execute_trajectory", EXECUTE),
    )
    robot: Model

    def load(self, parent: Model, params: Params) -> None:
        self.options.read_all()
        self.robot = self._declared_robot(parent)
        parent = self.robot
        self._groups = self._declared_groups()
        options = self.options
        own_limits = {each.joint: (each.max_velocity, each.max_acceleration) for each in options.joint_limits}
        padding = options.default_robot_padding
        self._limits = Limits(options.max_acceleration, options.max_linear_acceleration, padding, own_limits)
        self._fingers = tuple(name for name in parent.joints if any(word in name for word in _FINGERS))
        self._scene = PlanningScene(frozenset(frozenset((o.link1, o.link2)) for o in options.disable_collisions))
        self._executions: list[Execution] = []
        self._replaced_planners: list[str] = []
        self.offer("compute_fk", FK, self._answers(self._compute_fk))
        self.offer("compute_ik", IK, self._answers(self._compute_ik))
        self.offer("plan_kinematic_path", PLAN, self._plan_kinematic_path)
        self.offer("compute_cartesian_path", LINE, self._answers(self._compute_cartesian_path))
        self.offer("apply_planning_scene", APPLY, self._apply_planning_scene)
        self.offer("get_planning_scene", SCENE, lambda _: {"scene": self._scene.as_fields(self.robot)})
        self.act("move_action", MOVE, self._on_move, self._on_cancel)
        self.act("execute_trajectory", EXECUTE, self._on_execute, self._on_cancel)

    def _declared_robot(self, parent: Model) -> Model:
        """Return the robot of the options, and report a model that does not exist."""
        name = self.options.robot
        if not name or name in self.sim.models:
            return self.sim.model(name) if name else parent
        near = did_you_mean(name, self.sim.models)
        self.options.params.error("SK-PLAN-001", f"the world has no model {name!r}", near)
        return parent

    def _declared_groups(self) -> dict[str, Group]:
        """Return the groups of the options, and report joints and links that do not exist."""
        groups, robot = {}, self.robot
        for options in self.options.groups:
            joints = tuple(options.joints.split())
            unknown = next((name for name in joints if name not in robot.joints), None)
            if unknown is None and options.tip_link and options.tip_link not in robot.links:
                near = did_you_mean(options.tip_link, robot.links)
                options.params.error("SK-PLAN-001", f"robot {robot.name!r} has no link {options.tip_link!r}", near)
                continue
            if unknown is not None or not joints:
                near = did_you_mean(unknown or "", robot.joints)
                what = f"robot {robot.name!r} has no joint {unknown!r}" if joints else "the group has no joints"
                options.params.error("SK-PLAN-001", what, near)
                continue
            unfit = next((n for n in joints if robot.joints[n].dof != 1 or joints.count(n) > 1), None)
            if unfit is not None:
                what = "is listed twice" if joints.count(unfit) > 1 else "does not have exactly one degree of freedom"
                options.params.error("SK-PLAN-001", f"joint {unfit!r} of group {options.group_name!r} {what}")
                continue
            groups[options.group_name] = self._group(options.group_name, joints, options.tip_link)
        return groups

    def _group(self, name: str, joints: tuple[str, ...], tip: str = "") -> Group:
        last = self.robot.joints[joints[-1]].scene.child_link
        return Group(name, joints, tip or next(n for n, link in self.robot.links.items() if link.scoped == last))

    def _find_group(self, name: str) -> Group:
        """Return a group by name.

        Raises:
            PlanningFailed: There is no such group.
        """
        if name in self._groups:
            return self._groups[name]
        controllers = {c.name.removesuffix("_controller"): c for c in active_controllers(self.sim, self.robot)}
        parts, rest = [], name
        while rest:
            part = max((n for n in controllers if f"{rest}_".startswith(f"{n}_")), key=len, default="")
            if not part:
                known = [*self._groups, *controllers]
                near = did_you_mean(name, known) or "there is " + (", ".join(known) or "none")
                raise PlanningFailed(Code.INVALID_GROUP_NAME, f"there is no group {name!r}; {near}")
            parts.append(part)
            rest = rest[len(part) + 1 :]
        joints = [joint for part in parts for joint in controllers[part].joints]
        in_tree = [n for n in self.robot.joints if n in joints and self.robot.joints[n].dof == 1]
        if not in_tree:
            raise PlanningFailed(Code.INVALID_GROUP_NAME, "the name of the group is empty")
        return self._group(name, tuple(in_tree))

    def _frames(self) -> Frames:
        return Frames(self.sim, self.robot, self.options.planning_frame)

    # ------------------------------------------------------------------ services

    def _answers(self, handler: Callable[[Message], dict[str, object]]) -> Callable[[Message], dict[str, object]]:
        """Return a handler that answers with an error code instead of an exception."""

        def answer(request: Message) -> dict[str, object]:
            try:
                return {**handler(request), "error_code": error_fields(None, self.name)}
            except PlanningFailed as error:
                self.log.info("%s", error)
                return {"error_code": error_fields(error, self.name)}

        return answer

    def _compute_fk(self, request: Message) -> dict[str, object]:
        state = start_positions(self.robot, request.robot_state)
        frame = request.header.frame_id or root_link(self.robot)
        inverse = self._frames().pose(frame).inverse()
        links = [find_link(self.robot, name) for name in request.fk_link_names]
        data = copied_state(self.sim, self.robot, state)
        poses = [inverse @ link_pose_at(self.sim, data, link) for link in links]
        header = {"frame_id": frame, "stamp": msgs.time(self.sim.time_ns)}
        stamped = [{"header": header, "pose": msgs.pose_message(pose)} for pose in poses]
        return {"pose_stamped": stamped, "fk_link_names": list(request.fk_link_names)}

    def _compute_ik(self, request: Message) -> dict[str, object]:
        asked = request.ik_request
        if len(asked.pose_stamped_vector) > 1 or len(asked.ik_link_names) > 1:
            raise PlanningFailed(Code.NO_IK_SOLUTION, "the inverse kinematics of several links is not supported")
        refuse_constraints(asked.constraints, "ik_request")
        group = self._find_group(asked.group_name)
        planner = self._planner(group, asked.robot_state)
        stamped = asked.pose_stamped_vector[0] if len(asked.pose_stamped_vector) else asked.pose_stamped
        names = list(asked.ik_link_names) or [asked.ik_link_name or group.tip]
        pose = self._frames().in_world(stamped.header.frame_id, stamped.pose)
        goal = PoseGoal(find_link(self.robot, names[0]), se3(pose), np.zeros(3))
        first = planner.model.start
        solution = planner.pose_solutions(goal, first, avoids_collisions=bool(asked.avoid_collisions))[0]
        return {"solution": {"joint_state": {"name": list(group.joints), "position": solution.tolist()}}}

    def _plan_kinematic_path(self, request: Message) -> dict[str, object]:
        asked = request.motion_plan_request
        response: dict[str, object] = {"group_name": asked.group_name}
        try:
            plan = self._plan(asked)
        except PlanningFailed as error:
            self.log.info("%s", error)
            return {"motion_plan_response": {**response, "error_code": error_fields(error, self.name)}}
        response |= {"trajectory": plan.as_trajectory(root_link(self.robot)), "trajectory_start": self._start(plan)}
        response |= {"planning_time": plan.checks / CHECKS_PER_SECOND, "error_code": error_fields(None, self.name)}
        return {"motion_plan_response": response}

    # ------------------------------------------------------------------ plans

    def _planner(self, group: Group, state: Message) -> Planner:
        check_packages()
        start = start_positions(self.robot, state)
        is_world, scene = self.options.obstacles == "world", self._scene
        surroundings = Surroundings(is_world, scene.obstacles(), scene.allowed, self._fingers)
        random = self.random("plan").generator(0)  # equal requests in equal states have equal answers
        return Planner(self.sim, self.robot, group, start, surroundings, self._limits, random)

    def _plan(self, asked: Message) -> Plan:
        """Return the plan for a `moveit_msgs/msg/MotionPlanRequest`.

        Raises:
            PlanningFailed: The request is invalid or has no answer.
        """
        group = self._find_group(asked.group_name)
        refuse_constraints(asked.path_constraints)
        if not len(asked.goal_constraints):
            raise PlanningFailed(Code.INVALID_GOAL_CONSTRAINTS, "the request has no goal_constraints")
        planner = self._planner(group, asked.start_state)
        frames = self._frames()
        goals, unreachable = [], []
        for constraints in asked.goal_constraints:  # one of them is enough
            try:
                goals += goal_positions(planner, group, constraints, frames)
            except PlanningFailed as error:
                if error.code not in (Code.NO_IK_SOLUTION, Code.GOAL_STATE_INVALID):
                    raise
                unreachable.append(error)
        if not goals:
            raise unreachable[0]
        self._tell_planner(str(asked.planner_id))
        factors = float(asked.max_velocity_scaling_factor), float(asked.max_acceleration_scaling_factor)
        return planner.plan(goals, float(asked.allowed_planning_time), *factors)

    def _tell_planner(self, name: str) -> None:
        """Write to the log, once for each name, that another planner was requested than the one that plans."""
        if name and _OWN_PLANNER not in name and name not in self._replaced_planners:
            self._replaced_planners.append(name)
            self.log.warning("the planner %r does not exist here; RRT-Connect plans instead", name)

    def _compute_cartesian_path(self, request: Message) -> dict[str, object]:
        group, frames = self._find_group(request.group_name), self._frames()
        planner = self._planner(group, request.start_state)
        link = find_link(self.robot, request.link_name or group.tip)
        poses = [frames.in_world(request.header.frame_id, pose) for pose in request.waypoints]
        joint_types = [self.robot.joints[name].type for name in group.joints]
        line = follow_line(planner.model, link, poses, line_options(request, joint_types))
        factors = float(request.max_velocity_scaling_factor), float(request.max_acceleration_scaling_factor)
        course = planner.time_samples(line.positions, *factors)
        if request.max_cartesian_speed > 0.0:
            fastest = find_link(self.robot, request.cartesian_speed_limited_link or group.tip)
            course = limit_tip_speed(planner.model, fastest, course, float(request.max_cartesian_speed))
        plan = Plan(group.joints, course, line.checks)
        if line.problem:
            self.log.info("the straight line ends after %.1f %%: %s", 100 * line.fraction, line.problem)
        trajectory = plan.as_trajectory(root_link(self.robot))
        return {"solution": trajectory, "start_state": self._start(plan), "fraction": line.fraction}

    def _apply_planning_scene(self, request: Message) -> dict[str, object]:
        try:
            self._scene.apply(request.scene, self._frames())
        except PlanningFailed as error:
            self.log.warning("the planning scene is not changed: %s", error)
            return {"success": False}
        return {"success": True}

    def _start(self, plan: Plan) -> Mapping[str, object]:
        return {"joint_state": {"name": list(plan.joints), "position": plan.course.positions[0].tolist()}}

    # ------------------------------------------------------------------ actions

    def _on_move(self, goal: GoalHandle) -> None:
        try:
            goal.publish_feedback({"state": "PLANNING"})
            if goal.is_done:  # the client removed the robot
                return
            _refuse_scene(goal.request.planning_options.planning_scene_diff)
            plan = self._plan(goal.request.request)
            trajectory = plan.as_trajectory(root_link(self.robot))
            fields: dict[str, object] = {"planned_trajectory": trajectory, "trajectory_start": self._start(plan)}
            fields["planning_time"] = plan.checks / CHECKS_PER_SECOND
            if goal.request.planning_options.plan_only:
                goal.succeed({**fields, "error_code": error_fields(None, self.name)})
                return
            parts = split_trajectory(self.sim, self.robot, plan.joints, plan.course)
        except PlanningFailed as error:
            self._abort(goal, {}, error)
            return
        self._execute(goal, {**fields, "executed_trajectory": trajectory}, parts)

    def _on_execute(self, goal: GoalHandle) -> None:
        try:
            joints, course = course_of_message(self.robot, goal.request.trajectory.joint_trajectory)
            parts = split_trajectory(self.sim, self.robot, joints, course)
        except PlanningFailed as error:
            self._abort(goal, {}, error)
            return
        self._execute(goal, {}, parts)

    def _execute(self, goal: GoalHandle, fields: dict[str, object], parts: Mapping[str, dict[str, object]]) -> None:
        """Send the parts of a trajectory to their controllers."""
        goal.publish_feedback({"state": "MONITOR"})
        if goal.is_done:
            return
        execution = Execution(goal, fields)
        self._executions.append(execution)
        for action, request in parts.items():
            execution.parts.append(self.sim.communication.actions.send(action, request, None, self._on_part_done))

    def _on_part_done(self, part: GoalHandle) -> None:
        run = next((run for run in self._executions if part in run.parts), None)
        if run is None or run.goal.is_done:  # the removal of the robot ends all goals
            return
        if part.status is GoalStatus.SUCCEEDED:
            run.parts.remove(part)
            if not run.parts:
                self._executions.remove(run)
                run.goal.succeed({**run.fields, "error_code": error_fields(None, self.name)})
            return
        self._stop(run)
        reason = part.reason or getattr(part.result, "error_string", "") or part.status.name.lower()
        self._abort(run.goal, run.fields, PlanningFailed(Code.CONTROL_FAILED, f"the controller stopped: {reason}"))

    def _on_cancel(self, goal: GoalHandle) -> bool:
        run = next((run for run in self._executions if run.goal is goal), None)
        if run is None:
            return False
        self._stop(run)
        error = PlanningFailed(Code.PREEMPTED, "the goal was cancelled")
        goal.canceled({**run.fields, "error_code": error_fields(error, self.name)}, str(error))
        return True

    def _stop(self, run: Execution) -> None:
        """Cancel the goals of the controllers; the joints then hold their positions."""
        self._executions.remove(run)
        for part in run.parts:
            if not part.is_done:
                part.cancel()

    def _abort(self, goal: GoalHandle, fields: Mapping[str, object], error: PlanningFailed) -> None:
        self.log.info("%s", error)
        goal.abort({**fields, "error_code": error_fields(error, self.name)}, str(error))


def _refuse_scene(scene: Message) -> None:
    """Refuse a `moveit_msgs/msg/PlanningScene` with objects that would count for one goal only.

    Raises:
        PlanningFailed: The scene has objects.
    """
    if len(scene.world.collision_objects) or len(scene.robot_state.attached_collision_objects):
        text = "objects in planning_options.planning_scene_diff are not supported; help: call apply_planning_scene"
        raise PlanningFailed(Code.FAILURE, text)
