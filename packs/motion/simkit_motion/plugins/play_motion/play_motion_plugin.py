"""Plugin with which a robot plays named motions, as PAL's play_motion does."""

from __future__ import annotations

from collections.abc import Sequence
from contextlib import suppress
from dataclasses import dataclass, field
from pathlib import Path
from typing import TYPE_CHECKING, Final

import numpy as np

from simkit import ModelPlugin, Params, msgs
from simkit.extend import Diagnostics, Where, acts, did_you_mean
from simkit.plugins.endpoints import offers_all
from simkit.plugins.find_entities import find_plugin_file
from simkit.plugins.ros_names import RosNames
from simkit_motion.plugins.play_motion.motion import Motion, limit_violations, motion_of_message, speed_limits
from simkit_motion.plugins.play_motion.motion_files import MotionFile, read_motions
from simkit_motion.plugins.play_motion.motion_planning import (
    APPROACH_SPEED,
    OTHER_ERROR,
    Approach,
    MotionRefused,
    active_controllers,
    add_leader_joints,
    course_from,
    find_joints,
    plan_motion,
    trajectory_goal,
)
from simkit_motion.plugins.play_motion.motion_timing import LARGEST_STRETCH
from simkit_motion.plugins.play_motion.play_motion_services import offer_services

if TYPE_CHECKING:
    from simkit import Model
    from simkit.extend import GoalHandle, SceneModel, SpecBuilder

ROS_2: Final = "play_motion2_msgs/action/PlayMotion2"
ROS_2_RAW: Final = "play_motion2_msgs/action/PlayMotion2Raw"
ROS_1: Final = "play_motion_msgs/action/PlayMotion"
SUCCEEDED, MOTION_NOT_FOUND, CONTROLLER_BUSY, TRAJECTORY_ERROR, GOAL_NOT_REACHED = 1, -1, -3, -5, -6
_TRAJECTORY_RESULTS: Final = {-4: TRAJECTORY_ERROR, -5: GOAL_NOT_REACHED}
_SLOWEST: Final = 0.01  # smallest speed scale that the time limit of a motion takes into account
_GRIPPER_WORDS: Final = ("gripper", "finger", "hand")


@dataclass(slots=True)
class _RunningMotion:
    """Motion that is being played.

    Attributes:
        goal: Goal of the client.
        key: Key of the motion.
        controllers: Names of the controllers that move the joints of the motion.
        duration: Planned duration, including the approach [s].
        until_ns: Simulated time after which the motion counts as failed [ns].
        parts: Goals of the controllers that have not finished yet, by name of the controller.
    """

    goal: GoalHandle
    key: str
    controllers: tuple[str, ...]
    duration: float
    until_ns: int
    parts: dict[str, GoalHandle] = field(default_factory=dict)


class PlayMotion(ModelPlugin):
    """Plays motions through the robot's trajectory controllers, as PAL's play_motion2 (and ROS 1's play_motion) does.

    The approach to the first point respects `approach_velocity` and the limits of the joints. The robot then moves
    smoothly through all points of the motion. A motion is refused if it exceeds the limits of a joint. A motion is also
    refused if links would collide with each other or with the surroundings, except if the goal sets `skip_planning`.

    Attributes:
        robot: Robot that plays the motions.
        known: Motions by key.
    """

    endpoints = (
        acts("play_motion2", ROS_2),
        acts("play_motion2/raw", ROS_2_RAW),
        acts("play_motion", ROS_1),
        *offers_all("play_motion2_msgs", "ListMotions", "IsMotionReady", "IsJointListReady", below="play_motion2/"),
        *offers_all("play_motion2_msgs", "GetMotionInfo", "AddMotion", "RemoveMotion", below="play_motion2/"),
        *offers_all("play_motion_msgs", "ListMotions", "IsAlreadyThere", below="play_motion/"),
    )
    filenames = ("libsimkit_play_motion.so",)
    names = ("simkit::PlayMotion",)
    drives = True
    robot: Model
    known: dict[str, Motion]

    # ------------------------------------------------------------------ parameters and files

    def prepare(self, scene: SceneModel, params: Params, builder: SpecBuilder) -> None:
        contents = MotionFile()
        for element in params.all("motions"):
            path = self._find(element, builder)
            if path is None:
                hint = "add --package-path NAME=DIR for the package, or put the file next to the robot's file"
                element.warning("SK-MOTION-001", f"the motion file {element.value} is not found", hint)
                continue
            contents.update(read_motions(path, params.diagnostics))
        self.known = dict(contents.motions)
        speed = contents.approach_velocity or APPROACH_SPEED
        shortest = contents.approach_min_duration or 0.0
        self._speed = params.number("approach_velocity", speed, minimum=1e-6)
        self._shortest = params.number("approach_min_duration", shortest, minimum=0.0)
        excluded = [name for p in params.all("exclude_from_planning_joints") for name in p.value.split()]
        self._free_joints = tuple(excluded) if excluded else contents.excluded_joints

    def _find(self, element: Params, builder: SpecBuilder) -> Path | None:
        """Find a motion file by its URI, or next to the robot's file.

        The Python API passes plain paths, in any folder. A value of `--set` or of a scenario does not.
        """
        uri = element.value
        file = find_plugin_file(self, uri, builder, ("motions", "config", "../motions"))
        with suppress(OSError, ValueError):  # the URI is not a valid file name
            is_own = file is None and self.where == Where()
            return Path(uri) if is_own and Path(uri).is_file() else file
        return file

    # ------------------------------------------------------------------ loading

    def load(self, parent: Model, params: Params) -> None:
        self.robot = parent
        self._runs: list[_RunningMotion] = []
        named = [n for n in parent.joints if any(word in n for word in _GRIPPER_WORDS)]
        free = named if self._free_joints is None else self._free_joints
        for name in free:
            if name not in parent.joints:
                message = f"exclude_from_planning_joints: {parent.name!r} has no joint {name!r}"
                params.diagnostics.warning("SK-MOTION-006", message, self.where, did_you_mean(name, parent.joints))
        self._approach = Approach(self._speed, self._shortest, frozenset(free))
        for motion in self.known.values():
            self._check(motion, params.diagnostics)
        self._choose_namespace()
        self._open_interfaces()

    def _choose_namespace(self) -> None:
        """Add the robot's name to the namespace if another robot already uses the default names."""
        taken = self.ros.topic("play_motion2")
        if taken not in self.sim.communication.actions.names():
            return
        self.ros = RosNames(self.ros.node, f"{self.ros.namespace}/{self.robot.name}", params=self.params)
        reason = f"another robot uses {taken!r}"
        message = f"robot {self.robot.name!r} plays motions under {self.action_name!r}, because {reason}"
        self.params.note("SK-MOTION-007", message, "give each robot a namespace: <ros><namespace>...</namespace></ros>")

    def _open_interfaces(self) -> None:
        self.act("play_motion2", ROS_2, self._on_goal, self._on_cancel)
        self.act("play_motion2/raw", ROS_2_RAW, self._on_raw_goal, self._on_cancel)
        self.act("play_motion", ROS_1, self._on_goal, self._on_cancel)
        offer_services(self)

    def _check(self, motion: Motion, reports: Diagnostics) -> None:
        """Report a motion that cannot be played or that takes longer than its file states, with the reason."""
        joints = self.robot.joints
        missing = next((n for n in motion.joints if n not in joints or len(joints[n].scene.axes) != 1), None)
        if missing is not None:
            near = did_you_mean(missing, [n for n, joint in joints.items() if len(joint.scene.axes) == 1])
            fault = "does not have exactly one axis" if missing in joints else f"does not exist in {self.robot.name!r}"
            message = f"motion {motion.key!r} cannot be played: joint {missing!r} {fault}"
            reports.warning("SK-MOTION-004", message, motion.where, near)
            return
        beyond = limit_violations(motion, self.robot.joints)
        if beyond:
            message = f"motion {motion.key!r} will be refused, because it exceeds the joint limits: {'; '.join(beyond)}"
            reports.warning("SK-MOTION-004", message, motion.where)
        elif len(motion.times) > 1:
            self._check_speed(motion, reports)

    def _check_speed(self, motion: Motion, reports: Diagnostics) -> None:
        limits, rows = speed_limits(motion, self.robot.joints), np.array(motion.positions)
        slopes = np.abs(np.diff(rows, axis=0)) / np.diff(motion.times)[:, None]
        if not motion.velocities and np.all(slopes * LARGEST_STRETCH <= limits):
            return
        alone = course_from(rows[0], motion, limits, self._approach)
        if alone.stretched > 1.001:
            file_time, real_time = motion.times[-1] - motion.times[0], alone.times[-1] - alone.times[1]
            message = f"motion {motion.key!r} takes {real_time:.2f} s from its first point instead of {file_time:g} s"
            reports.note("SK-MOTION-005", f"{message}, because a joint would exceed its speed limit", motion.where)

    def read(self, path: Path) -> None:
        """Add the motions of another file; its warnings are added to `sim.diagnostics`."""
        file = read_motions(path, self.sim.engine.reports)
        self.known.update(file.motions)
        for motion in file.motions.values():
            self._check(motion, self.sim.engine.reports)

    @property
    def action_name(self) -> str:
        """Name of the action `PlayMotion2`."""
        return self.ros.topic("play_motion2")

    @property
    def motions(self) -> dict[str, Motion]:
        """Copy of the known motions, by key."""
        return dict(self.known)

    @property
    def is_idle(self) -> bool:
        """True while no motion is being played."""
        return not self._runs

    def planned_duration(self, goal: GoalHandle) -> float:
        """Return the planned duration of a motion that is being played, including the approach [s]; otherwise 0.0."""
        return next((run.duration for run in self._runs if run.goal is goal), 0.0)

    # ------------------------------------------------------------------ goals

    def _on_goal(self, goal: GoalHandle) -> None:
        key = goal.request.motion_name
        motion = self.known.get(key)
        if motion is None:
            near = did_you_mean(key, self.known) or "there is " + (", ".join(self.known) or "none")
            self._refuse(goal, MotionRefused(MOTION_NOT_FOUND, f"Motion '{key}' is not known; {near}"), rejects=True)
            return
        self._play(goal, motion)

    def _on_raw_goal(self, goal: GoalHandle) -> None:
        try:
            motion = motion_of_message(goal.request.motion)
        except ValueError as error:
            self._refuse(goal, MotionRefused(OTHER_ERROR, f"Motion is not valid: {error}"), rejects=True)
            return
        self._play(goal, motion)

    def _play(self, goal: GoalHandle, motion: Motion) -> None:
        controllers = active_controllers(self.sim, self.robot)
        motion = add_leader_joints(self.robot, motion)
        needed = [controller for controller in controllers if set(controller.joints) & set(motion.joints)]
        names = tuple(controller.name for controller in needed)
        is_accepted = False
        try:
            self._check_idle(goal, names)
            find_joints(self.robot, motion.joints, controllers)
            is_accepted, checked = True, not goal.request.skip_planning
            course = plan_motion(self.sim, self.robot, motion, controllers, self._approach, checks_collisions=checked)
        except MotionRefused as refused:
            self._refuse(goal, refused, rejects=not is_accepted)
            return
        slowest = min((controller.speed_scaling for controller in needed), default=1.0)
        longest = 2.0 * course.duration / min(max(slowest, _SLOWEST), 1.0) + 1.0
        until = self.sim.time_ns + round(longest * 1e9)
        run = _RunningMotion(goal, motion.key, names, course.duration, until)
        self._runs.append(run)
        for controller in needed:
            request = trajectory_goal(course, motion, controller, self.robot)
            send = self.sim.communication.actions.send
            run.parts[controller.name] = send(controller.action, request, self._on_feedback, self._on_controller_done)

    def _check_idle(self, goal: GoalHandle, names: Sequence[str]) -> None:
        """Check that no running motion prevents a new motion.

        A ROS 2 goal needs that no motion runs. A ROS 1 goal may run beside motions that use other controllers.

        Raises:
            MotionRefused: Another motion is being played.
        """
        for run in self._runs:
            common = [name for name in names if name in run.controllers]
            if not _is_ros_1(goal):
                raise MotionRefused(CONTROLLER_BUSY, f"PlayMotion2 is busy: motion '{run.key}' is being played")
            if common:
                raise MotionRefused(
                    CONTROLLER_BUSY, f"controller '{common[0]}' is busy: motion '{run.key}' is being played"
                )

    def _refuse(self, goal: GoalHandle, refused: MotionRefused, *, rejects: bool) -> None:
        """Reject or abort the goal of a refused motion; ROS 1 clients receive an error code, ROS 2 clients a text."""
        self.log.info("%s", refused)
        if rejects and not _is_ros_1(goal):
            goal.reject(str(refused))
        else:
            goal.abort(_result_fields(goal, refused.code, str(refused)), str(refused))

    def _on_cancel(self, goal: GoalHandle) -> bool:
        run = next((run for run in self._runs if run.goal is goal), None)
        if run is None:
            return False
        self._cancel_controllers(run)
        goal.canceled(_result_fields(goal, OTHER_ERROR, "Motion canceled"), "Motion canceled")
        return True

    # ------------------------------------------------------------------ results and feedback of the controllers

    def _on_controller_done(self, part: GoalHandle) -> None:
        run = next((run for run in self._runs if part in run.parts.values()), None)
        if run is None:
            return
        name = next(name for name, candidate in run.parts.items() if candidate is part)
        if part.status.name == "SUCCEEDED":
            del run.parts[name]
            if not run.parts:
                self._runs.remove(run)
                run.goal.succeed(_result_fields(run.goal, SUCCEEDED, ""))
            return
        code = getattr(part.result, "error_code", 0)
        why = part.reason or getattr(part.result, "error_string", "") or part.status.name.lower()
        if part.status.name == "REJECTED":
            text = f"Motion {run.key} aborted. Cannot send goal to {name}: {why}"
        else:
            text = f"Joint Trajectory failed: {name}: {why}"
        self._fail(run, _TRAJECTORY_RESULTS.get(code, OTHER_ERROR), text)

    def _on_feedback(self, feedback: object) -> None:
        """Forward the feedback of the first unfinished controller, and abort motions that take too long."""
        now = self.sim.time_ns
        for run in tuple(self._runs):
            first = next(iter(run.parts.values()), None)
            if now > run.until_ns:
                self._fail(run, OTHER_ERROR, "Timeout exceeded while the motion was played")
            elif first is None or first.feedback is not feedback:
                continue
            elif _is_ros_1(run.goal):
                run.goal.publish_feedback(None)
            else:
                run.goal.publish_feedback({"current_time": msgs.time(now)})

    def _fail(self, run: _RunningMotion, code: int, text: str) -> None:
        self.log.info("%s", text)
        self._cancel_controllers(run)
        run.goal.abort(_result_fields(run.goal, code, text), text)

    def _cancel_controllers(self, run: _RunningMotion) -> None:
        """Cancel the goals of the controllers; the joints then hold their positions."""
        self._runs.remove(run)
        for part in run.parts.values():
            if not part.is_done:
                part.cancel()


def _is_ros_1(goal: GoalHandle) -> bool:
    return hasattr(goal.request, "priority")


def _result_fields(goal: GoalHandle, code: int, text: str) -> dict[str, object]:
    """Return the fields of the result message, for the action of ROS 1 or ROS 2."""
    if _is_ros_1(goal):
        return {"error_code": code, "error_string": text}
    return {"success": code == SUCCEEDED, "error": text}
