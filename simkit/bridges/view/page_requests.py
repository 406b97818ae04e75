"""Requests of the pages. Each one acts between two steps, like a call of the same service by a script."""

from __future__ import annotations

from collections.abc import Callable
from typing import TYPE_CHECKING, Final

from simkit.bridges.live.request_fields import RequestRefused
from simkit.bridges.view.model_requests import set_pose, spawn_standing, spawnable
from simkit.bridges.view.page_call import Call, ViewHost
from simkit.bridges.view.panel_requests import PANEL_REQUESTS
from simkit.pose import Pose

if TYPE_CHECKING:
    from simkit.bridges.teleop import Teleop
    from simkit.bridges.view.page_server import PageRequest

_MOST_TRAVEL: Final = 40_000  # points of all paths in one answer


def execute_request(view: ViewHost, request: PageRequest) -> object:
    """Execute a request and return its answer.

    Raises:
        RequestRefused: the request is unknown, or an argument is invalid.
    """
    name = request.content["do"]
    if name not in REQUESTS:
        raise RequestRefused(f"unknown request {name!r:.80}; known: {', '.join(REQUESTS)}")
    return REQUESTS[name](Call(view, request))


def _pause(call: Call) -> None:
    call.sim.paused = call.view.is_held = call.flag("value")


def _step(call: Call) -> None:
    count = call.number("count", 1)
    if not (count.is_integer() and 1 <= count <= 1 << 31):
        raise RequestRefused(f"'count' must be a whole number of steps of at least 1, got {count:g}")
    call.sim.control.pausing.step(int(count))


def _pace(call: Call) -> None:
    value = call.value("value")
    pace = None if value is None else call.number("value")
    if pace is not None and not pace > 0:
        raise RequestRefused(f"'value' must be above 0, or null for no limit, got {value!r:.80}")
    call.sim.control.pausing.pace = pace


def _reset(call: Call) -> None:
    was_paused = call.sim.paused
    call.sim.reset()
    call.sim.paused = was_paused  # the state at t = 0 runs


def _travel(call: Call) -> object:
    """Return the path of each model [m]; of many models, fewer points each."""
    travel = call.view.travel
    most = max(_MOST_TRAVEL // max(len(travel.tracks), 1), 2)
    return {name: path.round(4).tolist() for name, path in travel.paths(most).items()}


def _targets(call: Call) -> object:
    return call.view.driving.targets()


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
    found = call.view.driving.teleop(topic, call.client)
    if found is None:
        raise RequestRefused(f"{topic!r:.80} is no topic for velocities")
    return found


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
    source, pose = call.text("source"), None
    if call.value("x") is not None:
        x, y, yaw = call.number("x"), call.number("y"), call.number("yaw", 0.0)
        if call.value("z") is None:
            return spawn_standing(call.sim, source, name, x, y, yaw)
        pose = Pose.from_rpy(x, y, call.number("z"), 0.0, 0.0, yaw)
    return call.sim.spawn(source, name, pose).name


def _model_pose(call: Call) -> object:
    """Return the pose of a model: position [m] and quaternion (w, x, y, z)."""
    return call.sim.model(call.text("name")).pose.as_list()


def _move(call: Call) -> None:
    """Move a model to `position` [m] and `quaternion` (w, x, y, z)."""
    model = call.sim.model(call.text("name"))
    position, quaternion = call.numbers("position", 3), call.numbers("quaternion", 4)
    if not set_pose(call.sim, model.scoped, position, quaternion):
        raise RequestRefused(f"{model.scoped!r} cannot be moved")


def _remove(call: Call) -> None:
    call.sim.remove(call.text("name"))


REQUESTS: Final[dict[str, Callable[[Call], object]]] = {
    "left": lambda call: call.view.driving.release(call.client),
    "pause": _pause,
    "step": _step,
    "pace": _pace,
    "reset": _reset,
    "travel": _travel,
    "targets": _targets,
    "drive": _drive,
    "key": _key,
    "pose": _pose,
    "joint": _joint,
    "spawnable": lambda call: spawnable(call.sim),
    "spawn": _spawn,
    "model_pose": _model_pose,
    "move": _move,
    "remove": _remove,
    **PANEL_REQUESTS,
}
"""Function of each request, by the name in `do`."""
