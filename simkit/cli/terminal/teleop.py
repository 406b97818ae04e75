"""Choose the topic that the keyboard drives, and turn keys into velocity commands."""

from __future__ import annotations

import math
import re
from dataclasses import dataclass
from typing import TYPE_CHECKING, Final

from simkit.cli.terminal.keyboard import DOWN, LEFT, RIGHT, UP
from simkit.diagnostics import did_you_mean
from simkit.errors import InputError, MessageError

if TYPE_CHECKING:
    from simkit.runtime import Model, Simulation

TWISTS: Final = ("geometry_msgs/msg/Twist", "geometry_msgs/msg/TwistStamped")
Bounds = tuple[float, float]

_UNLIMITED: Final = (-math.inf, math.inf)
_BURGER: Final = (0.22, 2.84)  # [m/s, rad/s] which the real ones reach (turtlebot3_teleop); their files hold no limit
_WAFFLE: Final = (0.26, 1.82)
_BURGER_WIDTH: Final = 0.2  # [m] between the wheels: a burger has less, a waffle more
_TURTLEBOT: Final = re.compile("turtlebot|burger|waffle|tb3", re.IGNORECASE)
_WHEELS: Final = ("wheel_left_joint", "wheel_right_joint")
_HOLONOMIC_DRIVES: Final = re.compile("mecanum|planar_move|velocity-control|omni", re.IGNORECASE)
_FINE, _COARSE, _TURN_STEP = 0.01, 0.05, 0.1  # [m/s, m/s, rad/s] that a key adds
_SLOW: Final = 0.5  # [m/s]: a robot that is no faster is driven in fine steps


@dataclass(frozen=True)
class TeleopTarget:
    """Topic, model and speed limits of what is driven.

    Attributes:
        topic: takes the commands.
        model: scoped name of the model that they move; empty where that is not known.
        linear, angular: least and greatest speed ahead [m/s] and rate of turning [rad/s]; infinite where none is known.
        linear_step, angular_step: what a key adds to them.
        sideways: whether it can go sideways; as fast as ahead.
    """

    topic: str
    model: str = ""
    linear: Bounds = _UNLIMITED
    angular: Bounds = _UNLIMITED
    linear_step: float = _COARSE
    angular_step: float = _TURN_STEP
    sideways: bool = False


def find_target(sim: Simulation, wanted: str = "") -> TeleopTarget:
    """Whom to drive.

    Args:
        sim: the simulation.
        wanted: the topic; where empty `/cmd_vel`, or else that of the only one who takes velocities.

    Raises:
        InputError: SK-CLI-051 nobody takes velocities there, or several do.
    """
    takers: dict[str, object] = {}
    for topic, end, types, does in sim.communication.bus.endpoints():
        if does == "takes" and end.active and any(one in TWISTS for one in types):
            takers.setdefault(topic, end.owner)
    if wanted:
        topic = wanted if wanted.startswith("/") else "/" + wanted
        if topic not in takers:
            hint = did_you_mean(topic, takers) or (f"there is {', '.join(takers)}" if takers else "no topic does")
            raise InputError(f"SK-CLI-051 --teleop: nothing takes velocities on {topic!r}; {hint}", "SK-CLI-051")
    else:
        topic = _choose_topic(takers)
    return _describe_target(sim, topic, takers[topic])


def _choose_topic(takers: dict[str, object]) -> str:
    if "/cmd_vel" in takers:
        return "/cmd_vel"
    if not takers:
        raise InputError(
            "SK-CLI-051 --teleop: nothing here takes velocities (Twist or TwistStamped)\n"
            "    help: a robot with a drive plugin does, such as --spawn turtlebot3_burger",
            "SK-CLI-051",
        )
    if len({id(owner) for owner in takers.values()}) > 1:
        text = f"SK-CLI-051 --teleop: several topics take velocities: {', '.join(takers)}"
        raise InputError(f"{text}\n    help: name one, --teleop {next(iter(takers))}", "SK-CLI-051")
    return next(iter(takers))  # one drive, whatever its topics


def _describe_target(sim: Simulation, topic: str, owner: object) -> TeleopTarget:
    scoped = getattr(owner, "scoped", "")
    try:
        model = sim.model(scoped) if scoped else None
    except KeyError:  # a plugin of the world, of a sensor
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
    )


def _speed_limits(model: Model | None, topic: str, owner: object) -> tuple[Bounds, Bounds]:
    """Return the speed limits of the drive where it has some, else of the robot where it is known."""
    asked = getattr(owner, "speed_bounds", None)
    found: tuple[Bounds, Bounds] | None = None if asked is None else asked(topic)
    if found is not None and any(math.isfinite(bound) for bounds in found for bound in bounds):
        return found
    most = None if model is None else _turtlebot3_limits(model)
    return (_UNLIMITED, _UNLIMITED) if most is None else ((-most[0], most[0]), (-most[1], most[1]))


def _turtlebot3_limits(model: Model) -> tuple[float, float] | None:
    """Speed [m/s] and rate of turning [rad/s] of a TurtleBot3; None of another robot."""
    joints = model.joints
    if not _TURTLEBOT.search(model.scoped) or not all(name in joints for name in _WHEELS):
        return None
    left, right = (joints[name].scene.pose_world.position for name in _WHEELS)
    return _BURGER if math.dist(left, right) < _BURGER_WIDTH else _WAFFLE


RATE: Final = 10.0
"""[Hz] of simulated time, of the commands."""
KEY_TIMEOUT: Final = 10.0
"""[s] of simulated time without a key after which a robot is stopped, where nothing else is said."""
_FASTER: Final = 1.1  # what q multiplies all speeds with
_DIGITS: Final = 6  # of a speed: many steps there and back make no crumbs
_AHEAD: Final = {"w": 1, UP: 1, "x": -1, DOWN: -1}
_TURN: Final = {"a": 1, LEFT: 1, "d": -1, RIGHT: -1}
_SIDEWAYS: Final = {"j": 1, "l": -1}
_SCALE: Final = {"q": _FASTER, "+": _FASTER, "=": _FASTER, "z": 1 / _FASTER, "-": 1 / _FASTER}
_ROUNDING: Final = 1e-6  # [steps]
_EMPTY: Final = (0.0, 0.0, 0.0)


class Teleop:
    """The speeds that were asked for, and their commands.

    From the first key on what is asked for goes out ten times a simulated second. Once no key has come for
    `key_timeout` a stop goes out, and then nothing until the next key, so that others may drive.

    Args:
        sim: the simulation.
        target: whom to drive.
        key_timeout: [s] of simulated time; infinite for never.

    Attributes:
        target: whom it drives.
        speeds: asked for: ahead [m/s], to the left [m/s], turning to the left [rad/s].
        is_expired: whether it stopped because no key came.
        fault: why the last command did not go out; empty where it did.
    """

    def __init__(self, sim: Simulation, target: TeleopTarget, key_timeout: float = KEY_TIMEOUT) -> None:
        self._sim, self.target = sim, target
        self.speeds = _EMPTY
        self.is_expired = False
        self.fault = ""
        self._scale = 1.0
        self._is_active = False
        self._timeout = key_timeout
        self._key_time = self._sent_time = 0.0  # simulated [s]
        self._sent: int | None = None  # the tick of the last command on the grid
        self._told: tuple[int, tuple[float, float, float]] | None = None  # tick and speeds of the last command

    # ------------------------------------------------------------------ keys

    def press(self, key: str) -> bool:
        """Takes a key; whether it is one of those that drive. Capital letters count as small ones."""
        key = key.lower()
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

    def stop(self) -> None:
        """Command zero speed at once."""
        self.speeds, self.is_expired = _EMPTY, False
        self._send()

    def release_keys(self) -> None:
        """Stop what is driven and send nothing more, since no key will come."""
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
        self._ask_for(self.speeds[0] + ahead * step, self.speeds[1] + left * step, self.speeds[2] + turn * turn_step)

    def _ask_for(self, ahead: float, left: float, turn: float) -> None:
        linear = self.target.linear
        self.speeds = _clamp(ahead, linear), _clamp(left, linear), _clamp(turn, self.target.angular)

    def _multiply(self, factor: float) -> None:
        """Scale all speeds and steps alike, so that a curve stays the same curve; no speed exceeds its limit."""
        bounds = (self.target.linear, self.target.linear, self.target.angular)
        for speed, (least, most) in zip(self.speeds, bounds, strict=True):
            if speed and factor > 1:
                factor = max(1.0, min(factor, (most if speed > 0 else least) / speed))
        self._scale *= factor
        ahead, left, turn = self.speeds
        self._ask_for(ahead * factor, left * factor, turn * factor)

    # ------------------------------------------------------------------ commands

    @property
    def next_tick(self) -> int | None:
        """The tick at which something is to be sent next; None while it is silent."""
        if not self._is_active:
            return None
        tick: int = self._sim.tick
        # where the last one lies ahead, the world went back in time
        first = tick + 1 if tick == self._sent else tick
        per_command: float = 1.0 / (RATE * self._sim.timestep)
        # the k-th command goes out at the first tick at or after k of these; a rounding error is no further step
        number = math.floor((first - 1 + _ROUNDING) / per_command) + 1
        return math.ceil(max(0, number) * per_command - _ROUNDING)

    def send_due(self) -> None:
        """Sends what is due at the present tick."""
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
        if now == self._told:  # however often somebody presses s
            return
        self._told = now
        ahead, left, turn = self.speeds
        twist = {"linear": {"x": ahead, "y": left}, "angular": {"z": turn}}
        bus = self._sim.communication.bus
        try:
            if self._takes_stamped():
                stamp = {"sec": self._sim.time_ns // 1_000_000_000, "nanosec": self._sim.time_ns % 1_000_000_000}
                bus.publish(self.target.topic, {"header": {"stamp": stamp}, "twist": twist})
            else:
                bus.publish(self.target.topic, twist)
        except MessageError as error:  # who took them was removed
            self.fault = str(error)
        else:
            self.fault = ""

    def _takes_stamped(self) -> bool:
        """Check whether the first subscriber of velocities takes TwistStamped first or alone."""
        ends = self._sim.communication.bus.endpoints(self.target.topic)
        taken: list[str] = [one for _, end, types, does in ends if does == "takes" and end.active for one in types]
        return next((one for one in taken if one in TWISTS), "") == TWISTS[1]


def _clamp(speed: float, bounds: Bounds) -> float:
    return round(min(max(speed, bounds[0]), bounds[1]), _DIGITS) + 0.0  # no minus zero
