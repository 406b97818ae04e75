"""Parameters of trajectory controllers: live tolerances, live PID gains, and the rule for stopping."""

from __future__ import annotations

from collections.abc import Callable
from typing import TYPE_CHECKING, Final

import numpy as np

from simkit import Params
from simkit.extend import SharedByCopies, Vector
from simkit_control.plugins.ros2_control.joint_pids import JointPids
from simkit_control.plugins.ros2_control.trajectory import Spline
from simkit_control.plugins.ros2_control.trajectory_goals import Tolerances

if TYPE_CHECKING:
    from simkit.runtime.communication.parameter import Parameter
    from simkit_control.plugins.ros2_control.controller import Controller

_GAINS: Final = {"p": "p", "i": "i", "d": "d", "ff_velocity_scale": "feedforward"}


class LiveTolerances(SharedByCopies):
    """Tolerances of a controller's joints: live parameters in `constraints`."""

    def __init__(self, controller: Controller, joints: tuple[str, ...]) -> None:
        def live(name: str, default: float, description: str) -> Parameter[float]:
            return controller.declare(f"constraints.{name}", default, minimum=0.0, description=description)

        self._stopped = live("stopped_velocity_tolerance", 0.01, "largest speed of a joint at the end [rad/s or m/s]")
        self._goal_time = live("goal_time", 0.0, "allowed delay of a goal's end [s]; 0 for an unlimited delay")
        self._path = [
            live(f"{joint}.trajectory", 0.0, "largest error during the motion [rad or m]") for joint in joints
        ]
        self._goal = [live(f"{joint}.goal", 0.0, "largest error at the end [rad or m]") for joint in joints]

    def tolerances(self) -> Tolerances:
        """Return the current tolerances, which apply to goals that do not set any."""
        path, goal = [p.value for p in self._path], [p.value for p in self._goal]
        return Tolerances.of(path, goal, self._stopped.value, self._goal_time.value)


class StopRule(SharedByCopies):
    """Rule for stopping the joints when a trajectory is aborted.

    Attributes:
        decelerations: deceleration of each joint [rad/s² or m/s²], shape (n,); 0 stops at once.
        duration: time in which all joints come to rest [s], as in ROS 1; 0 stops at once.
    """

    def __init__(self, params: Params, joints: tuple[str, ...]) -> None:
        """Read `constraints` and `stop_trajectory_duration`."""
        constraints = params.block("constraints")
        slows_down = constraints.boolean("decelerate_on_cancel", False)
        blocks = [constraints.block(joint) for joint in joints]
        decelerations = np.array([block.number("max_deceleration_on_cancel", 0.0, minimum=0.0) for block in blocks])
        self.decelerations = decelerations if slows_down else decelerations * 0.0
        self.duration = params.number("stop_trajectory_duration", 0.0, minimum=0.0)

    def spline(self, state: Vector, *, has_velocity: bool) -> Spline:
        """Create the spline that brings the joints from a state to rest.

        Args:
            state: positions, velocities, accelerations, shape (3, n).
            has_velocity: true if velocities are measured.
        """
        position, velocity, _ = state
        if has_velocity and self.decelerations.any():
            return Spline.stop(position, velocity, self.decelerations)
        if self.duration > 0.0:
            return Spline.stop(position, velocity, np.abs(velocity) / self.duration)
        return Spline.held(position)


def read_timeout(params: Params, goal_time: float) -> float:
    """Read `cmd_timeout` [s], 0 for no timeout; a timeout not above `goal_time` [s] is ignored with a warning."""
    timeout = params.number("cmd_timeout", 0.0, minimum=0.0)
    if not 0.0 < timeout <= goal_time:
        return timeout
    message = f"Command timeout must be higher than goal_time tolerance ({timeout:f} vs. {goal_time:f})"
    where = (params.child("cmd_timeout") or params).where
    params.diagnostics.warning("SK-CONTROL-023", f"{message}; the timeout is ignored", where)
    return 0.0


def read_pids(
    controller: Controller, joints: tuple[str, ...], current_pids: Callable[[], JointPids | None]
) -> JointPids:
    """Read the PIDs in `gains`, and declare their gains as live parameters.

    Args:
        controller: controller that has the parameters.
        joints: joints of the PIDs.
        current_pids: function that returns the current PIDs; it is called at each change of a gain, because restoring a
            snapshot replaces the PIDs.
    """
    params = controller.params
    pids = JointPids(params.block("gains"), joints)
    feed = params.block("velocity_ff")  # ROS 1 has the feedforward gains in this block
    for k, joint in enumerate(joints):
        pids.feedforward[k] = feed.number(joint, float(pids.feedforward[k]))
        for name, attribute in _GAINS.items():

            def set_gain(value: float, attribute: str = attribute, k: int = k) -> None:
                current = current_pids()
                if current is not None:
                    getattr(current, attribute)[k] = value

            controller.declare(f"gains.{joint}.{name}", float(getattr(pids, attribute)[k]), on_change=set_gain)
    return pids
