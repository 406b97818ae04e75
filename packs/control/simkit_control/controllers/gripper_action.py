"""Gripper action controllers, as in ros2_controllers' `gripper_controllers` and `parallel_gripper_controller`."""

from __future__ import annotations

import math
from collections.abc import Sequence
from typing import TYPE_CHECKING, ClassVar, Final

import numpy as np

from simkit import msgs
from simkit.msgs import Message
from simkit.plugins.joints.joint_trajectory import SECOND
from simkit_control.plugins.ros2_control.controller import Controller
from simkit_control.plugins.ros2_control.joint_pids import JointPids

if TYPE_CHECKING:
    from simkit.extend import GoalHandle

COMMAND: Final = "control_msgs/action/GripperCommand"
PARALLEL: Final = "control_msgs/action/ParallelGripperCommand"


class GripperActionController(Controller):
    """Moves one gripper joint to the goals of `~/gripper_cmd`: a position [rad or m] and an effort limit [N·m or N].

    A goal succeeds within `goal_tolerance` of its position. A joint slower than `stall_velocity_threshold` for
    `stall_timeout` is stalled, usually on an object between the fingers. The goal then succeeds if `allow_stalling` is
    set, and is aborted otherwise. The commanded position does not change, so the gripper keeps pressing. A new goal
    replaces the active goal. After a cancelled goal the joint holds its current position.

    With position commands, the effort of a goal has no effect: it only appears in results and feedback, as in
    ros2_control.
    """

    types = ("position_controllers/GripperActionController",)
    interface: ClassVar[str] = "position"
    action_type: ClassVar[str] = COMMAND

    def configure(self) -> None:
        params = self.params
        self._joint = params.text("joint", "")
        if not self._joint:
            params.error("SK-CONTROL-026", "'joint' parameter is empty; set it to the gripper's joint")
        self._feedback_ns = round(SECOND / params.number("action_monitor_rate", 20.0, minimum=0.1))
        self._tolerance = params.number("goal_tolerance", 0.01, minimum=0.0)
        self._default_effort = abs(params.number("max_effort", 0.0))
        self._allow_stalling = params.boolean("allow_stalling", False)
        self._stall_velocity = params.number("stall_velocity_threshold", 0.001, minimum=0.0)
        self._stall_timeout = params.number("stall_timeout", 1.0, minimum=0.0)
        self._extra_interfaces: tuple[str, ...] = ()
        self._warnings = self.one_time_warnings()
        self._pids: JointPids | None = None
        if self.interface == "effort":
            self._pids = JointPids(params.block("gains"), (self._joint,))
            if not (self._pids.p.any() or self._pids.i.any()):
                message = f"gains of joint {self._joint!r} are all 0, so the joint never gets an effort"
                params.warning("SK-CONTROL-026", message, f"gains: {{{self._joint}: {{p: 100.0, d: 10.0}}}}")
        self._read_own_parameters()
        self.act("~/gripper_cmd", self.action_type, self._on_goal, self._on_cancel)
        self._is_active = False
        self._clear()

    def _read_own_parameters(self) -> None:
        """Read the parameters of a derived class; the base class has none."""

    def _clear(self) -> None:
        self._goal: GoalHandle | None = None
        self._target, self._effort, self._limits = math.nan, self._default_effort, np.zeros(0)
        self._commanded_effort = 0.0  # effort in results and feedback
        self._moved_ns = self._next_feedback = 0
        self._is_new = True

    def command_interfaces(self) -> Sequence[str]:
        return (f"{self._joint}/{self.interface}", *self._extra_interfaces)

    def state_interfaces(self) -> Sequence[str]:
        return (f"{self._joint}/position", f"{self._joint}/velocity")

    def activate(self) -> None:
        self._clear()
        self._is_active = True
        if self._pids is not None:
            self._pids.restart()
        self._target = float(self.states.values[0])

    def deactivate(self) -> None:
        self._is_active = False
        if self._goal is not None:
            goal, self._goal = self._goal, None
            goal.abort(self._result(), "Current goal cancelled during deactivate transition.")
        if self._pids is not None:
            self.commands.values = np.zeros(len(self.commands))

    # ------------------------------------------------------------------ goals

    def _on_goal(self, goal: GoalHandle) -> None:
        if not self._is_active:
            goal.reject("Can't accept new action goals. Controller is not running.")
            return
        position, effort, fault = self._read_command(goal.request)
        if fault:
            goal.reject(fault)
            return
        joint = self.hardware.joints.get(self._joint)
        if joint is not None and not joint.lower - 1e-6 <= position <= joint.upper + 1e-6:
            limits = f"its limits are {joint.lower:g} and {joint.upper:g}"
            what = f"a goal moves joint {self._joint!r} to {position:g}, but {limits}; the joint stops at its limit"
            self._warnings.warn("SK-CONTROL-021", "limits", what)
        if self._goal is not None:
            self._goal.canceled(reason="Current goal cancelled due to new incoming action.")
        self._goal, self._target, self._effort = goal, position, effort
        self._moved_ns, self._next_feedback, self._is_new = self.sim.time_ns, 0, True

    def _read_command(self, request: Message) -> tuple[float, float, str]:
        """Return position and effort of a goal, and the reason to reject the goal (empty if there is none)."""
        position, effort = float(request.command.position), float(request.command.max_effort)
        fault = "" if math.isfinite(position) and math.isfinite(effort) else "The command is not a finite number."
        return position, effort, fault

    def _on_cancel(self, goal: GoalHandle) -> None:
        if goal is not self._goal:
            return
        self._goal = None
        self._target, self._effort, self._is_new = float(self.states.values[0]), self._default_effort, True
        goal.canceled()

    # ------------------------------------------------------------------ each period

    def update(self, now_ns: int, period: float) -> None:
        if self._goal is None and not self._is_new and self._pids is None:
            return
        self._is_new = False
        position, velocity = self.states.values
        error = self._target - float(position)
        command, self._commanded_effort = self._target, self._effort
        if self._pids is not None:
            effort = float(self._pids.update(np.array([error]), np.array([-float(velocity)]), period)[0])
            command = self._commanded_effort = max(-abs(self._effort), min(abs(self._effort), effort))
        self.commands.values = np.array([command, *self._limits])
        if self._goal is not None:
            self._report_progress(self._goal, now_ns, error, float(velocity))

    def _report_progress(self, goal: GoalHandle, now: int, error: float, velocity: float) -> None:
        """End the goal if its position is reached or the joint is stalled, else publish feedback."""
        if abs(error) < self._tolerance:
            self._goal = None
            goal.succeed(self._result(reached_goal=True), "Successfully moved to goal.")
            return
        if abs(velocity) > self._stall_velocity:
            self._moved_ns = now
        elif now - self._moved_ns > self._stall_timeout * SECOND:
            self._goal = None
            end = goal.succeed if self._allow_stalling else goal.abort
            end(self._result(stalled=True), f"Stall detected moving to goal, {abs(error):g} away from it.")
            return
        if now >= self._next_feedback:
            self._next_feedback = now + self._feedback_ns
            goal.publish_feedback(self._feedback())

    def _result(self, *, stalled: bool = False, reached_goal: bool = False) -> dict[str, object]:
        return {**self._feedback(), "stalled": stalled, "reached_goal": reached_goal}

    def _feedback(self) -> dict[str, object]:
        return {"position": float(self.states.values[0]), "effort": self._commanded_effort}


class EffortGripperActionController(GripperActionController):
    """Moves the joint by effort: a PID position controller (`gains.<joint>`), limited to the goal's `max_effort`."""

    types = ("effort_controllers/GripperActionController",)
    interface = "effort"


class ParallelGripperActionController(GripperActionController):
    """Moves the joint to `ParallelGripperCommand` goals, with speed and effort on optional interfaces."""

    types = ("parallel_gripper_action_controller/GripperActionController",)
    action_type = PARALLEL

    def _read_own_parameters(self) -> None:
        params = self.params
        names = params.text("max_velocity_interface", ""), params.text("max_effort_interface", "")
        self._extra_interfaces = tuple(f"{self._joint}/{name}" if "/" not in name else name for name in names if name)
        self._names = names
        self._default_velocity_and_effort = params.number("max_velocity", 0.0, minimum=0.0), self._default_effort

    def activate(self) -> None:
        super().activate()
        self._limits = np.array(
            [v for name, v in zip(self._names, self._default_velocity_and_effort, strict=True) if name]
        )

    def _read_command(self, request: Message) -> tuple[float, float, str]:
        command = request.command
        if not len(command.position):
            return 0.0, 0.0, "The command has no position."
        velocity = float(command.velocity[0]) if len(command.velocity) else self._default_velocity_and_effort[0]
        effort = float(command.effort[0]) if len(command.effort) else self._default_velocity_and_effort[1]
        if not all(math.isfinite(v) for v in (command.position[0], velocity, effort)):
            return 0.0, 0.0, "The command is not a finite number."
        self._limits = np.array([v for name, v in zip(self._names, (velocity, effort), strict=True) if name])
        return float(command.position[0]), effort, ""

    def _feedback(self) -> dict[str, object]:
        position, velocity = self.states.values.tolist()
        state = msgs.make(
            "sensor_msgs/msg/JointState",
            header=msgs.header(self.sim.time_ns, ""),
            name=[self._joint],
            position=[position],
            velocity=[velocity],
            effort=[self._commanded_effort],
        )
        return {"state": state}
