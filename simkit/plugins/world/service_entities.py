"""Helpers of the world's services: find entities named in messages, convert poses, format refusals."""

from __future__ import annotations

import hashlib
import math
import re
from collections.abc import Callable, Iterable, Sequence
from html import escape
from typing import TYPE_CHECKING, Any, Final, TypeVar

import numpy as np

from simkit.diagnostics import did_you_mean
from simkit.errors import InputError, PluginError
from simkit.pose import IDENTITY, Pose, Vector

if TYPE_CHECKING:
    from simkit import msgs
    from simkit.runtime import Link, Simulation

T = TypeVar("T")

KINDS: Final = ("none", "light", "model", "link", "visual", "collision", "sensor", "joint")
"""Kinds of entities, indexed by their number in `ros_gz_interfaces/msg/Entity`."""

_WORLD: Final = ("", "world", "map", "/map")
# XML has no `<` in a tag. The patterns use this, so that their time does not grow with the square of the length.
_TAG: Final = r"(<plugin\b(?:[^<>\"']|\"[^<\"]*\"|'[^<']*')*?)"
_PLUGIN: Final = re.compile(_TAG + r"(/>|>(.*?)</plugin\s*>)", re.DOTALL)
_EMPTY_PLUGIN: Final = re.compile(_TAG + r"(/>)()")
_PLUGIN_END: Final = re.compile(r"</plugin\s*>")
_NAMESPACE: Final = re.compile(r"<namespace\s*>[^<]*</namespace\s*>|<namespace\s*/>")
_ROBOT_NAMESPACE: Final = re.compile(r"<robotNamespace\s*(?:/>|>[^<]*</robotNamespace\s*>)")


class RequestRefused(Exception):
    """Error for a request that a service cannot fulfil; its text is the reason."""


def answer_handler(
    sim: Simulation,
    name: str,
    execute: Callable[[msgs.Message], dict[str, object] | str | None],
    has_status: bool = True,
) -> Callable[[object], dict[str, object]]:
    """Return a service handler that answers `success`, or the reason for a failure.

    Args:
        sim: simulation.
        name: name of the service, for the log.
        execute: function of the request that returns the fields of the response, a status message, or None.
        has_status: True if the response has a field `status_message`. The reason of a failure is always logged.
    """

    def handle(request: object) -> dict[str, object]:
        from simkit.runtime.handles.handle import UnknownName

        try:
            outcome = execute(request)
        except (RequestRefused, InputError, UnknownName) as error:
            why = str(error)
            sim.engine.log.warning("%s: %s", name, why)
            return {"success": False, "status_message": why} if has_status else {"success": False}
        fields = outcome if isinstance(outcome, dict) else {}
        if isinstance(outcome, str) and outcome:
            if has_status:
                fields = {"status_message": outcome}
            else:
                sim.engine.log.warning("%s: %s", name, outcome)
        return {"success": True, **fields}

    return handle


def command_handler(
    sim: Simulation, name: str, execute: Callable[[msgs.Message], str | None]
) -> Callable[[object], None]:
    """Return a handler for a command without a response, such as a topic; a failure is logged."""
    answer = answer_handler(sim, name, execute, has_status=False)

    def handle(message: object) -> None:
        answer(message)

    return handle


def spawn_entities(spawn: Callable[..., T], *arguments: object) -> T:
    """Call `sim.spawn`, `sim.contents.spawn_all` or `sim.contents.clone`, and return the result.

    Raises:
        RequestRefused: a plugin of the model raised in its `load`; the world is unchanged.
    """
    try:
        return spawn(*arguments)
    except PluginError as error:
        raise RequestRefused(str(error)) from error


def add_namespace(xml: str, namespace: str) -> str:
    """Add a namespace to each plugin of a description, as Classic does for `robot_namespace`; also for ROS 1."""
    namespace = escape(namespace, quote=False)
    element = f"<namespace>{namespace}</namespace>"

    def named(match: re.Match[str]) -> str:
        content = match[3] or ""
        if re.search(r"<ros\s*>", content):
            if _NAMESPACE.search(content):
                content = _NAMESPACE.sub(lambda _: element, content, count=1)
            else:
                content = re.sub(r"<ros\s*>", lambda m: m[0] + element, content, count=1)
        elif "<robotNamespace" in content:
            element_of_ros_1 = f"<robotNamespace>{namespace}</robotNamespace>"
            content = _ROBOT_NAMESPACE.sub(lambda _: element_of_ros_1, content)
        else:
            content = f"<ros>{element}</ros>{content}"
        return f"{match[1]}>{content}</plugin>"

    end = max((match.end() for match in _PLUGIN_END.finditer(xml)), default=0)
    return _PLUGIN.sub(named, xml[:end]) + _EMPTY_PLUGIN.sub(named, xml[end:])


# ---------------------------------------------------------------------- entities


def scoped_names(sim: Simulation, kind: str) -> Iterable[str]:
    """Return the scoped names of all entities of a kind (one of `KINDS`), in document order."""
    if kind == "visual":
        return sim.contents.handles.visuals()
    if kind == "collision":
        links = sim.contents.handles.tables["link"].values()
        return [collision.scoped for link in links for collision in link.scene.collisions]
    return sim.contents.handles.tables.get(kind, {})


def entity_id(kind: str, scoped: str) -> int:
    """Return the id of an entity in messages; the id is the same in every run."""
    return int.from_bytes(hashlib.blake2b(f"{kind} {scoped}".encode(), digest_size=8).digest(), "big") >> 1


def find_entity(sim: Simulation, name: str, kinds: Sequence[str], what: str = "") -> tuple[str, str]:
    """Return kind and scoped name of the entity that a name refers to.

    The search compares scoped names first; the name may begin with the world's name. Then the search compares plain
    names and returns the first match in document order. Both searches go through `kinds` in order.

    Raises:
        RequestRefused: no entity has this name; the text suggests the closest name.
    """
    scoped_name = name.removeprefix(f"{sim.world.name}::")
    for kind in kinds:
        if scoped_name in scoped_names(sim, kind):
            return kind, scoped_name
    for kind in kinds:
        for scoped in scoped_names(sim, kind):
            if scoped.endswith(f"::{scoped_name}"):
                return kind, scoped
    there = [scoped for kind in kinds for scoped in scoped_names(sim, kind)]
    what = what or " or ".join(kinds)
    near = did_you_mean(scoped_name, list(dict.fromkeys([*there, *(scoped.rpartition("::")[2] for scoped in there)])))
    listed = ", ".join(there[:10]) + (", …" if len(there) > 10 else "")
    raise RequestRefused(f"there is no {what} {name!r}; {near or 'there is ' + (listed or 'none')}")


def entity_of(sim: Simulation, message: msgs.Entity, kinds: Sequence[str]) -> tuple[str, str]:
    """Return kind and scoped name of the entity in an `Entity` message, by its name, or else by its id.

    Raises:
        RequestRefused: the entity does not exist, or the service does not support its kind.
    """
    number = int(message.type)
    kind = KINDS[number] if 0 <= number < len(KINDS) else "none"
    if kind != "none" and kind not in kinds:
        raise RequestRefused(f"found an entity of type {kind}; expected {' or '.join(kinds)}")
    allowed_kinds = (kind,) if kind != "none" else tuple(kinds)
    if message.name:
        return find_entity(sim, message.name, allowed_kinds)
    if not message.id:
        raise RequestRefused("the entity has neither a name nor an id")
    for candidate in allowed_kinds:
        for scoped in scoped_names(sim, candidate):
            if entity_id(candidate, scoped) == int(message.id):
                return candidate, scoped
    described = " or ".join(allowed_kinds)
    raise RequestRefused(f"there is no {described} with the id {int(message.id)}; scene/info lists the ids")


def frame_of(sim: Simulation, name: str) -> Pose:
    """Return the pose of a reference frame in the world; the frame is the world itself or an entity.

    Raises:
        RequestRefused: the entity does not exist; the text suggests the closest name.
    """
    if name in _WORLD or name == sim.world.name:
        return IDENTITY
    pose: Pose = handle_of(sim, *find_entity(sim, name, ("model", "link", "light", "visual"), "reference frame")).pose
    return pose


def handle_of(sim: Simulation, kind: str, scoped: str) -> Any:
    """Return the handle of an entity."""
    return sim.visual(scoped) if kind == "visual" else sim.contents.handles.find(kind, scoped)


def carrying_link(sim: Simulation, kind: str, scoped: str) -> Link | None:
    """Return the link to which an entity is fixed; for a model this is its canonical link."""
    if kind == "link":
        return sim.link(scoped)
    if kind == "visual":
        return sim.visual(scoped).link
    links = sim.contents.handles.tables["link"]
    if kind == "model":
        return links.get(sim.model(scoped).scene.canonical_link)
    return links.get(sim.light(scoped).scene.link)


def velocity_of(sim: Simulation, kind: str, scoped: str) -> tuple[Vector, Vector]:
    """Return linear velocity of an entity's origin [m/s] and angular velocity [rad/s], world frame, shape (3,)."""
    link = carrying_link(sim, kind, scoped)
    if link is None:
        return np.zeros(3), np.zeros(3)
    angular = link.angular_velocity
    arm = handle_of(sim, kind, scoped).pose.position - link.pose.position
    return link.linear_velocity + np.cross(angular, arm), angular


def twist_fields(linear: Vector, angular: Vector) -> dict[str, object]:
    """Return the fields of a `Twist` message."""
    return {"linear": vector_fields(linear.tolist()), "angular": vector_fields(angular.tolist())}


# ---------------------------------------------------------------------- numbers


def require_finite(value: float, what: str, minimum: float | None = None) -> float:
    """Return a number of a message, after a check that it is finite and at least `minimum`.

    Raises:
        RequestRefused: the value is NaN, infinite or below `minimum`.
    """
    number = float(value)
    if not math.isfinite(number) or (minimum is not None and number < minimum):
        allowed = "a finite number" + (f" of at least {minimum:g}" if minimum is not None else "")
        raise RequestRefused(f"found {what} {value!r}; expected {allowed}")
    return number


def vector_of(message: msgs.Vector3 | msgs.Point, what: str) -> tuple[float, float, float]:
    """Return the numbers of a Vector3 or a Point message; raises `RequestRefused`."""
    x, y, z = (require_finite(getattr(message, axis), f"{what}.{axis}") for axis in "xyz")
    return x, y, z


def pose_of(message: msgs.Pose, what: str = "pose") -> Pose:
    """Return the pose of a `Pose` message; its quaternion is normalised, and four zeros mean the identity.

    Raises:
        RequestRefused: a number is NaN or infinite.
    """
    q = [require_finite(getattr(message.orientation, axis), f"{what}.orientation.{axis}") for axis in "wxyz"]
    # scaled first, because squares of huge numbers overflow, and squares of tiny numbers are zero
    most = max(map(abs, q)) or 1.0
    q = [part / most for part in q]
    size = math.hypot(*q)
    quaternion = [part / size for part in q] if size > 0.0 else [1.0, 0.0, 0.0, 0.0]
    return Pose(vector_of(message.position, f"{what}.position"), quaternion)


def pose_fields(pose: Pose) -> dict[str, object]:
    """Return the fields of a `Pose` message."""
    x, y, z = pose.position.tolist()
    qw, qx, qy, qz = pose.quaternion.tolist()
    return {"position": {"x": x, "y": y, "z": z}, "orientation": {"x": qx, "y": qy, "z": qz, "w": qw}}


def vector_fields(vector: Sequence[float] | Vector) -> dict[str, float]:
    """Return the fields of a Vector3 or a Point message."""
    x, y, z = (float(part) for part in vector)
    return {"x": x, "y": y, "z": z}


def colour_of(message: msgs.ColorRGBA, what: str) -> tuple[float, float, float, float] | None:
    """Return a colour RGBA from 0 to 1; None if all four are zero ("unchanged"). Raises `RequestRefused`."""
    r, g, b, a = (require_finite(getattr(message, part), f"{what}.{part}", 0.0) for part in "rgba")
    return None if r == g == b == a == 0.0 else (r, g, b, a)
