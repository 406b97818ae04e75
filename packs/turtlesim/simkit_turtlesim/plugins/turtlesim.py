"""World plugin with the turtles of ROS 2's `turtlesim_node`: their topics, services, action and parameters."""

from __future__ import annotations

import math
import re
from collections.abc import Callable, Mapping
from dataclasses import dataclass, field
from typing import TYPE_CHECKING, Final, Protocol, TypeVar

import numpy as np
import numpy.typing as npt

from simkit import Params, Plugin, Pose, msgs
from simkit.extend import SharedByCopies, acts, listens, offers, publish_while_subscribed, publishes
from simkit.linear_algebra import matmul
from simkit.pose import wrap_angle

if TYPE_CHECKING:
    from simkit import Model, Publisher, Simulation
    from simkit.extend import GoalHandle

Argument = TypeVar("Argument")

_PERIOD: Final = 0.016  # [s] between two updates
_COMMAND_TIME: Final = 1.0  # [s] for which a command stays active
_TURNING_SPEED: Final = 1.0  # [rad/s] of the action
_TOLERANCE: Final = 0.02  # [rad] of the action
_PIXELS: Final = 500  # side of the window
_SCALE: Final = 45.0  # [px/m]
_SIZE: Final = (_PIXELS - 1) / _SCALE  # [m]
_MIDDLE: Final = 5.544445  # [m], x and y of the first turtle
_BACKGROUND: Final = {"r": ("red", 69), "g": ("green", 86), "b": ("blue", 255)}
_ARROWS: Final = {
    "up": ("velocity", 2.0, 0.0),
    "down": ("velocity", -2.0, 0.0),
    "left": ("velocity", 0.0, 2.0),
    "right": ("velocity", 0.0, -2.0),
}
"""Commands of the arrow keys [m/s, rad/s], each for 1 s."""
_PEN: Final = (0xB3, 0xB8, 0xFF)
_TURTLE_COLOUR: Final = (90, 160, 60)
_SHAPE: Final = np.array([(18.0, 0.0), (-14.0, 12.0), (-8.0, 0.0), (-14.0, -12.0)])  # [px] of a turtle in the image
_IMAGE_RATE: Final = 10.0  # [Hz]
_MODEL: Final = "turtlesim_turtle"
_TYPES: Final = "turtlesim"
_NAME: Final = re.compile(r"[A-Za-z_][A-Za-z0-9_]{0,99}")  # a part of a topic's name

Image = npt.NDArray[np.uint8]


@dataclass
class Turtle:
    """Pose, command and pen of a turtle.

    Attributes:
        x, y: position [m].
        theta: heading [rad], between -pi and pi.
        forward, sideways, turning: commanded velocity [m/s, m/s, rad/s].
        commanded: simulated time of the newest command [s].
        pen, width: colour (RGB) and width [px] of the trail.
        is_pen_down: True if the turtle draws.
        goal: active goal of the action.
        begin: heading at the start of the goal [rad].
        is_placed: True if its model exists, so that a removed model removes the turtle.
    """

    x: float
    y: float
    theta: float
    forward: float = 0.0
    sideways: float = 0.0
    turning: float = 0.0
    commanded: float = -math.inf
    pen: tuple[int, int, int] = _PEN
    width: int = 3
    is_pen_down: bool = True
    goal: GoalHandle | None = None
    begin: float = 0.0
    is_placed: bool = False


class _Endpoint(Protocol):
    """Open topic, service or action."""

    def close(self) -> None: ...


@dataclass(eq=False)
class _TurtleEndpoints:
    """Open topics, services and action of a turtle."""

    pose: Publisher
    colour: Publisher
    others: tuple[_Endpoint, ...]

    def close(self) -> None:
        """Close all of them."""
        for endpoint in (self.pose, self.colour, *self.others):
            endpoint.close()


@dataclass(eq=False)
class _Endpoints(SharedByCopies):
    """Open topics, services and actions by the name of their turtle."""

    by_turtle: dict[str, _TurtleEndpoints] = field(default_factory=dict)


class TurtleSim(Plugin):
    """Moves the turtles of `turtlesim_node`, which draw with pens on a square of 11.09 m.

    Names, types, defaults and behaviour are those of ROS 2's turtlesim: a command lasts 1 s, updates come every 16 ms,
    turtles stop at the walls. Each turtle is a model, a copy of `model://turtlesim_turtle`. `~/image` shows the window.
    The lower left corner of the square is the origin of the world, or of the model that has the plugin. Such models
    are several squares in one world; the names of their turtles' models begin with the name of the square's model.
    """

    filenames = ("libsimkit_turtlesim.so",)
    names = ("simkit::TurtleSim",)
    parent_kind = ("world", "model")
    endpoints = (
        listens("<turtle>/cmd_vel", "geometry_msgs/msg/Twist"),
        publishes("<turtle>/pose", "turtlesim/msg/Pose"),
        publishes("<turtle>/color_sensor", "turtlesim/msg/Color"),
        offers("<turtle>/set_pen", "turtlesim/srv/SetPen"),
        offers("<turtle>/teleport_absolute", "turtlesim/srv/TeleportAbsolute"),
        offers("<turtle>/teleport_relative", "turtlesim/srv/TeleportRelative"),
        acts("<turtle>/rotate_absolute", "turtlesim/action/RotateAbsolute"),
    )
    after_step_rate = 1.0 / _PERIOD
    reads_at_load = ("pose_world",)

    def load(self, parent: Simulation | Model, params: Params) -> None:
        self._origin, self._prefix = Pose(), ""
        if self.scoped:
            self._origin = self.sim.model(self.scoped).pose
            self._prefix = "" if self.scoped == _TYPES else f"{self.scoped}_"
        self._background = [
            self.declare(
                f"background_{channel}",
                value,
                minimum=0,
                maximum=255,
                description=f"{name} channel of the background color",
                on_change=lambda _: self._repaint(),
            )
            for channel, (name, value) in _BACKGROUND.items()
        ]
        self._holonomic = self.declare("holonomic", False, description="turtles follow linear.y, too")
        self._endpoints = _Endpoints()
        self._turtles: dict[str, Turtle] = {}
        self._clear()
        self.offer("clear", "std_srvs/srv/Empty", lambda _: self._clear())
        self.offer("reset", "std_srvs/srv/Empty", lambda _: self._start_again())
        self.offer("spawn", f"{_TYPES}/srv/Spawn", self._on_spawn)
        self.offer("kill", f"{_TYPES}/srv/Kill", self._on_kill)
        model = self._model_name("turtle1")
        begin = Pose((_MIDDLE, _MIDDLE, 0.0))
        if model in self.sim.models:
            begin = self._origin.inverse() @ self.sim.models[model].pose
        self._add("turtle1", float(begin.position[0]), float(begin.position[1]), float(begin.rpy[2]))
        self._image = self.advertise("~/image", "sensor_msgs/msg/Image")
        publish_while_subscribed(self, self._image, _IMAGE_RATE, "publish_image")

    # ------------------------------------------------------------------ keys of --teleop

    key_help = "arrows: 2 m/s or 2 rad/s for 1 s   g b v c d e r t: turn to a heading   f cancel   q quit"

    def key_commands(self, topic: str) -> Mapping[str, tuple[object, ...]]:
        """Return the effects of the keys of `turtle_teleop_key` for the turtle with a command topic.

        The keys around `f` have the headings in which they lie from it, in steps of 45 degrees.
        """
        action = topic.removesuffix("cmd_vel") + "rotate_absolute"
        headings = {key: math.remainder(number * math.pi / 4, math.tau) for number, key in enumerate("gtredcvb")}
        goals = {key: ("goal", action, {"theta": heading}) for key, heading in headings.items()}
        return {**_ARROWS, **goals, "f": ("cancel",), "q": ("end",)}

    # ------------------------------------------------------------------ services

    def _clear(self) -> None:
        self._canvas: Image = np.zeros((_PIXELS, _PIXELS, 3), np.uint8)
        self._trails: Image = np.zeros((_PIXELS, _PIXELS), np.uint8)  # 1 where a pen has drawn
        self._repaint()

    def _repaint(self) -> None:
        """Fill all pixels without a trail with the background, as `paintEvent` of turtlesim's window does."""
        self._canvas[self._trails == 0] = [channel.value for channel in self._background]

    def _start_again(self) -> None:
        self.log.info("Resetting turtlesim.")
        for name in list(self._turtles):
            self._remove(name)
        self._clear()
        self._add("turtle1", _MIDDLE, _MIDDLE, 0.0)

    def _on_spawn(self, request: msgs.turtlesim__srv__Spawn_Request) -> dict[str, str]:
        name = request.name
        if not name:
            number = 1
            while self._is_used(f"turtle{number}"):
                number += 1
            name = f"turtle{number}"
        if self._is_used(name):
            self.log.error("A turtle named [%s] already exists", name)
            return {"name": ""}
        if not all(map(math.isfinite, (request.x, request.y, request.theta))) or not _NAME.fullmatch(name):
            self.log.error("Cannot spawn turtle %.60r: the name must be that of a topic, the pose must be finite", name)
            return {"name": ""}
        self.log.info("Spawning turtle [%s] at x=[%f], y=[%f], theta=[%f]", name, request.x, request.y, request.theta)
        self._add(name, request.x, request.y, request.theta)
        return {"name": name}

    def _on_kill(self, request: msgs.turtlesim__srv__Kill_Request) -> None:
        if request.name not in self._turtles:
            self.log.error("Tried to kill turtle [%s], which does not exist", request.name)
            return
        self._remove(request.name)

    def _on_set_pen(self, turtle: Turtle, request: msgs.turtlesim__srv__SetPen_Request) -> None:
        turtle.is_pen_down = not request.off
        if turtle.is_pen_down:
            turtle.pen, turtle.width = (request.r, request.g, request.b), request.width

    def _teleport(self, turtle: Turtle, x: float, y: float, theta: float) -> None:
        if not all(map(math.isfinite, (x, y, theta))):
            self.log.error("Cannot teleport a turtle to a pose with NaN or infinite values")
            return
        before, turtle.theta = (turtle.x, turtle.y), wrap_angle(theta)
        self._move(turtle, x, y)
        self._draw(turtle, before)

    # ------------------------------------------------------------------ the action

    def _on_goal(self, turtle: Turtle, goal: GoalHandle) -> None:
        if not math.isfinite(goal.request.theta):
            goal.reject("theta is NaN or infinite")
            return
        if turtle.goal is not None:
            self.log.warning("Rotation goal received before a previous goal finished. Aborting previous goal")
            turtle.goal.abort(_result(turtle))
        turtle.goal, turtle.begin = goal, turtle.theta

    def _on_cancel(self, turtle: Turtle, goal: GoalHandle) -> None:
        goal.canceled(_result(turtle))
        turtle.goal, turtle.turning = None, 0.0

    def _turn_to_goal(self, turtle: Turtle) -> None:
        """Set the turning speed of the action, or end the goal."""
        goal = turtle.goal
        assert goal is not None
        remaining = wrap_angle(goal.request.theta - turtle.theta)
        turtle.commanded = self.sim.time
        turtle.forward = turtle.sideways = 0.0
        goal.publish_feedback({"remaining": remaining})
        if abs(remaining) < _TOLERANCE:
            self.log.info("Rotation goal completed successfully")
            goal.succeed(_result(turtle))
            turtle.goal, turtle.turning = None, 0.0
        else:
            turtle.turning = math.copysign(_TURNING_SPEED, remaining)

    # ------------------------------------------------------------------ turtles

    def _add(self, name: str, x: float, y: float, theta: float) -> None:
        turtle = self._turtles[name] = Turtle(x, y, wrap_angle(theta))
        turtle.x, turtle.y = _inside(x), _inside(y)
        self._match_endpoints()

    def _remove(self, name: str) -> None:
        goal = self._turtles.pop(name).goal
        if goal is not None:
            goal.abort(reason=f"turtle {name} was removed")
        self._match_endpoints()
        if self._model_name(name) in self.sim.models:
            self.sim.remove(self._model_name(name))

    def _model_name(self, turtle: str) -> str:
        return f"{self._prefix}{turtle}"

    def _is_used(self, turtle: str) -> bool:
        return turtle in self._turtles or self._model_name(turtle) in self.sim.models

    def _match_endpoints(self) -> None:
        """Open the topics of new turtles, and close those of turtles that are gone."""
        open_ends = self._endpoints.by_turtle
        for name in [name for name in open_ends if name not in self._turtles]:
            open_ends.pop(name).close()
        for name in [name for name in self._turtles if name not in open_ends]:
            open_ends[name] = self._open(name)

    def _open(self, name: str) -> _TurtleEndpoints:
        """Open the topics, services and the action of a turtle."""

        def of_turtle(function: Callable[[Turtle, Argument], None]) -> Callable[[Argument], None]:
            return lambda argument: function(self._turtles[name], argument) if name in self._turtles else None

        def absolute(turtle: Turtle, request: msgs.turtlesim__srv__TeleportAbsolute_Request) -> None:
            self._teleport(turtle, request.x, request.y, request.theta)

        def relative(turtle: Turtle, request: msgs.turtlesim__srv__TeleportRelative_Request) -> None:
            theta, way = turtle.theta + request.angular, request.linear
            self._teleport(turtle, turtle.x + way * math.cos(theta), turtle.y + way * math.sin(theta), theta)

        return _TurtleEndpoints(
            self.advertise(f"{name}/pose", f"{_TYPES}/msg/Pose"),
            self.advertise(f"{name}/color_sensor", f"{_TYPES}/msg/Color"),
            (
                self.listen(f"{name}/cmd_vel", "geometry_msgs/msg/Twist", of_turtle(self._on_command)),
                self.offer(f"{name}/set_pen", f"{_TYPES}/srv/SetPen", of_turtle(self._on_set_pen)),
                self.offer(f"{name}/teleport_absolute", f"{_TYPES}/srv/TeleportAbsolute", of_turtle(absolute)),
                self.offer(f"{name}/teleport_relative", f"{_TYPES}/srv/TeleportRelative", of_turtle(relative)),
                self.act(
                    f"{name}/rotate_absolute",
                    f"{_TYPES}/action/RotateAbsolute",
                    of_turtle(self._on_goal),
                    of_turtle(self._on_cancel),
                ),
            ),
        )

    def _on_command(self, turtle: Turtle, message: msgs.Twist) -> None:
        values = message.linear.x, message.linear.y, message.angular.z
        if not all(map(math.isfinite, values)):
            self.log.error("A velocity with NaN or infinite values was ignored")
            return
        turtle.forward, turtle.sideways, turtle.turning = values
        turtle.commanded = self.sim.time

    def set_state(self, state: Mapping[str, object]) -> None:
        super().set_state(state)
        self._match_endpoints()

    # ------------------------------------------------------------------ motion

    def after_step(self) -> None:
        for name, turtle in list(self._turtles.items()):
            if turtle.is_placed and self._model_name(name) not in self.sim.models:
                self._remove(name)
                continue
            before = turtle.x, turtle.y
            self._update(turtle)
            self._place_model(name, turtle)
            endpoints = self._endpoints.by_turtle[name]
            fields = {"x": turtle.x, "y": turtle.y, "theta": turtle.theta, "angular_velocity": turtle.turning}
            speed = math.hypot(turtle.forward, turtle.sideways)
            endpoints.pose.publish(msgs.make(f"{_TYPES}/msg/Pose", linear_velocity=speed, **fields))
            column, row = _pixel(turtle.x, turtle.y)
            red, green, blue = self._canvas[row, column].tolist()  # without the newest piece of the turtle's own trail
            endpoints.colour.publish(msgs.make(f"{_TYPES}/msg/Color", r=red, g=green, b=blue))
            self._draw(turtle, before)

    def _update(self, turtle: Turtle) -> None:
        """Move a turtle by one period."""
        if turtle.goal is not None:
            self._turn_to_goal(turtle)
        if self.sim.time - turtle.commanded > _COMMAND_TIME:
            turtle.forward = turtle.sideways = turtle.turning = 0.0
        if not self._holonomic.value:
            turtle.sideways = 0.0
        turtle.theta = wrap_angle(turtle.theta + turtle.turning * _PERIOD)
        cos, sin = math.cos(turtle.theta), math.sin(turtle.theta)
        way, aside = turtle.forward * _PERIOD, turtle.sideways * _PERIOD
        if way or aside:
            self._move(turtle, turtle.x + way * cos - aside * sin, turtle.y + way * sin + aside * cos)

    def _move(self, turtle: Turtle, x: float, y: float) -> None:
        """Move a turtle, not beyond the walls."""
        turtle.x, turtle.y = _inside(x), _inside(y)
        if (turtle.x, turtle.y) != (x, y):
            self.log.warning("Oh no! I hit the wall! (Clamping from [x=%f, y=%f])", x, y)

    def _draw(self, turtle: Turtle, before: tuple[float, float]) -> None:
        """Draw the trail from a place to the present one."""
        if turtle.is_pen_down and before != (turtle.x, turtle.y) and turtle.width:
            import cv2

            ends = _pixel(*before), _pixel(turtle.x, turtle.y)
            cv2.line(self._canvas, *ends, turtle.pen, turtle.width)
            cv2.line(self._trails, *ends, 1, turtle.width)

    def _place_model(self, name: str, turtle: Turtle) -> None:
        """Move the model of a turtle, which is spawned first if it does not exist."""
        pose = self._origin @ Pose.from_rpy(turtle.x, turtle.y, 0.0, 0.0, 0.0, turtle.theta)
        turtle.is_placed, model = True, self._model_name(name)
        if model not in self.sim.models:
            self.sim.spawn(_MODEL, model, pose)
        else:
            self.sim.model(model).set_pose(pose)

    def publish_image(self) -> None:
        """Publish the window with trails and turtles."""
        import cv2

        image = self._canvas.copy()
        for turtle in self._turtles.values():
            cos, sin = math.cos(turtle.theta), math.sin(turtle.theta)
            corners = matmul(_SHAPE, np.array([[cos, -sin], [-sin, -cos]])) + _pixel(turtle.x, turtle.y)
            cv2.fillPoly(image, [np.round(corners).astype(np.int32)], _TURTLE_COLOUR)
        size = {"height": _PIXELS, "width": _PIXELS, "step": 3 * _PIXELS}
        header = msgs.header(self.sim.time_ns, "window")
        self._image.publish(
            msgs.make("sensor_msgs/msg/Image", header=header, encoding="rgb8", data=image.reshape(-1), **size)
        )


def _result(turtle: Turtle) -> dict[str, float]:
    """Return the result of the action: the heading at its start minus the present one, as turtlesim defines it."""
    return {"delta": wrap_angle(turtle.begin - turtle.theta)}


def _inside(coordinate: float) -> float:
    return min(max(coordinate, 0.0), _SIZE)


def _pixel(x: float, y: float) -> tuple[int, int]:
    """Return column and row of a place; row 0 is at the top."""
    return round(x * _SCALE), round((_SIZE - y) * _SCALE)
