"""Requests of the pages. Each one acts between two steps, like a call of the same service by a script."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from types import MappingProxyType
from typing import TYPE_CHECKING, Final, Protocol, TypeVar

import numpy as np

from simkit import Pose, msgs
from simkit.bridges.live.request_fields import RequestRefused, checked_value, find_handler, read_field
from simkit.bridges.live.requests import make_steps, set_pace, set_parameter
from simkit.compiler.standing_models import TOLERANCE, standing_lift
from simkit.extend import counted
from simkit.msgs import absolute_name
from simkit_view.displays.interactive_marker_display import InteractiveMarkerDisplay
from simkit_view.view.camera_pointing import point_camera
from simkit_view.view.message_form import describe_form
from simkit_view.view.page_calls import shown_message
from simkit_view.view.topic_display import TopicDisplay
from simkit_view.view.topic_streams import LogEntries
from simkit_view.web.cdr_values import read_values
from simkit_view.web.json_messages import message_from_json

if TYPE_CHECKING:
    from simkit import Simulation
    from simkit.bridges.teleop import Teleop
    from simkit.recording.travel import Travel
    from simkit_view.view.driving import Driving
    from simkit_view.view.marker_feedback import MarkerFeedback
    from simkit_view.view.packet import Stream
    from simkit_view.view.page_calls import PageCalls
    from simkit_view.view.page_server import PageRequest

T = TypeVar("T")
_MOST_TRAVEL: Final = 40_000  # points of all paths in one answer
_PARTS: Final = {"service": "Request", "action": "Goal"}
_LARGEST_VALUES: Final = 200_000  # characters of a response that a page gets as values


class ViewHost(Protocol):
    """Protocol of the live view that executes requests.

    Attributes:
        travel: paths that the models have driven.
        driving: robots that the pages drive.
        calls: calls of services and goals of actions that pages have sent.
        marker_feedback: feedback of pages to servers of interactive markers.
        is_held: True after a page has requested a pause, until a page resumes.
    """

    sim: Simulation
    travel: Travel
    driving: Driving
    calls: PageCalls
    marker_feedback: MarkerFeedback
    is_held: bool

    def stream(self, name: str) -> Stream | None:
        """Return an open stream; None if no page shows it."""
        ...


class Call:
    """Request with its arguments, each of which is validated when it is read.

    Attributes:
        view: live view with the simulation.
        client: page that has sent the request.
        args: arguments by name.
    """

    def __init__(self, view: ViewHost, request: PageRequest) -> None:
        self.view, self.sim, self.client = view, view.sim, request.client
        self.args = request.content

    def arg(self, name: str, kind: type[T]) -> T:
        """Return an argument of a kind; see `read_field`."""
        return read_field(self.args, name, kind)

    def text(self, name: str) -> str:
        """Return an argument that is a text."""
        return self.arg(name, str)

    def number(self, name: str, default: float | None = None) -> float:
        """Return an argument that is a finite number."""
        if default is None:
            return self.arg(name, float)
        return checked_value(self.args.get(name, default), f"{name!r}", float)

    def numbers(self, name: str, count: int) -> list[float]:
        """Return an argument that is a list of finite numbers."""
        values = self.arg(name, list)
        if len(values) != count:
            raise RequestRefused(f"{name!r} must be a list of {counted(count, 'finite number')}, got {len(values)}")
        return [checked_value(value, f"{name}[{number}]", float) for number, value in enumerate(values)]

    def value(self, name: str) -> object:
        """Return an argument of any kind; None if it is missing."""
        return self.args.get(name)


def execute_request(view: ViewHost, request: PageRequest) -> object:
    """Execute a request and return its answer.

    Raises:
        RequestRefused: the request is unknown, or an argument is invalid.
    """
    return find_handler(REQUESTS, request.content["do"])(Call(view, request))


def _pause(call: Call) -> None:
    call.sim.paused = call.view.is_held = call.arg("value", bool)


def _reset(call: Call) -> None:
    was_paused = call.sim.paused
    call.sim.reset()
    call.sim.paused = was_paused  # the state at t = 0 runs


def _travel(call: Call) -> object:
    """Return the path of each model [m]; of many models, fewer points each."""
    travel = call.view.travel
    most = max(_MOST_TRAVEL // max(len(travel.tracks), 1), 2)
    return {name: path.round(4).tolist() for name, path in travel.paths(most).items()}


def _drive(call: Call) -> object:
    """Request speeds: `ahead` and `left` [m/s], `turn` [rad/s]."""
    driver = _driver(call)
    driver.drive(call.number("ahead", 0.0), call.number("left", 0.0), call.number("turn", 0.0))
    return driver.speeds


def _key(call: Call) -> object:
    """Process a key as `--teleop` does."""
    driver = _driver(call)
    driver.press(call.text("key"))
    return driver.speeds


def _driver(call: Call) -> Teleop:
    topic = call.text("topic")
    teleop = call.view.driving.teleop(topic, call.client)
    if teleop is None:
        raise RequestRefused(f"{topic!r:.80} is no topic for velocities")
    return teleop


def _pose(call: Call) -> object:
    """Publish a goal or an initial pose: `kind` (goal, initial), `x`, `y` [m], `yaw` [rad], optionally `topic`."""
    kind = call.text("kind")
    if kind not in ("goal", "initial"):
        raise RequestRefused(f"'kind' must be goal or initial, got {kind!r:.80}")
    topic = call.text("topic") if call.value("topic") is not None else ""
    place = call.number("x"), call.number("y"), call.number("yaw", 0.0)
    return call.view.driving.send_pose(kind, *place, topic)


def _joint(call: Call) -> None:
    """Set the position of a joint with one axis [rad or m]; it has no velocity afterwards."""
    joint = call.sim.joint(call.text("name"))
    value = call.number("value")
    if joint.dof != 1:
        raise RequestRefused(f"joint {joint.name!r} has {joint.dof} axes; a slider moves one")
    if joint.lower <= joint.upper:
        value = min(max(value, float(joint.lower)), float(joint.upper))
    joint.set_position(value)
    joint.set_velocity(0.0)


def _spawn(call: Call) -> object:
    """Spawn a model by name, file or XML: `source`, `name`, `x`, `y`, `z` [m], `yaw` [rad].

    Without `z`, the model stands on what is below it; without `x`, it has the pose of its file.
    """
    name = call.text("name") if call.value("name") else None
    source, pose = call.sim.control.client_source(call.text("source")), None
    if call.value("x") is not None:
        x, y, yaw = call.number("x"), call.number("y"), call.number("yaw", 0.0)
        if call.value("z") is None:
            return _spawn_standing(call.sim, source, name, x, y, yaw)
        pose = Pose.from_rpy(x, y, call.number("z"), 0.0, 0.0, yaw)
    return call.sim.spawn(source, name, pose).name


def _model_pose(call: Call) -> object:
    """Return the pose of a model: position [m] and quaternion (w, x, y, z)."""
    return call.sim.model(call.text("name")).pose.as_list()


def _move(call: Call) -> None:
    """Move a model to `position` [m] and `quaternion` (w, x, y, z)."""
    model = call.sim.model(call.text("name"))
    position, quaternion = call.numbers("position", 3), call.numbers("quaternion", 4)
    if not _set_pose(call.sim, model.scoped, position, quaternion):
        raise RequestRefused(f"{model.scoped!r} cannot be moved")


def _spawn_standing(sim: Simulation, source: str, name: str | None, x: float, y: float, yaw: float) -> str:
    """Spawn a model that stands on what is below it, and return its name; roll and pitch are those of its file.

    Raises:
        LoadError: the source has errors, or the name is already used.
    """
    pose_in_file = sim.contents.pose_in_file(source)
    roll, pitch, _ = (float(angle) for angle in pose_in_file.rpy)
    pose = Pose.from_rpy(x, y, float(pose_in_file.position[2]), roll, pitch, yaw)
    model = sim.spawn(source, name, pose)
    lift = None if model.static else _lift(sim, model.scoped)
    if lift is not None and abs(lift) > TOLERANCE:
        _set_pose(sim, model.scoped, [x, y, float(pose.position[2]) + lift], pose.quaternion.tolist())
    return model.name


def _set_pose(sim: Simulation, name: str, position: Sequence[float], quaternion: Sequence[float]) -> bool:
    """Move a model by the world's service; return False if the service refuses."""
    pose = {
        "position": dict(zip("xyz", position, strict=True)),
        "orientation": dict(zip("wxyz", quaternion, strict=True)),
    }
    answer = sim.call(f"/world/{sim.world.name}/set_pose", {"entity": {"name": name}, "pose": pose})
    return bool(answer.success)


def _lift(sim: Simulation, name: str) -> float | None:
    """Return the distance from the pose of a model to the pose on what is below it [m]; None if nothing is there."""
    of_link = np.zeros(sim.mj_model.ngeom, dtype=bool)
    for link in sim.engine.names.links.values():
        if link.model == name:
            of_link[[*link.geoms, *link.ray_geoms]] = True
    return standing_lift(sim.mj_model, sim.mj_data, of_link)


def _interfaces(call: Call) -> object:
    """Return the types of all services and actions."""
    communication = call.sim.communication
    return {"services": communication.services.names(), "actions": communication.actions.names()}


def _describe(call: Call) -> object:
    """Return the form of a service (`kind` service) or an action (`kind` action): `kind`, `name`."""
    kind, name = call.text("kind"), absolute_name(call.text("name"))
    if kind not in _PARTS:
        raise RequestRefused(f"'kind' must be service or action, got {kind!r:.80}")
    communication = call.sim.communication
    endpoint = communication.services.get(name) if kind == "service" else communication.actions.get(name)
    return describe_form(f"{endpoint.type_name}_{_PARTS[kind]}")


def _call(call: Call) -> object:
    """Call a service: `name`, `values`. A service of another process answers later, in the stream `calls`."""
    services = call.sim.communication.services
    service = services.get(absolute_name(call.text("name")))
    request = message_from_json(f"{service.type_name}_Request", call.value("values") or {})
    if service.remote is not None:
        _check_room(call)
        return {"id": call.view.calls.add(services.begin(service.name, request))}
    response = call.sim.call(service.name, request)
    values = read_values(msgs.serialize(response), msgs.type_name(response))
    return {"text": shown_message(response), "values": values if len(str(values)) <= _LARGEST_VALUES else None}


def _goal(call: Call) -> object:
    """Send a goal to an action: `name`, `values`; its progress is in the stream `calls`."""
    action = call.sim.communication.actions.get(absolute_name(call.text("name")))
    goal = message_from_json(f"{action.type_name}_Goal", call.value("values") or {})
    _check_room(call)
    return {"id": call.view.calls.add(call.sim.send_goal(action.name, goal))}


def _look(call: Call) -> object:
    """Turn the head with a `camera` to a place in its picture: `x` from the left, `y` from the top, 0 to 1."""
    _check_room(call)
    goal = point_camera(call.sim, call.text("camera"), call.number("x"), call.number("y"))
    return {"id": call.view.calls.add(goal), "action": goal.action.name}


def _marker(call: Call) -> object:
    """Publish an event of an interactive marker: `topic` of its updates, `name`, `event`, `pose`, optionally `entry`.

    The pose has position [m] and quaternion (w, x, y, z) in the world.
    """
    topic = call.text("topic")
    stream = call.view.stream(f"display:{topic}")
    display = stream.display if isinstance(stream, TopicDisplay) else None
    if not isinstance(display, InteractiveMarkerDisplay):
        raise RequestRefused(f"the page does not show interactive markers of {topic!r:.80}")
    numbers = call.numbers("pose", 7)
    pose = Pose(numbers[:3], numbers[3:])
    feedback = call.view.marker_feedback
    return feedback.send(display, call.text("name"), call.text("event"), pose, int(call.number("entry", 0.0)))


def _check_room(call: Call) -> None:
    if call.view.calls.is_full:
        raise RequestRefused("too many goals and calls wait; cancel some of them")


def _cancel(call: Call) -> object:
    """Request the cancellation of a goal: `goal`, its number."""
    number = call.number("goal")
    goal = call.view.calls.goal(int(number))
    if goal is None:
        raise RequestRefused(f"there is no goal {number:g}")
    if goal.is_done:
        return False
    goal.cancel()
    return True


def _log(call: Call) -> object:
    """Return the log messages after the number `after`, while the page shows the stream `log`."""
    after, stream = call.number("after", 0), call.view.stream("log")
    return stream.entries(int(after)) if isinstance(stream, LogEntries) else []


REQUESTS: Final[Mapping[str, Callable[[Call], object]]] = MappingProxyType(
    {
        "left": lambda call: call.view.driving.release(call.client),
        "pause": _pause,
        "step": lambda call: make_steps(call.sim, call.args.get("count", 1)),
        "pace": lambda call: set_pace(call.sim, call.args.get("value")),
        "reset": _reset,
        "travel": _travel,
        "targets": lambda call: call.view.driving.targets(),
        "drive": _drive,
        "key": _key,
        "pose": _pose,
        "joint": _joint,
        "spawnable": lambda call: {} if call.sim.control.list_models is None else call.sim.control.list_models(),
        "spawn": _spawn,
        "model_pose": _model_pose,
        "move": _move,
        "remove": lambda call: call.sim.remove(call.text("name")),
        "interfaces": _interfaces,
        "describe": _describe,
        "call": _call,
        "goal": _goal,
        "look": _look,
        "marker": _marker,
        "cancel": _cancel,
        "set_parameter": set_parameter,
        "log": _log,
    }
)
"""Function of each request, by the name in `do`."""
