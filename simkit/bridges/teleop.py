"""Driving by hand: chooses the velocity topic and converts keys and requested speeds to velocity commands."""

from __future__ import annotations

import math
import re
from collections.abc import Mapping
from dataclasses import dataclass
from pathlib import PurePath
from typing import TYPE_CHECKING, Any, Final

from simkit.diagnostics import did_you_mean
from simkit.errors import ActionError, InputError, MessageError

if TYPE_CHECKING:
    from simkit.runtime import Model, Simulation
    from simkit.runtime.communication.action_server import GoalHandle

TWISTS: Final = ("geometry_msgs/msg/Twist", "geometry_msgs/msg/TwistStamped")
Bounds = tuple[float, float]
UP, DOWN, LEFT, RIGHT = "up", "down", "left", "right"

_UNLIMITED: Final = (-math.inf, math.inf)
_BURGER: Final = (0.22, 2.84)  # [m/s, rad/s] limits in turtlebot3_teleop; the model files have none
_WAFFLE: Final = (0.26, 1.82)
_BURGER_WIDTH: Final = 0.2  # [m] between the wheels: less for a burger, more for a waffle
_TURTLEBOT: Final = re.compile("turtlebot|burger|waffle|tb3", re.IGNORECASE)
_WHEELS: Final = ("wheel_left_joint", "wheel_right_joint")
_HOLONOMIC_DRIVES: Final = re.compile("mecanum|planar_move|velocity-control|omni", re.IGNORECASE)
_FINE, _COARSE, _TURN_STEP = 0.01, 0.05, 0.1  # [m/s, m/s, rad/s] change per key
_SLOW: Final = 0.5  # [m/s]: robots up to this speed are driven in fine steps


KeyCommand = tuple[Any, ...]
"""Effect of a key for a robot with keys of its own: `("velocity", FORWARD, YAW_RATE)` sends a command once [m/s and
rad/s], `("goal", ACTION, FIELDS)` sends a goal, `("cancel",)` cancels the newest goal, `("end",)` ends the driving."""


@dataclass(frozen=True)
class TeleopTarget:
    """Topic, model and speed limits of the driven robot.

    Attributes:
        topic: velocity topic.
        model: scoped name of the robot's model; empty if it is unknown.
        linear, angular: lowest and highest forward speed [m/s] and yaw rate [rad/s]; infinite if unknown.
        linear_step, angular_step: change of speed [m/s] and yaw rate [rad/s] per key.
        sideways: True if the robot can drive sideways; the limits are those of the forward speed.
        command_timeout: simulated time after a command at which the drive stops by itself [s]; infinite for never.
        key_commands: effect of each key, if the drive plugin has keys of its own, which replace those of `Teleop`.
        key_help: line that explains those keys.
    """

    topic: str
    model: str = ""
    linear: Bounds = _UNLIMITED
    angular: Bounds = _UNLIMITED
    linear_step: float = _COARSE
    angular_step: float = _TURN_STEP
    sideways: bool = False
    command_timeout: float = math.inf
    key_commands: Mapping[str, KeyCommand] | None = None
    key_help: str = ""


def find_target(sim: Simulation, requested: str = "") -> TeleopTarget:
    """Find the robot to drive.

    Args:
        sim: loaded simulation.
        requested: velocity topic; empty for `/cmd_vel`, else the world's only velocity topic.

    Raises:
        InputError: SK-CLI-051 the topic has no subscriber of velocities, or several topics are possible.
    """
    owners: dict[str, object] = {}
    for topic, endpoint, types, role in sim.communication.bus.endpoints():
        if role == "takes" and endpoint.active and any(type_name in TWISTS for type_name in types):
            owners.setdefault(topic, endpoint.owner)
    if requested:
        topic = requested if requested.startswith("/") else "/" + requested
        if topic not in owners:
            known = f"velocity topics: {', '.join(owners)}" if owners else "the world has no velocity topic"
            hint = did_you_mean(topic, owners) or known
            raise InputError("SK-CLI-051", f"--teleop: {topic!r} has no subscriber of velocities; {hint}")
    else:
        topic = _choose_topic(owners)
    return _describe_target(sim, topic, owners[topic])


def find_targets(sim: Simulation) -> list[TeleopTarget]:
    """Return all robots that can be driven: one topic of each drive plugin, with `/cmd_vel` first.

    Programs that receive velocities are static models, and no robots: Nav2's `behavior_server` on `/cmd_vel_teleop`.
    """
    topic_by_owner: dict[int, tuple[str, object]] = {}
    for topic, endpoint, types, role in sim.communication.bus.endpoints():
        if role == "takes" and endpoint.active and any(type_name in TWISTS for type_name in types):
            known = topic_by_owner.setdefault(id(endpoint.owner), (topic, endpoint.owner))
            if topic == "/cmd_vel" != known[0]:
                topic_by_owner[id(endpoint.owner)] = (topic, endpoint.owner)
    targets = [_describe_target(sim, topic, owner) for topic, owner in topic_by_owner.values()]
    targets = [target for target in targets if not (target.model and sim.model(target.model).static)]
    return sorted(targets, key=lambda target: target.topic != "/cmd_vel")


def _choose_topic(owners: dict[str, object]) -> str:
    if "/cmd_vel" in owners:
        return "/cmd_vel"
    if not owners:
        raise InputError(
            "SK-CLI-051",
            "--teleop: the world has no velocity topic (Twist or TwistStamped)",
            help="add a robot with a drive plugin, such as --spawn turtlebot3_burger",
        )
    if len({id(owner) for owner in owners.values()}) > 1:
        text = f"--teleop: several robots have velocity topics: {', '.join(owners)}"
        raise InputError("SK-CLI-051", text, help=f"choose one with --teleop {next(iter(owners))}")
    return next(iter(owners))  # all topics belong to one drive plugin


def _describe_target(sim: Simulation, topic: str, owner: object) -> TeleopTarget:
    scoped = getattr(owner, "scoped", "")
    try:
        model = sim.model(scoped) if scoped else None
    except KeyError:  # the subscriber is a plugin of the world or of a sensor
        model = None
    names = (*getattr(owner, "filenames", ()), *getattr(owner, "names", ()))
    linear, angular = _speed_limits(model, topic, owner)
    return TeleopTarget(
        topic,
        "" if model is None else model.scoped,
        linear,
        angular,
        _FINE if linear[1] <= _SLOW else _COARSE,
        _TURN_STEP,
        any(_HOLONOMIC_DRIVES.search(name) for name in names),
        owner.command_timeout(topic) if hasattr(owner, "command_timeout") else math.inf,
        owner.key_commands(topic) if hasattr(owner, "key_commands") else None,
        getattr(owner, "key_help", ""),
    )


def _speed_limits(model: Model | None, topic: str, owner: object) -> tuple[Bounds, Bounds]:
    """Return the linear and the angular speed limits for keyboard commands.

    They are the limits of the drive plugin. If it has none, they are those of a TurtleBot3; other robots have no limit.
    """
    speed_bounds = getattr(owner, "speed_bounds", None)
    limits: tuple[Bounds, Bounds] | None = None if speed_bounds is None else speed_bounds(topic)
    if limits is not None and any(math.isfinite(bound) for bounds in limits for bound in bounds):
        return limits
    most = None if model is None else _turtlebot3_limits(model)
    return (_UNLIMITED, _UNLIMITED) if most is None else ((-most[0], most[0]), (-most[1], most[1]))


def _turtlebot3_limits(model: Model) -> tuple[float, float] | None:
    """Return speed [m/s] and yaw rate [rad/s] of a TurtleBot3, by its name, file or folder; None for another robot."""
    joints = model.joints
    file = "/".join(PurePath(model.scene.where.file or "").parts[-2:])
    if not _TURTLEBOT.search(f"{model.scoped} {file}") or not all(name in joints for name in _WHEELS):
        return None
    left, right = (joints[name].scene.pose_world.position for name in _WHEELS)
    return _BURGER if math.dist(left, right) < _BURGER_WIDTH else _WAFFLE


RATE: Final = 10.0
"""Rate of the commands [Hz], simulated time."""
KEY_TIMEOUT: Final = 10.0
"""Default simulated time without a key after which a robot is stopped [s]."""
_FASTER: Final = 1.1  # factor on all speeds for the key q
_DIGITS: Final = 6  # decimals of a speed, so that many steps up and down add no rounding error
_AHEAD: Final = {"w": 1, UP: 1, "x": -1, DOWN: -1}
_TURN: Final = {"a": 1, LEFT: 1, "d": -1, RIGHT: -1}
_SIDEWAYS: Final = {"j": 1, "l": -1}
_SCALE: Final = {"q": _FASTER, "+": _FASTER, "=": _FASTER, "z": 1 / _FASTER, "-": 1 / _FASTER}
_ROUNDING: Final = 1e-6  # [steps]
_EMPTY: Final = (0.0, 0.0, 0.0)


class Teleop:
    """Speeds requested by keys, and their velocity commands.

    After the first key, commands are sent ten times a simulated second. After `key_timeout` without a key, a stop
    command is sent, and then nothing until the next key, so that other publishers can drive.

    Args:
        sim: loaded simulation.
        target: robot to drive.
        key_timeout: simulated time without a key after which the robot is stopped [s]; infinite for never.

    Attributes:
        target: robot to drive.
        speeds: requested forward speed [m/s], speed to the left [m/s] and yaw rate to the left [rad/s].
        is_expired: True if the robot was stopped after the timeout.
        fault: error of the last command; empty if it was sent.
    """

    def __init__(self, sim: Simulation, target: TeleopTarget, key_timeout: float = KEY_TIMEOUT) -> None:
        self._sim, self.target = sim, target
        self.speeds = _EMPTY
        self.is_expired = False
        self.fault = ""
        self._scale = 1.0
        self._is_active = False
        self._timeout = key_timeout
        self._key_time = self._sent_time = 0.0  # [s] simulated
        self._sent: int | None = None  # tick of the last periodic command
        self._last_command: tuple[int, tuple[float, float, float]] | None = None  # tick and speeds
        self._goal: GoalHandle | None = None  # newest goal of a key
        self._has_ended = False

    # ------------------------------------------------------------------ keys

    def press(self, key: str) -> bool:
        """Process a key, upper or lower case; return True if it is a driving key."""
        key = key.lower()
        if self.target.key_commands is not None:
            return self._press_own_key(self.target.key_commands.get(key))
        if key == "s":
            self._note_key()
            self.stop()
            return True
        if key not in _AHEAD and key not in _TURN and key not in _SCALE and key not in _SIDEWAYS:
            return False
        if key in _SIDEWAYS and not self.target.sideways:
            return False
        self._note_key()
        if key in _SCALE:
            self._multiply(_SCALE[key])
        else:
            self._add(_AHEAD.get(key, 0), _SIDEWAYS.get(key, 0), _TURN.get(key, 0))
        return True

    def _press_own_key(self, command: KeyCommand | None) -> bool:
        """Process a key of a robot with keys of its own; its commands are sent once."""
        if command is None or self._has_ended:
            return False
        kind, *arguments = command
        if kind == "velocity":
            self.speeds = arguments[0], 0.0, arguments[1]
            self._send()
            self.speeds = _EMPTY
        elif kind == "goal":
            action, fields = arguments
            try:
                self._goal = self._sim.send_goal(action, fields)
                self.fault = ""
            except ActionError as error:  # the robot was removed
                self.fault = str(error)
        elif kind == "cancel":
            if self._goal is not None and self._goal.is_active:
                self._goal.cancel()
        else:
            self._has_ended = True
            self.fault = "driving has ended with the key q; Ctrl-C ends the run"
        return True

    def drive(self, ahead: float, left: float, turn: float) -> None:
        """Request speeds within the limits: forward and to the left [m/s], and yaw rate to the left [rad/s]."""
        self._note_key()
        self._set_speeds(ahead, left if self.target.sideways else 0.0, turn)

    def stop(self) -> None:
        """Command zero speed at once."""
        self.speeds, self.is_expired = _EMPTY, False
        self._send()

    def release_keys(self) -> None:
        """Stop the robot and send no more commands until the next key."""
        if self._is_active:
            self.stop()
        self._is_active = False

    def _note_key(self) -> None:
        if not self._is_active:
            self._is_active, self._sent = True, None
        self.is_expired = False
        self._key_time = self._sim.time

    def _add(self, ahead: int, left: int, turn: int) -> None:
        step, turn_step = self.target.linear_step * self._scale, self.target.angular_step * self._scale
        self._set_speeds(self.speeds[0] + ahead * step, self.speeds[1] + left * step, self.speeds[2] + turn * turn_step)

    def _set_speeds(self, ahead: float, left: float, turn: float) -> None:
        linear = self.target.linear
        self.speeds = _clamp(ahead, linear), _clamp(left, linear), _clamp(turn, self.target.angular)

    def _multiply(self, factor: float) -> None:
        """Scale all speeds and steps by one factor, so that a curve keeps its radius. No speed exceeds its limit."""
        bounds = (self.target.linear, self.target.linear, self.target.angular)
        for speed, (least, most) in zip(self.speeds, bounds, strict=True):
            if speed and factor > 1:
                factor = max(1.0, min(factor, (most if speed > 0 else least) / speed))
        self._scale *= factor
        ahead, left, turn = self.speeds
        self._set_speeds(ahead * factor, left * factor, turn * factor)

    # ------------------------------------------------------------------ commands

    @property
    def next_tick(self) -> int | None:
        """Tick of the next command; None while nothing is sent."""
        if not self._is_active:
            return None
        tick: int = self._sim.tick
        # after a reset of the world, the time of the last command is in the future
        first = tick + 1 if tick == self._sent else tick
        per_command: float = 1.0 / (RATE * self._sim.timestep)
        # command k is sent at the first tick at or after k periods; the tolerance absorbs rounding errors
        number = math.floor((first - 1 + _ROUNDING) / per_command) + 1
        return math.ceil(max(0, number) * per_command - _ROUNDING)

    def send_due(self) -> None:
        """Send the command that is due at the present tick."""
        due = self.next_tick
        if due is None or due > self._sim.tick:
            return
        self._sent = self._sim.tick
        self._key_time = min(self._key_time, self._sim.time)
        if self._sim.time - self._key_time >= self._timeout - 1e-9:
            was_moving = any(self.speeds)
            self.release_keys()
            self.is_expired = was_moving
        else:
            self._send()

    def _send(self) -> None:
        now = (self._sim.tick, self.speeds)
        if now == self._last_command:  # the key s was pressed again in the same tick
            return
        self._last_command = now
        ahead, left, turn = self.speeds
        twist = {"linear": {"x": ahead, "y": left}, "angular": {"z": turn}}
        bus = self._sim.communication.bus
        try:
            if self._takes_stamped():
                stamp = {"sec": self._sim.time_ns // 1_000_000_000, "nanosec": self._sim.time_ns % 1_000_000_000}
                bus.publish(self.target.topic, {"header": {"stamp": stamp}, "twist": twist})
            else:
                bus.publish(self.target.topic, twist)
        except MessageError as error:  # the subscriber was removed
            self.fault = str(error)
        else:
            self.fault = ""

    def _takes_stamped(self) -> bool:
        """Check whether the first subscriber of velocities accepts TwistStamped first or only."""
        ends = self._sim.communication.bus.endpoints(self.target.topic)
        accepted: list[str] = [t for _, end, types, role in ends if role == "takes" and end.active for t in types]
        return next((type_name for type_name in accepted if type_name in TWISTS), "") == TWISTS[1]


def _clamp(speed: float, bounds: Bounds) -> float:
    return round(min(max(speed, bounds[0]), bounds[1]), _DIGITS) + 0.0  # no minus zero
