"""Plugin with simple motions as in Nav2's `nav2_behaviors`: spin, back up, drive on heading, wait, assisted teleop."""

from __future__ import annotations

import math
from dataclasses import dataclass
from functools import partial
from typing import TYPE_CHECKING, Final

from simkit import Params, msgs
from simkit.extend import NEVER, Options, OptionsOf, boolean, listens, number, text, without_effect
from simkit.pose import wrap_angle
from simkit_navigation.plugins.costmaps.cost_grid import CostGrid
from simkit_navigation.plugins.costmaps.costmap_reader import COSTMAP, CostmapReader
from simkit_navigation.plugins.costmaps.footprint import Footprint, read_footprint
from simkit_navigation.plugins.navigation.node_values import NodeValues, Values
from simkit_navigation.plugins.navigation.planar_pose import PlanarPose, look_up
from simkit_navigation.plugins.navigation.velocity_command import VelocityCommand
from simkit_navigation.plugins.navigators.navigator_parameters import behavior_parameters

if TYPE_CHECKING:
    from simkit import Model, Simulation
    from simkit.extend import GoalHandle

_TIMEOUT, _TF_ERROR, _COLLISION, _INVALID = "timeout", "transform", "collision", "input"
_CODES: Final = {
    "spin": {_TIMEOUT: 701, _TF_ERROR: 702, _COLLISION: 703},
    "backup": {_TIMEOUT: 711, _TF_ERROR: 712, _INVALID: 713, _COLLISION: 714},
    "drive_on_heading": {_TIMEOUT: 721, _TF_ERROR: 722, _COLLISION: 723, _INVALID: 724},
    "assisted_teleop": {_TIMEOUT: 731, _TF_ERROR: 732},
    "wait": {_TIMEOUT: 741},
}
"""Error codes of each action, as in its definition."""
_TYPES: Final = {
    "spin": "Spin",
    "backup": "BackUp",
    "drive_on_heading": "DriveOnHeading",
    "wait": "Wait",
    "assisted_teleop": "AssistedTeleop",
}
_TWIST: Final = ("geometry_msgs/msg/Twist", "geometry_msgs/msg/TwistStamped")
_AT_REST: Final = (0.0, 0.0)


class BehaviorServerOptions(Options):
    """Options of `BehaviorServer`."""

    cycle_frequency: float = number(10.0, "Hz", minimum=0.1, maximum=1000)
    local_frame: str = text("odom")
    robot_base_frame: str = text("base_link")
    costmap_topic: str = text("local_costmap/costmap_raw")
    simulate_ahead_time: float = number(2.0, "s", minimum=0)
    max_rotational_vel: float = number(1.0, "rad/s", minimum=0)
    min_rotational_vel: float = number(0.4, "rad/s", minimum=0)
    rotational_acc_lim: float = number(3.2, "rad/s^2", minimum=0.001)
    robot_radius: float = number(0.1, "m", minimum=0)
    footprint: str = text("")
    enable_stamped_cmd_vel: bool = boolean(False)
    projection_time: float = number(1.0, "s", minimum=0)
    simulation_time_step: float = number(0.1, "s", minimum=0.001)
    cmd_vel_teleop: str = text("cmd_vel_teleop")
    transform_tolerance: bool = without_effect()
    transform_timeout: bool = without_effect()
    global_costmap_topic: bool = without_effect()
    local_footprint_topic: bool = without_effect()
    global_footprint_topic: bool = without_effect()
    footprint_topic: bool = without_effect()


@dataclass(eq=False)
class _Motion:
    """Motion of an active goal.

    Attributes:
        goal: goal.
        name: name of the action.
        begin_ns: time of the start [ns].
        begin: pose at the start.
        last: pose at the last call.
        turned: angle turned since the start [rad].
        target: angle [rad], distance [m] or duration [s] of the goal, with sign.
        speed: speed of the goal [m/s].
        allowance: longest duration [s]; 0 for no limit.
    """

    goal: GoalHandle
    name: str
    begin_ns: int
    begin: PlanarPose
    last: PlanarPose
    target: float
    speed: float = 0.0
    allowance: float = 0.0
    turned: float = 0.0


class BehaviorServer(CostmapReader):
    """Moves a robot without a path: actions `spin`, `backup`, `drive_on_heading`, `wait` and `assisted_teleop`.

    A motion ends as aborted before the robot touches an obstacle of the local costmap, or after its time allowance.
    While a person drives with `assisted_teleop`, the commands on `<cmd_vel_teleop>` are slowed down before an obstacle.
    """

    filenames = ("libsimkit_behavior_server.so",)
    names = ("simkit::BehaviorServer", "behavior_server::BehaviorServer")
    parent_kind = ("world", "model")
    costmap = "local_costmap"
    options = OptionsOf(BehaviorServerOptions)
    endpoints = (
        listens("local_costmap/costmap_raw", COSTMAP, named_by=("costmap_topic",)),
        listens("cmd_vel_teleop", *_TWIST, named_by=("cmd_vel_teleop",)),
    )
    before_step_rate = NEVER

    @classmethod
    def translate_parameters(cls, values: Values, costmap: Values, /) -> NodeValues:
        return behavior_parameters(values, costmap)

    def load(self, parent: Simulation | Model, params: Params) -> None:
        options = self.options.read_all()
        self.sim.tf.open()  # so that the first look-up knows the transforms before it
        self._footprint: Footprint = read_footprint(self, options.footprint, options.robot_radius)
        self._motion: _Motion | None = None
        self.read_costmap(options.costmap_topic)
        self._command = VelocityCommand(self, options.robot_base_frame if options.enable_stamped_cmd_vel else None)
        self._teleop = _AT_REST
        self.listen(options.cmd_vel_teleop, _TWIST, self._on_teleop)
        self.listen("preempt_teleop", "std_msgs/msg/Empty", self._on_end_of_teleop)
        for name, kind in _TYPES.items():
            self.act(name, f"nav2_msgs/action/{kind}", partial(self._begin, name), self._on_cancel)

    def _begin(self, name: str, goal: GoalHandle) -> None:
        """Begin the motion of a goal; it replaces the present motion."""
        request, pose = goal.request, self._pose()
        target = _target(name, request)
        if not all(map(math.isfinite, (target, getattr(request, "speed", 0.0)))):
            goal.reject("the goal contains NaN or infinite numbers")
            return
        problem = _problem(name, request)
        if problem:
            _abort(goal, _CODES[name][_INVALID], problem)
            return
        if pose is None and name != "wait":
            _abort(goal, _CODES[name][_TF_ERROR], "the pose of the robot is not known")
            return
        self._teleop = _AT_REST
        if self._motion is not None:
            self._motion.goal.abort(reason="another motion replaced this one")
        here = pose or PlanarPose(0.0, 0.0, 0.0)
        allowance = getattr(request, "time_allowance", None)
        self._motion = _Motion(
            goal,
            name,
            self.sim.time_ns,
            here,
            here,
            target,
            abs(getattr(request, "speed", 0.0)),
            0.0 if allowance is None else allowance.sec + allowance.nanosec * 1e-9,
        )
        self._set_before_step_rate(self.options.cycle_frequency)

    def _on_cancel(self, goal: GoalHandle) -> None:
        if self._motion is not None and goal is self._motion.goal:
            self._stop()
        goal.canceled()

    def _on_teleop(self, message: msgs.Message) -> None:
        twist = message.twist if hasattr(message, "twist") else message
        speeds = (float(twist.linear.x), float(twist.angular.z))
        if all(map(math.isfinite, speeds)):
            self._teleop = speeds
        else:
            self._once.not_finite()

    def _on_end_of_teleop(self, _: msgs.Message) -> None:
        motion = self._motion
        if motion is not None and motion.name == "assisted_teleop":
            self._end(motion, (self.sim.time_ns - motion.begin_ns) * 1e-9, "")

    def _pose(self) -> PlanarPose | None:
        return look_up(self.sim, self.options.local_frame, self.options.robot_base_frame)

    def before_step(self) -> None:
        motion = self._motion
        if motion is None:
            return
        elapsed = (self.sim.time_ns - motion.begin_ns) * 1e-9
        pose_now = self._pose()
        if pose_now is None and motion.name != "wait":
            self._end(motion, elapsed, _TF_ERROR, "the pose of the robot is not known any more")
            return
        pose = pose_now or motion.last
        motion.turned += wrap_angle(pose.yaw - motion.last.yaw)
        motion.last = pose
        if motion.name == "assisted_teleop":
            self._assist(motion, elapsed, pose)
            return
        done = {
            "wait": elapsed,
            "spin": abs(motion.turned),
        }.get(motion.name, math.hypot(pose.x - motion.begin.x, pose.y - motion.begin.y))
        remaining = abs(motion.target) - done
        speeds = self._speeds(motion, remaining)
        if remaining <= (0.0 if motion.name == "wait" else 1e-3):
            self._end(motion, elapsed, "")
        elif motion.allowance and elapsed > motion.allowance:
            self._end(motion, elapsed, _TIMEOUT, "the time allowance is over")
        elif motion.name != "wait" and self._collides(pose, speeds, remaining):
            self._end(motion, elapsed, _COLLISION, "an obstacle is ahead")
        else:
            if motion.name != "wait":
                self._publish(speeds)
            motion.goal.publish_feedback(_feedback(motion.name, done, remaining))

    def _assist(self, motion: _Motion, elapsed: float, pose: PlanarPose) -> None:
        """Pass the command of a person on, slower before an obstacle, as Nav2's `assisted_teleop.cpp`."""
        if motion.allowance and elapsed > motion.allowance:
            self._end(motion, elapsed, _TIMEOUT, "the time allowance is over")
            return
        options, speeds = self.options, self._teleop
        step, scale = options.simulation_time_step, 1.0
        count = max(1, math.ceil(options.projection_time / step))
        if speeds != _AT_REST:
            seen = self._seen()
            free = 0
            while seen is not None and free < count and not self._touches(seen, pose, speeds, (free + 1) * step):
                free += 1
            scale = free / count if seen is not None else 1.0
        self._publish((scale * speeds[0], scale * speeds[1]))
        motion.goal.publish_feedback({"current_teleop_duration": _duration(elapsed)})

    def _seen(self) -> CostGrid | None:
        """Return the local costmap in the frame of the motion; None if it is not known."""
        grid = self.grid
        placed = None if grid is None else look_up(self.sim, self.options.local_frame, grid.frame)
        return None if grid is None or placed is None else grid.seen_from(self.options.local_frame, placed)

    def _touches(self, seen: CostGrid, pose: PlanarPose, speeds: tuple[float, float], time: float) -> bool:
        if self._footprint.collides(seen, pose):
            return False  # it is too near an obstacle already, so it must be able to leave
        return self._footprint.collides_ahead(seen, pose, speeds, time)

    def _speeds(self, motion: _Motion, remaining: float) -> tuple[float, float]:
        """Return forward speed [m/s] and turning rate [rad/s]."""
        if motion.name == "spin":
            options = self.options
            rate = min(math.sqrt(2 * options.rotational_acc_lim * max(remaining, 0.0)), options.max_rotational_vel)
            return 0.0, math.copysign(max(rate, options.min_rotational_vel), motion.target)
        return math.copysign(motion.speed, motion.target), 0.0

    def _collides(self, pose: PlanarPose, speeds: tuple[float, float], remaining: float) -> bool:
        """Check whether the robot touches an obstacle ahead that it does not touch yet."""
        seen = self._seen()
        time = min(self.options.simulate_ahead_time, remaining / max(map(abs, speeds)))
        return seen is not None and self._touches(seen, pose, speeds, time)

    def _end(self, motion: _Motion, elapsed: float, problem: str, reason: str = "") -> None:
        self._stop()
        result = {"total_elapsed_time": _duration(elapsed)}
        if problem:
            _abort(motion.goal, _CODES[motion.name][problem], reason, **result)
        else:
            motion.goal.succeed(result)

    def _publish(self, speeds: tuple[float, float]) -> None:
        self._command.publish(speeds)

    def _stop(self) -> None:
        if self._motion is not None and self._motion.name != "wait":
            self._publish((0.0, 0.0))
        self._motion = None
        self._set_before_step_rate(NEVER)


def _abort(goal: GoalHandle, code: int, reason: str, **result: object) -> None:
    """End a goal as aborted; its result has the code and the reason."""
    goal.abort({**result, "error_code": code, "error_msg": reason}, reason)


def _problem(name: str, request: msgs.Message) -> str:
    """Return what is not valid in a goal; empty for nothing."""
    if name not in ("backup", "drive_on_heading"):
        return ""
    if request.target.y or request.target.z:
        return "the robot drives along x only, and the target has a y or a z"
    if not request.speed:
        return "the speed is 0"
    if name == "drive_on_heading" and (request.target.x > 0) is not (request.speed > 0):
        return "target.x and speed have different signs"
    return ""


def _target(name: str, request: msgs.Message) -> float:
    """Return the angle [rad], the distance [m] or the duration [s] of a goal; backwards is negative."""
    if name == "spin":
        return float(request.target_yaw)
    if name == "assisted_teleop":
        return 0.0
    if name == "wait":
        return float(request.time.sec + request.time.nanosec * 1e-9)
    way = abs(float(request.target.x))
    return -way if name == "backup" else math.copysign(way, request.target.x)


def _feedback(name: str, done: float, remaining: float) -> dict[str, object]:
    if name == "wait":
        return {"time_left": _duration(max(remaining, 0.0))}
    return {"angular_distance_traveled" if name == "spin" else "distance_traveled": done}


def _duration(seconds: float) -> msgs.Duration:
    return msgs.duration(round(seconds * 1e9))
