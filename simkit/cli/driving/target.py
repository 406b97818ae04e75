"""Whom the keyboard drives: the topic that takes velocities, what stands behind it, and how fast that may go."""

from __future__ import annotations

import math
import re
from dataclasses import dataclass
from typing import Any, Final

from simkit.diagnostics import did_you_mean
from simkit.errors import InputError

TWISTS: Final = ("geometry_msgs/msg/Twist", "geometry_msgs/msg/TwistStamped")
Bounds = tuple[float, float]

_ENDLESS: Final = (-math.inf, math.inf)
_BURGER: Final = (0.22, 2.84)  # [m/s, rad/s] which the real ones reach (turtlebot3_teleop); their files hold no limit
_WAFFLE: Final = (0.26, 1.82)
_BURGER_WIDTH: Final = 0.2  # [m] between the wheels: a burger has less, a waffle more
_TURTLEBOT: Final = re.compile("turtlebot|burger|waffle|tb3", re.IGNORECASE)
_WHEELS: Final = ("wheel_left_joint", "wheel_right_joint")
_SIDEWAYS: Final = re.compile("mecanum|planar_move|velocity-control|omni", re.IGNORECASE)
_FINE, _COARSE, _TURN = 0.01, 0.05, 0.1  # [m/s, m/s, rad/s] that a key adds
_SLOW: Final = 0.5  # [m/s]: a robot that is no faster is driven in fine steps


@dataclass(frozen=True)
class Target:
    """What is driven.

    Attributes:
        topic: takes the commands.
        model: scoped name of the model that they move; empty where that is not known.
        linear, angular: least and greatest speed ahead [m/s] and rate of turning [rad/s]; infinite where none is known.
        linear_step, angular_step: what a key adds to them.
        sideways: whether it can go sideways; as fast as ahead.
    """

    topic: str
    model: str = ""
    linear: Bounds = _ENDLESS
    angular: Bounds = _ENDLESS
    linear_step: float = _COARSE
    angular_step: float = _TURN
    sideways: bool = False


def find_target(sim: Any, wanted: str = "") -> Target:
    """Whom to drive.

    Args:
        sim: the simulation.
        wanted: the topic; where empty `/cmd_vel`, or else that of the only one who takes velocities.

    Raises:
        InputError: SK-CLI-051 nobody takes velocities there, or several do.
    """
    takers: dict[str, Any] = {}
    for topic, end, types, does in sim.bus.ends():
        if does == "takes" and end.active and any(one in TWISTS for one in types):
            takers.setdefault(topic, end.owner)
    if wanted:
        topic = wanted if wanted.startswith("/") else "/" + wanted
        if topic not in takers:
            hint = did_you_mean(topic, takers) or (f"there is {', '.join(takers)}" if takers else "no topic does")
            raise InputError(f"SK-CLI-051 --teleop: nothing takes velocities on {topic!r}; {hint}", "SK-CLI-051")
    else:
        topic = _only(takers)
    return _target(sim, topic, takers[topic])


def _only(takers: dict[str, Any]) -> str:
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


def _target(sim: Any, topic: str, owner: Any) -> Target:
    scoped = getattr(owner, "scoped", "")
    try:
        model = sim.model(scoped) if scoped else None
    except KeyError:  # a plugin of the world, of a sensor
        model = None
    names = (*getattr(owner, "filenames", ()), *getattr(owner, "names", ()))
    linear, angular = _bounds(model, topic, owner)
    return Target(
        topic,
        "" if model is None else model.scoped,
        linear,
        angular,
        _FINE if linear[1] <= _SLOW else _COARSE,
        _TURN,
        any(_SIDEWAYS.search(name) for name in names),
    )


def _bounds(model: Any, topic: str, owner: Any) -> tuple[Bounds, Bounds]:
    """Of the drive itself where it has them, else of the robot where it is known."""
    asked = getattr(owner, "speed_bounds", None)
    found: tuple[Bounds, Bounds] | None = None if asked is None else asked(topic)
    if found is not None and any(math.isfinite(bound) for bounds in found for bound in bounds):
        return found
    most = None if model is None else _of_turtlebot3(model)
    return (_ENDLESS, _ENDLESS) if most is None else ((-most[0], most[0]), (-most[1], most[1]))


def _of_turtlebot3(model: Any) -> tuple[float, float] | None:
    """Speed [m/s] and rate of turning [rad/s] of a TurtleBot3; None of another robot."""
    joints = model.joints
    if not _TURTLEBOT.search(model.scoped) or not all(name in joints for name in _WHEELS):
        return None
    left, right = (joints[name].scene.pose_world.position for name in _WHEELS)
    return _BURGER if math.dist(left, right) < _BURGER_WIDTH else _WAFFLE
