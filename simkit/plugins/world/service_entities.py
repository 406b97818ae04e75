"""What the services of a world have in common: entities by their messages, poses, answers that say what is wrong."""

from __future__ import annotations

import hashlib
import math
from collections.abc import Callable, Iterable, Sequence
from typing import TYPE_CHECKING, Any, Final, TypeVar

from simkit.diagnostics import did_you_mean
from simkit.errors import InputError, PluginError
from simkit.pose import IDENTITY, Pose, Vector

if TYPE_CHECKING:
    from simkit import msgs
    from simkit.runtime import Simulation

T = TypeVar("T")

KINDS: Final = ("none", "light", "model", "link", "visual", "collision", "sensor", "joint")
"""Kinds of entities at their numbers in `ros_gz_interfaces/msg/Entity`."""

_WORLD: Final = ("", "world", "map", "/map")


class RequestRefused(Exception):
    """What was asked for cannot be done; the text says why."""


def answer_handler(
    sim: Simulation, name: str, does: Callable[[Any], dict[str, object] | str | None], says_why: bool = True
) -> Callable[[object], dict[str, object]]:
    """A handler that answers `success` and says why not, where something cannot be done.

    Args:
        sim: the simulation.
        name: of the service, for the log.
        does: does it; gives the fields of the response, or a status message, or None.
        says_why: whether the response has a `status_message`; without one it is logged, as Gazebo does.
    """

    def handle(request: object) -> dict[str, object]:
        from simkit.runtime.handles.handle import UnknownName

        try:
            found = does(request)
        except (RequestRefused, InputError, UnknownName) as error:
            why = str(error)
            sim.engine.log.warning("%s: %s", name, why)
            return {"success": False, "status_message": why} if says_why else {"success": False}
        fields = found if isinstance(found, dict) else {}
        if isinstance(found, str) and found:
            if says_why:
                fields = {"status_message": found}
            else:
                sim.engine.log.warning("%s: %s", name, found)
        return {"success": True, **fields}

    return handle


def command_handler(sim: Simulation, name: str, does: Callable[[Any], str | None]) -> Callable[[object], None]:
    """The same for what has no answer, a command by topic or an empty response: what cannot be done is logged."""
    answer = answer_handler(sim, name, does, says_why=False)

    def handle(message: object) -> None:
        answer(message)

    return handle


def spawn_entities(make: Callable[..., T], *values: object) -> T:
    """What `sim.spawn`, `sim.contents.spawn_all` or `sim.contents.clone` adds.

    Raises:
        Refused: a plugin of the model raised when it was loaded; the world is as before.
    """
    try:
        return make(*values)
    except PluginError as error:
        raise RequestRefused(str(error)) from error


# ---------------------------------------------------------------------- entities


def scoped_names(sim: Simulation, kind: str) -> Iterable[str]:
    """Scoped names of all entities of a kind (one of `KINDS`), in document order."""
    if kind == "visual":
        return sim.contents.handles.visuals()
    if kind == "collision":
        links = sim.contents.handles.tables["link"].values()
        return [collision.scoped for link in links for collision in link.scene.collisions]
    return sim.contents.handles.tables.get(kind, {})


def entity_id(kind: str, scoped: str) -> int:
    """The number by which an entity goes in messages; the same in every run."""
    return int.from_bytes(hashlib.blake2b(f"{kind} {scoped}".encode(), digest_size=8).digest(), "big") >> 1


def find_entity(sim: Simulation, name: str, kinds: Sequence[str], what: str = "") -> tuple[str, str]:
    """Kind and scoped name of the entity that a name means.

    It is looked for as a scoped name, with or without the world's before it, then as a plain name, the first in
    document order, in each kind in turn.

    Raises:
        Refused: there is none; names the closest.
    """
    own = name.removeprefix(f"{sim.world.name}::")
    for kind in kinds:
        if own in scoped_names(sim, kind):
            return kind, own
    for kind in kinds:
        for scoped in scoped_names(sim, kind):
            if scoped.endswith(f"::{own}"):
                return kind, scoped
    there = [scoped for kind in kinds for scoped in scoped_names(sim, kind)]
    what = what or " or ".join(kinds)
    near = did_you_mean(own, list(dict.fromkeys([*there, *(scoped.rpartition("::")[2] for scoped in there)])))
    listed = ", ".join(there[:10]) + (", …" if len(there) > 10 else "")
    raise RequestRefused(f"there is no {what} {name!r}; {near or 'there is ' + (listed or 'none')}")


def entity_of(sim: Simulation, message: msgs.Entity, kinds: Sequence[str]) -> tuple[str, str]:
    """Kind and scoped name of what an `Entity` message means, by its name, or else by its id.

    Raises:
        Refused: there is none, or it is of a kind that the service is not for.
    """
    number = int(message.type)
    kind = KINDS[number] if 0 <= number < len(KINDS) else "none"
    if kind != "none" and kind not in kinds:
        raise RequestRefused(f"found an entity of type {kind}, allowed is {' or '.join(kinds)}")
    wanted = (kind,) if kind != "none" else tuple(kinds)
    if message.name:
        return find_entity(sim, message.name, wanted)
    if not message.id:
        raise RequestRefused("the entity has neither a name nor an id")
    for one in wanted:
        for scoped in scoped_names(sim, one):
            if entity_id(one, scoped) == int(message.id):
                return one, scoped
    raise RequestRefused(f"there is no {' or '.join(wanted)} with the id {int(message.id)}; scene/info lists them")


def frame_of(sim: Simulation, name: str) -> Pose:
    """The pose of a reference frame in the world: of the world itself, or of an entity.

    Raises:
        Refused: there is no such entity; names the closest.
    """
    if name in _WORLD or name == sim.world.name:
        return IDENTITY
    found: Pose = handle_of(sim, *find_entity(sim, name, ("model", "link", "light", "visual"), "reference frame")).pose
    return found


def handle_of(sim: Simulation, kind: str, scoped: str) -> Any:
    """The handle of an entity that has one."""
    return sim.visual(scoped) if kind == "visual" else sim.contents.handles.find(kind, scoped)


# ---------------------------------------------------------------------- numbers


def require_finite(value: float, what: str, minimum: float | None = None) -> float:
    """A number that can be used.

    Raises:
        Refused: it is none.
    """
    number = float(value)
    if not math.isfinite(number) or (minimum is not None and number < minimum):
        allowed = "a finite number" + (f" of at least {minimum:g}" if minimum is not None else "")
        raise RequestRefused(f"found {what} {value!r}, allowed is {allowed}")
    return number


def vector_of(message: msgs.Vector3 | msgs.Point, what: str) -> tuple[float, float, float]:
    """The numbers of a Vector3 or a Point message; raises Refused."""
    x, y, z = (require_finite(getattr(message, axis), f"{what}.{axis}") for axis in "xyz")
    return x, y, z


def pose_of(message: msgs.Pose, what: str = "pose") -> Pose:
    """The pose of a `Pose` message; a rotation of only zeros is none, any other is brought to unit length.

    Raises:
        Refused: it has numbers that are none.
    """
    q = [require_finite(getattr(message.orientation, axis), f"{what}.orientation.{axis}") for axis in "wxyz"]
    most = max(map(abs, q)) or 1.0  # divided by that first: the squares of numbers that are huge or tiny are none
    q = [part / most for part in q]
    size = math.hypot(*q)
    quaternion = [part / size for part in q] if size > 0.0 else [1.0, 0.0, 0.0, 0.0]
    return Pose(vector_of(message.position, f"{what}.position"), quaternion)


def pose_fields(pose: Pose) -> dict[str, object]:
    """The fields of a `Pose` message."""
    x, y, z = pose.position.tolist()
    qw, qx, qy, qz = pose.quaternion.tolist()
    return {"position": {"x": x, "y": y, "z": z}, "orientation": {"x": qx, "y": qy, "z": qz, "w": qw}}


def vector_fields(vector: Sequence[float] | Vector) -> dict[str, float]:
    """The fields of a Vector3 or a Point message."""
    x, y, z = (float(part) for part in vector)
    return {"x": x, "y": y, "z": z}


def colour_of(message: msgs.ColorRGBA, what: str) -> tuple[float, float, float, float] | None:
    """A colour RGBA from 0 to 1; None where all four are zero, which says nothing. Raises Refused."""
    r, g, b, a = (require_finite(getattr(message, part), f"{what}.{part}", 0.0) for part in "rgba")
    return None if r == g == b == a == 0.0 else (r, g, b, a)
