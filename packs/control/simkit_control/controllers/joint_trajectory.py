"""Joint trajectory controller with the behaviour of ros2_controllers' `joint_trajectory_controller`."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace
from typing import TYPE_CHECKING, ClassVar, Final

import numpy as np

from simkit import msgs
from simkit.extend import Vector
from simkit.plugins.joints.joint_trajectory import SECOND
from simkit_control.plugins.ros2_control.controller import Controller
from simkit_control.plugins.ros2_control.hardware_interfaces import POSITION
from simkit_control.plugins.ros2_control.joint_group import TRAJECTORY, JointGroup, TrajectoryMessages
from simkit_control.plugins.ros2_control.joint_pids import JointPids
from simkit_control.plugins.ros2_control.stiff_loops import StiffLoops
from simkit_control.plugins.ros2_control.trajectory import (
    Setpoint,
    Spline,
    TrajectoryPoint,
    integrate_points,
    shortest_differences,
    whole_turn_offset,
)
from simkit_control.plugins.ros2_control.trajectory_goals import TrajectoryRules, describe_violation, read_points
from simkit_control.plugins.ros2_control.trajectory_options import LiveTolerances, StopRule, read_pids, read_timeout

if TYPE_CHECKING:
    from simkit import Publisher
    from simkit.extend import GoalHandle
    from simkit.msgs import JointTrajectory, QueryTrajectoryState_Request, SpeedScalingFactor

FOLLOW: Final = "control_msgs/action/FollowJointTrajectory"
QUERY: Final = "control_msgs/srv/QueryTrajectoryState"
SCALING: Final = "control_msgs/msg/SpeedScalingFactor"
SUCCESSFUL, INVALID_GOAL, PATH_VIOLATED, GOAL_VIOLATED = 0, -1, -4, -5
_HOLD: Final = "hold"
_FASTEST: Final = 1000.0  # largest speed scaling
_IGNORED_PARAMETERS: Final = ("start_with_holding", "verbose")  # always holds at the start, and uses `logging`


class JointTrajectoryController(Controller):
    """Follows trajectories from `~/joint_trajectory` and from goals of `~/follow_joint_trajectory`.

    Points are connected by straight lines, or by cubic splines if they have velocities, or by quintic splines if they
    also have accelerations. A trajectory begins at the measured state, or at the last command if
    `interpolate_from_desired_state` is set. Each command is the setpoint for the end of the next period. A new
    trajectory replaces the active trajectory. An invalid trajectory is rejected, and the active trajectory continues.

    The result of a goal is PATH_TOLERANCE_VIOLATED as soon as an error exceeds `constraints.<joint>.trajectory`. After
    the last point, the result is SUCCESSFUL once all errors are within `constraints.<joint>.goal`, or
    GOAL_TOLERANCE_VIOLATED after `constraints.goal_time`. Then the joints hold their positions.
    """

    types: ClassVar[tuple[str, ...]] = ("joint_trajectory_controller/JointTrajectoryController",)
    default_commands: ClassVar[tuple[str, ...]] = ()
    default_states: ClassVar[tuple[str, ...]] = ()
    topics: ClassVar[tuple[str, ...]] = ("~/joint_trajectory",)
    may_end_moving: ClassVar[bool] = False

    # ------------------------------------------------------------------ configuration

    def configure(self) -> None:
        params = self.params
        self._group = JointGroup(params, self.hardware, self.default_commands, self.default_states)
        self._warnings = self.one_time_warnings()
        self._has_continuous_joints = bool(self._group.turning.any())
        joints = self._group.joints
        self._rules = TrajectoryRules(
            joints,
            params.boolean("allow_partial_joints_goal", False),
            params.boolean("allow_integration_in_goal_trajectories", False),
            params.boolean("allow_nonzero_velocity_at_trajectory_end", self.may_end_moving),
        )
        for name in _IGNORED_PARAMETERS:
            params.child(name)
        self._starts_from_desired = params.boolean("open_loop_control", False)
        self._starts_from_desired = params.boolean("interpolate_from_desired_state", self._starts_from_desired)
        self._starts_at_command = params.boolean("set_last_command_interface_value_as_state_on_activation", True)
        self._steps = params.choice("interpolation_method", ("splines", "none"), "splines") == "none"
        self._feedback_ns = round(SECOND / params.number("action_monitor_rate", 20.0, minimum=0.1))
        rate = params.number("state_publish_rate", 0.0, minimum=0.0)
        self._state_ns = round(SECOND / rate) if rate else 0
        self._constraints = LiveTolerances(self, joints)
        self._timeout = read_timeout(params, self._constraints.tolerances().goal_time)
        self._stop_rule = StopRule(params, joints)
        self._pids = self._read_gains()
        self._stiff_loops: StiffLoops | None = None
        if self._pids is not None and self._group.has_effort:
            self._stiff_loops = StiffLoops(self, self._group.commanded_joints, self._pids)
        self._period_ns = 0
        scaling = params.block("speed_scaling")
        self._scaling = scaling.number("initial_scaling_factor", 1.0, minimum=0.0, maximum=_FASTEST)
        self._scaling_state = scaling.text("state_interface", "")
        self._scaling_command = scaling.text("command_interface", "")
        # true if commands are read from the spline only, without measurements
        self._is_plain = self._group.commands == (POSITION,) and not (self._scaling_state or self._scaling_command)
        self._is_active = False
        self._open()
        self._clear()

    def _read_gains(self) -> JointPids | None:
        """Return PIDs of the commanded joints; None if the interfaces need no PID."""
        if not self._group.is_closed_loop:
            self.params.block("gains").mark_all_read()
            return None
        joints = tuple(self._group.joints[index] for index in self._group.commanded_indices)
        return read_pids(self, joints, lambda: self._pids)

    def _open(self) -> None:
        for topic in self.topics:
            self.listen(topic, TRAJECTORY, self._on_trajectory)
        self.act("~/follow_joint_trajectory", FOLLOW, self._on_goal, self._on_cancel)
        self.offer("~/query_state", QUERY, self._on_query)
        self.listen("~/speed_scaling_input", SCALING, self._on_scaling)
        self._messages = TrajectoryMessages(self._group)
        self._publishers: list[Publisher] = [
            self.advertise(f"~/{name}", TrajectoryMessages.STATE) for name in ("controller_state", "state")
        ]

    def _clear(self) -> None:
        """Reset to the state before the first trajectory."""
        self._goal: GoalHandle | None = None
        self._next_trajectory: JointTrajectory | Spline | str | None = None  # a string is always _HOLD
        self._spline: Spline | None = None
        self._tolerances = self._constraints.tolerances()
        self._is_holding = self._is_first = self._is_idle = False
        self._elapsed = self._last = self._start = 0
        self._next_feedback = self._next_state = 0
        self._is_due = False
        self._command: Setpoint | None = None
        self._ahead: tuple[int, Setpoint] | None = None  # setpoint at the start of the next period
        self._watches_path = False

    def command_interfaces(self) -> Sequence[str]:
        extra = (self._scaling_command,) if self._scaling_command else ()
        return (*self._group.command_names, *extra)

    def state_interfaces(self) -> Sequence[str]:
        extra = (self._scaling_state,) if self._scaling_state else ()
        return (*self._group.state_names, *extra)

    def activate(self) -> None:
        self._clear()
        if self._pids is not None:
            self._pids.restart()
        self._is_active = True
        # updates happen at steps, so their times are uneven; setpoints are a full period ahead, as in ros2_controllers
        rate = self.update_rate or self.plugin.before_step_rate
        self._period_ns = max(round(SECOND / rate) if rate else 0, round(self.sim.timestep * SECOND))
        self._next_trajectory = _HOLD
        if self._starts_at_command:
            commanded = self._group.commanded(self.commands.values)
            if commanded is not None:
                self._next_trajectory = Spline.held(commanded)

    def deactivate(self) -> None:
        self._is_active = False
        if self._goal is not None:
            self._end_goal("abort", INVALID_GOAL, "Current goal cancelled during deactivate transition.")
        self.commands.values = self._group.at_rest(self.commands.values)

    # ------------------------------------------------------------------ messages and goals

    def _on_trajectory(self, message: JointTrajectory) -> None:
        """Store a trajectory from the topic for the next update; an invalid trajectory is reported."""
        fault = self._rules.fault(message, self.sim.time_ns)
        if fault:
            self._warnings.warn("SK-CONTROL-020", fault, f"a trajectory is ignored: {fault}")
        if fault or not self._is_active:
            return
        if self._goal is not None:
            what = "a trajectory on the topic replaces the active goal's; the goal ends with the new trajectory"
            self._warnings.warn("SK-CONTROL-022", "replaced", what, "cancel the goal first")
        else:
            self._tolerances = self._constraints.tolerances()
        self._report_unfollowable(message)
        self._next_trajectory = message

    def _on_goal(self, goal: GoalHandle) -> None:
        trajectory = goal.request.trajectory
        if not self._is_active:
            goal.reject("Can't accept new action goals. Controller is not running.")
            return
        fault = self._rules.fault(trajectory, self.sim.time_ns)
        if fault:
            self.log.error("%s", fault)
            goal.reject(fault)
            return
        if self._goal is not None:
            self._end_goal("canceled", INVALID_GOAL, "Current goal cancelled due to new incoming action.")
        self._goal = goal
        self._tolerances, what = self._constraints.tolerances().with_goal(goal.request, self._group.joints)
        if what:
            self._warnings.warn("SK-CONTROL-020", what, what)
        self._report_unfollowable(trajectory)
        self._next_trajectory = trajectory
        self._next_feedback = 0

    def _on_cancel(self, goal: GoalHandle) -> None:
        if goal is not self._goal:
            return
        self._goal = None
        goal.canceled()
        self._next_trajectory = _HOLD

    @property
    def speed_scaling(self) -> float:
        """Factor of the speed of trajectories; with 0.5, a trajectory takes twice its time."""
        return self._scaling

    def _on_scaling(self, message: SpeedScalingFactor) -> None:
        if 0.0 <= message.factor <= _FASTEST:
            self._scaling = float(message.factor)
        else:
            what = f"the speed scaling {message.factor:g} is ignored; expected a number from 0 to {_FASTEST:g}"
            self._warnings.warn("SK-CONTROL-020", what, what)

    def _report_unfollowable(self, message: JointTrajectory) -> None:
        """Report efforts without an effort interface, and positions outside the limits of their joint."""
        if not self._group.has_effort and any(len(point.effort) for point in message.points):
            self._warnings.warn("SK-CONTROL-025", "effort", "efforts are ignored: there is no effort command interface")
        for index, name in enumerate(message.joint_names):
            joint = self.hardware.joints.get(self._group.command_of(str(name)))
            goals = [p.positions[index] for p in message.points if len(p.positions)]
            beyond = [] if joint is None else [p for p in goals if not joint.lower - 1e-6 <= p <= joint.upper + 1e-6]
            if joint is not None and beyond:
                limits = f"its limits are {joint.lower:g} and {joint.upper:g}"
                what = f"a trajectory moves joint {name!r} to {beyond[0]:g}, but {limits}; the joint stops at its limit"
                self._warnings.warn("SK-CONTROL-021", str(name), what)

    # ------------------------------------------------------------------ each period

    def update(self, now_ns: int, period: float) -> None:
        self._is_due = now_ns >= self._next_state  # with and without subscribers: their times do not matter
        self._next_state = now_ns + self._state_ns if self._is_due else self._next_state
        if self._next_trajectory is None:
            if self._is_idle:
                if self._is_state_due() and self._command is not None:
                    state = self._group.state(self.states.values)
                    self._publish(now_ns, self._command.motion, state, self._errors(self._command.motion, state))
                return
            if self._is_plain and not self._is_first and self._continue_spline(now_ns):
                return
        state = self._group.state(self.states.values)
        if self._scaling_state:
            factor = float(self.states.values[-1])
            self._scaling = factor if 0.0 <= factor <= _FASTEST else self._scaling
        if self._next_trajectory is None:
            self._elapsed += round((now_ns - self._last) * self._scaling)
        else:
            self._begin_trajectory(now_ns, state)
        self._last = now_ns
        self._follow_spline(now_ns, period, state)

    def _continue_spline(self, now: int) -> bool:
        """Command only the next setpoint; return false, without a command, if the update needs more than that."""
        spline, scaling = self._spline, self._scaling
        if spline is None or (self._watches_path and not self._is_holding):
            return False
        passed = round((now - self._last) * scaling)
        elapsed = self._elapsed + passed
        if elapsed >= spline.times[-1] or (self._goal is not None and now >= self._next_feedback):
            return False
        if self._is_state_due():
            return False
        self._elapsed, self._last = elapsed, now
        step = round(self._period_ns * scaling)
        target_time = elapsed + step
        self._command = command = spline.at(target_time, step if passed == step else 0)
        self._ahead = target_time, command
        self.commands.values = command.motion[0][self._group.span]
        return True

    def _begin_trajectory(self, now: int, state: Vector) -> None:
        """Start the waiting trajectory."""
        waiting, self._next_trajectory, self._ahead = self._next_trajectory, None, None
        self._watches_path = self._tolerances.watches_path
        self._is_holding, self._is_first, self._is_idle = True, True, False
        self._start, self._elapsed = now, 0
        if isinstance(waiting, Spline):
            self._spline = waiting
        elif isinstance(waiting, str):
            self._spline = self._stop_rule.spline(state, has_velocity=self._group.has_velocity_state)
        elif waiting is not None:
            self._is_holding = False
            self._start = msgs.stamp_ns(waiting.header.stamp) or now
            self._elapsed = now - self._start
            self._spline = self._spline_through(waiting, state)

    def _spline_through(self, message: JointTrajectory, state: Vector) -> Spline:
        """Create the spline of a trajectory from the current state."""
        group = self._group
        start = TrajectoryPoint(self._elapsed, state[0], state[1] if group.has_velocity_state else None)
        if self._starts_from_desired and self._command is not None:
            start = TrajectoryPoint(self._elapsed, *self._command.motion)
        commanded = group.commanded(self.commands.values)
        points = read_points(message, group.joints, state[0] if commanded is None else commanded)
        if self._rules.allow_integration:
            points = integrate_points(start, points)
        assert start.positions is not None and points[0].positions is not None
        turns = whole_turn_offset(start.positions, points[0].positions, group.turning)
        if turns.any():
            points = [replace(p, positions=p.positions + turns) for p in points if p.positions is not None]
        return Spline.through(start, points, steps=self._steps)

    def _follow_spline(self, now: int, period: float, state: Vector) -> None:
        """Compute errors, write commands, and report the progress of the goal."""
        spline, goal, tolerances = self._spline, self._goal, self._tolerances
        assert spline is not None
        desired = self._ahead[1] if self._ahead is not None and self._ahead[0] == self._elapsed else None
        desired = spline.at(self._elapsed) if desired is None else desired
        step = round(self._period_ns * self._scaling)
        target_time = self._elapsed + step
        command = spline.at(target_time, step if round(period * SECOND) == self._period_ns else 0)
        self._ahead = target_time, command
        errors = self._errors(desired.motion, state)
        is_over, late = self._elapsed >= spline.end, (self._elapsed - spline.end) / SECOND
        absolute = np.abs(errors)
        is_watched = self._watches_path and not self._is_holding and (not is_over or self._is_first)
        violates_path = is_watched and bool((absolute > tolerances.path).any())
        misses_goal = not self._is_holding and is_over and bool((absolute > tolerances.goal).any())
        is_late = misses_goal and 0.0 < tolerances.goal_time < late
        self._is_first = False
        if not violates_path and not is_late:
            values = self._group.command(command, errors, period, self._pids)
            if self._stiff_loops:
                position, velocity = state[:2, self._group.commanded_indices]
                values = self._stiff_loops.effort(values, position, velocity)
            self.commands.values = np.append(values, self._scaling) if self._scaling_command else values
            self._command = command
        if goal is not None and (now >= self._next_feedback):
            self._next_feedback = now + self._feedback_ns
            goal.publish_feedback(self._messages.feedback(now, desired.motion, state, errors))
        if self._is_state_due():
            self._publish(now, desired.motion, state, errors)
        if violates_path:
            what = describe_violation(absolute, tolerances.path, self._group.joints)
            self._abort_and_hold(PATH_VIOLATED, "Aborted due to path tolerance violation", what)
        elif is_late:
            what = describe_violation(absolute, tolerances.goal, self._group.joints)
            self._abort_and_hold(
                GOAL_VIOLATED, f"Aborted due to goal_time_tolerance exceeding by {late:f} seconds", what
            )
        elif is_over and not self._is_holding:
            self._handle_arrival(misses_goal, late)
        elif is_over and self._is_holding:
            self._is_idle = not self._group.is_closed_loop

    def _handle_arrival(self, misses: bool, late: float) -> None:
        """Finish the trajectory after its last point."""
        if not misses and self._goal is not None:
            self._end_goal("succeed", SUCCESSFUL, "Goal successfully reached!")
            self.log.info("Goal reached, success!")
            self._is_holding = True
        elif not misses and self._timeout == 0.0:
            self._is_holding = True
        elif 0.0 < self._timeout < late:
            self.log.warning("Aborted due to command timeout")
            self._next_trajectory = _HOLD

    def _abort_and_hold(self, code: int, text: str, what: str) -> None:
        """Abort the goal after a violated tolerance, and hold the current position."""
        self.log.warning("%s: %s", text, what)
        if self._goal is not None:
            self._end_goal("abort", code, text, what)
        self._next_trajectory = _HOLD

    def _end_goal(self, how: str, code: int, text: str, what: str = "") -> None:
        goal, self._goal = self._goal, None
        getattr(goal, how)({"error_code": code, "error_string": text}, what or text)

    # ------------------------------------------------------------------ readings

    def _errors(self, desired: Vector, state: Vector) -> Vector:
        """Return desired − measured, shape (3, n); a quantity that is not both commanded and measured has error 0."""
        group = self._group
        errors = (desired - state) * group.compared
        if self._has_continuous_joints:
            errors[0] = shortest_differences(errors[0], group.turning)
        return errors

    def _has_subscribers(self) -> bool:
        current, deprecated = self._publishers
        return current.wanted or deprecated.wanted

    def _is_state_due(self) -> bool:
        """Check whether the state has to be published in this period."""
        return self._is_due and self._has_subscribers()

    def _publish(self, now: int, desired: Vector, state: Vector, errors: Vector) -> None:
        message = self._messages.state(now, desired, state, errors, self.commands.values, self._scaling)
        for publisher in self._publishers:
            if publisher.wanted:
                publisher.publish(message)

    def _on_query(self, request: QueryTrajectoryState_Request) -> dict[str, object]:
        """Return the desired state of the joints at a time."""
        if not self._is_active:
            return {"success": False, "message": "Can't sample trajectory. Controller is not active."}
        if self._spline is None:
            return {"success": False, "message": "Currently there is no valid trajectory instance."}
        since = msgs.stamp_ns(request.time) - self._start
        if since < self._spline.times[0]:
            return {"success": False, "message": "Requested sample time precedes trajectory start time."}
        if since > self._spline.end and not self._is_holding:
            return {"success": False, "message": "Requested sample time precedes the current trajectory end time."}
        position, velocity, acceleration = self._spline.at(since).motion
        reply = {"position": position, "velocity": velocity, "acceleration": acceleration}
        return {"success": True, "name": list(self._group.joints), **reply}
