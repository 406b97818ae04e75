"""`simkit run --teleop`: keys become speeds, and speeds become commands, ten times a simulated second.

It knows neither terminal nor clock: the same keys at the same ticks send the same commands.
"""

from __future__ import annotations

import math
from typing import Any, Final

from simkit.cli.driving.keys import DOWN, LEFT, RIGHT, UP
from simkit.cli.driving.target import TWISTS, Bounds, Target
from simkit.errors import MessageError

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
_CRUMB: Final = 1e-6  # [steps]
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

    def __init__(self, sim: Any, target: Target, key_timeout: float = KEY_TIMEOUT) -> None:
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
            self._touch()
            self.stop()
            return True
        if key not in _AHEAD and key not in _TURN and key not in _SCALE and key not in _SIDEWAYS:
            return False
        if key in _SIDEWAYS and not self.target.sideways:
            return False
        self._touch()
        if key in _SCALE:
            self._multiply(_SCALE[key])
        else:
            self._add(_AHEAD.get(key, 0), _SIDEWAYS.get(key, 0), _TURN.get(key, 0))
        return True

    def stop(self) -> None:
        """Has it stand still, at once."""
        self.speeds, self.is_expired = _EMPTY, False
        self._send()

    def let_go(self) -> None:
        """Nobody will press a key any more: stops what is being driven, and is silent from then on."""
        if self._is_active:
            self.stop()
        self._is_active = False

    def _touch(self) -> None:
        if not self._is_active:
            self._is_active, self._sent = True, None
        self.is_expired = False
        self._key_time = self._sim.time

    def _add(self, ahead: int, left: int, turn: int) -> None:
        target, scale = self.target, self._scale
        step = target.linear_step * scale
        self.speeds = (
            _within(self.speeds[0] + ahead * step, target.linear),
            _within(self.speeds[1] + left * step, target.linear),
            _within(self.speeds[2] + turn * target.angular_step * scale, target.angular),
        )

    def _multiply(self, factor: float) -> None:
        """All speeds and the steps alike, so that a curve stays the same curve; none goes beyond its bound."""
        bounds = (self.target.linear, self.target.linear, self.target.angular)
        for speed, (least, most) in zip(self.speeds, bounds, strict=True):
            if speed and factor > 1:
                factor = max(1.0, min(factor, (most if speed > 0 else least) / speed))
        self._scale *= factor
        self.speeds = (
            _within(self.speeds[0] * factor, bounds[0]),
            _within(self.speeds[1] * factor, bounds[1]),
            _within(self.speeds[2] * factor, bounds[2]),
        )

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
        number = math.floor((first - 1 + _CRUMB) / per_command) + 1
        return math.ceil(max(0, number) * per_command - _CRUMB)

    def send_due(self) -> None:
        """Sends what is due at the present tick."""
        due = self.next_tick
        if due is None or due > self._sim.tick:
            return
        self._sent = self._sim.tick
        self._key_time = min(self._key_time, self._sim.time)
        if self._sim.time - self._key_time >= self._timeout - 1e-9:
            was_moving = any(self.speeds)
            self.let_go()
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
        bus = self._sim.bus
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
        """Whether the first who takes velocities there wants them with a stamp, or nothing else."""
        ends = self._sim.bus.ends(self.target.topic)
        taken: list[str] = [one for _, end, types, does in ends if does == "takes" and end.active for one in types]
        return next((one for one in taken if one in TWISTS), "") == TWISTS[1]


def _within(speed: float, bounds: Bounds) -> float:
    return round(min(max(speed, bounds[0]), bounds[1]), _DIGITS) + 0.0  # no minus zero
