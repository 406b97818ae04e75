"""Entities of ROS 2's `simulation_interfaces`: lists, states, categories and bounds of the models of a world."""

from __future__ import annotations

import enum
import itertools
import math
import re
from collections.abc import Callable
from typing import TYPE_CHECKING, Final

import numpy as np

from simkit import msgs
from simkit.linear_algebra import matmul, norm
from simkit.number_text import counted
from simkit.plugins.world.service_entities import (
    RequestRefused,
    find_entity,
    frame_of,
    handle_of,
    pose_fields,
    pose_of,
    twist_fields,
    vector_fields,
    vector_of,
    velocity_of,
)
from simkit.pose import IDENTITY, Pose, Vector

if TYPE_CHECKING:
    from simkit.runtime import Simulation

PACKAGE: Final = "simulation_interfaces"
_KINDS: Final = ("model", "link", "light")
_ROBOT, _HUMAN, _DYNAMIC, _STATIC = 1, 2, 4, 5
_QUANTIFIERS: Final = re.compile(r"\\.|\[\^?\]?(?:\\.|[^]\\])*\]|\(\?|(\)?[*+?{])")
_MOST_QUANTIFIERS: Final = 3  # more of them, or one after a group, may take minutes in a name of 30 letters
_MOST_ALTERNATIVES: Final = 8  # each may double the time of a search
_LONGEST_FILTER: Final = 200
_EMPTY, _BOX, _HULL, _SPHERE = range(4)
_INVALID_POSE: Final = 101
_FARTHEST: Final = 1e10
"""Largest coordinate [m] of a position: beyond it, MuJoCo takes the state for diverged."""
_QUATERNION_TOLERANCE: Final = 0.01
"""Largest difference of a quaternion's squared length from 1, as in tf2."""


class ResultCode(enum.IntEnum):
    """Codes of `simulation_interfaces/msg/Result`."""

    UNSUPPORTED = 0
    OK = 1
    NOT_FOUND = 2
    INCORRECT_STATE = 3
    FAILED = 4


class Refusal(Exception):
    """Error for a request that is not fulfilled.

    Attributes:
        code: result code of the response.
    """

    def __init__(self, code: int, reason: str) -> None:
        super().__init__(reason)
        self.code = code


def result_fields(error: Exception) -> dict[str, object]:
    """Return the fields of a `Result` for an error."""
    code = error.code if isinstance(error, Refusal) else ResultCode.FAILED
    return {"result": int(code), "error_message": str(error)}


def find(sim: Simulation, name: str, kinds: tuple[str, ...] = _KINDS) -> tuple[str, str]:
    """Return kind and scoped name of an entity; raises `Refusal`."""
    try:
        return find_entity(sim, name, kinds, "entity")
    except RequestRefused as error:
        raise Refusal(ResultCode.NOT_FOUND, str(error)) from error


# ---------------------------------------------------------------------- states


def entity_state(
    sim: Simulation, request: msgs.simulation_interfaces__srv__GetEntityState_Request
) -> dict[str, object]:
    """Return pose and velocity of an entity in the world."""
    return {"state": _state_fields(sim, *find(sim, request.entity))}


def _state_fields(sim: Simulation, kind: str, scoped: str) -> dict[str, object]:
    linear, angular = velocity_of(sim, kind, scoped)
    pose = pose_fields(handle_of(sim, kind, scoped).pose)
    return {"header": msgs.header(sim.time_ns, "world"), "pose": pose, "twist": twist_fields(linear, angular)}


def set_entity_state(sim: Simulation, request: msgs.simulation_interfaces__srv__SetEntityState_Request) -> None:
    """Set pose, velocity or both of an entity, in the world or in the frame that the header names."""
    kind, scoped = find(sim, request.entity)
    if request.set_acceleration:
        raise Refusal(ResultCode.UNSUPPORTED, "an acceleration cannot be set; apply a wrench instead")
    state, handle = request.state, handle_of(sim, kind, scoped)
    pose = _state_pose(sim, state) if request.set_pose else None
    velocity = _state_velocity(sim, state) if request.set_twist else None
    if velocity is not None and (kind == "light" or (kind == "model" and handle.static)):
        if np.any(velocity):
            raise Refusal(ResultCode.FAILED, f"{scoped!r} is static, so it has no velocity")
        velocity = None
    if pose is not None:
        handle.set_pose(pose)
    if velocity is not None:
        handle.set_velocity(*velocity)


def _state_pose(sim: Simulation, state: msgs.simulation_interfaces__msg__EntityState) -> Pose:
    try:
        return requested_pose(sim, state.header, state.pose, "pose")
    except RequestRefused as error:
        raise Refusal(_INVALID_POSE, str(error)) from error


def _state_velocity(sim: Simulation, state: msgs.simulation_interfaces__msg__EntityState) -> tuple[Vector, Vector]:
    """Return linear [m/s] and angular velocity [rad/s] of a state, world frame."""
    frame, twist = frame_of(sim, state.header.frame_id), state.twist
    return frame.rotate(vector_of(twist.linear, "twist.linear")), frame.rotate(
        vector_of(twist.angular, "twist.angular")
    )


def requested_pose(sim: Simulation, header: msgs.Header, pose: msgs.Pose, what: str) -> Pose:
    """Return a pose of a request in the world frame; the header names its frame.

    Raises:
        RequestRefused: there is no such frame, a number is NaN, infinite or outside of the world, or the quaternion is
            not normalised.
    """
    frame, pose_in_frame = frame_of(sim, header.frame_id), pose_of(pose, what)
    length = math.hypot(*(float(getattr(pose.orientation, axis)) for axis in "xyzw"))
    if abs(length * length - 1.0) > _QUATERNION_TOLERANCE:
        raise RequestRefused(f"found {what}.orientation of length {length:.4g}; expected a quaternion of length 1")
    position = frame.transform(pose_in_frame.position)
    if not np.abs(position).max() <= _FARTHEST:
        farthest = max(map(abs, pose_in_frame.position.tolist()))
        raise RequestRefused(f"found {what}.position at {farthest:.4g} m; a world ends at {_FARTHEST:g} m")
    return frame @ pose_in_frame


# ---------------------------------------------------------------------- lists


def list_entities(sim: Simulation, request: msgs.GetEntities_Request) -> dict[str, object]:
    """Return the names of all models that the filters select."""
    return {"entities": _selected(sim, request.filters)}


def list_states(sim: Simulation, request: msgs.GetEntitiesStates_Request) -> dict[str, object]:
    """Return the names and states of all models that the filters select."""
    names = _selected(sim, request.filters)
    return {"entities": names, "states": [_state_fields(sim, "model", name) for name in names]}


def entity_info(sim: Simulation, request: msgs.GetEntityInfo_Request) -> dict[str, object]:
    """Return the category of a model."""
    _, scoped = find(sim, request.entity, ("model",))
    return {"info": {"category": {"category": _category(sim, scoped)}}}


def _selected(sim: Simulation, filters: msgs.EntityFilters) -> list[str]:
    if len(filters.tags.tags):
        raise Refusal(ResultCode.UNSUPPORTED, "entities have no tags")
    is_short = len(filters.filter) <= _LONGEST_FILTER and filters.filter.count("|") <= _MOST_ALTERNATIVES
    tokens = [token for token in _QUANTIFIERS.findall(filters.filter) if token] if is_short else []
    if not is_short or len(tokens) > _MOST_QUANTIFIERS or any(token.startswith(")") for token in tokens):
        allowed = (
            f"at most {_LONGEST_FILTER} characters, {_MOST_ALTERNATIVES} of | and "
            f"{_MOST_QUANTIFIERS} of * + ? {{}}, none of them after a group"
        )
        raise Refusal(ResultCode.FAILED, f"found the filter {filters.filter!r:.100}; expected {allowed}")
    try:
        pattern = re.compile(filters.filter)
    except re.error as error:
        raise Refusal(ResultCode.FAILED, f"{filters.filter!r} is not a regular expression: {error}") from error
    categories = {int(entry.category) for entry in filters.categories}
    reaches = _bounds_test(filters.bounds)
    names = [name for name in sim.contents.handles.tables["model"] if pattern.search(name)]
    return [
        name
        for name in names
        if (not categories or _category(sim, name) in categories) and (reaches is None or reaches(sim, name))
    ]


def _category(sim: Simulation, scoped: str) -> int:
    """Return the category of a model: human, static object, robot (it has plugins or sensors), or dynamic object."""
    if any(actor.name == scoped for actor in sim.world.actors):
        return _HUMAN
    scene = sim.model(scoped).scene
    if scene.static:
        return _STATIC
    models = list(scene.all_models())
    links = list(scene.all_links())
    has_parts = any(model.plugins for model in models) or any(link.plugins or link.sensors for link in links)
    return _ROBOT if has_parts else _DYNAMIC


# ---------------------------------------------------------------------- bounds


def entity_bounds(sim: Simulation, request: msgs.GetEntityBounds_Request) -> dict[str, object]:
    """Return the box around the collisions of a model or a link, along the axes of its own frame."""
    kind, scoped = find(sim, request.entity, ("model", "link"))
    corners = _corners(sim, kind, scoped, handle_of(sim, kind, scoped).pose)
    if corners is None:
        return {"bounds": {"type": _EMPTY}}
    if not np.isfinite(corners).all():
        raise Refusal(ResultCode.FAILED, f"{scoped!r} has a plane, which is infinite")
    return {"bounds": {"type": _BOX, "points": [vector_fields(corners[1]), vector_fields(corners[0])]}}


def _corners(sim: Simulation, kind: str, scoped: str, frame: Pose = IDENTITY) -> Vector | None:
    """Return the lower and the upper corner of the box around all collisions, shape (2, 3); None without collisions.

    Args:
        sim: simulation.
        kind: "model" or "link".
        scoped: name of the entity.
        frame: pose in the world of the frame of the corners.
    """
    engine = sim.engine
    model, data = engine.mj_model, engine.physics.fresh()
    links = [scoped] if kind == "link" else [link.scoped for link in sim.model(scoped).scene.all_links()]
    geoms = [geom for link in links for geom in engine.names.link(link).geoms]
    back, points = frame.inverse(), []
    for geom in geoms:
        if model.geom_rbound[geom] == 0.0:
            return np.array([[-np.inf] * 3, [np.inf] * 3])
        centre, half = model.geom_aabb[geom, :3], model.geom_aabb[geom, 3:]
        rotation = data.geom_xmat[geom].reshape(3, 3)
        for signs in itertools.product((-1.0, 1.0), repeat=3):
            points.append(back.transform(data.geom_xpos[geom] + matmul(rotation, centre + half * signs)))
    return np.array([np.min(points, axis=0), np.max(points, axis=0)]) if points else None


def _bounds_test(bounds: msgs.Bounds) -> Callable[[Simulation, str], bool] | None:
    """Return the condition that a model's box in the world overlaps the bounds; None for empty bounds."""
    kind, points = int(bounds.type), [np.array(vector_of(point, "bounds")) for point in bounds.points]
    if kind == _EMPTY:
        return None
    if kind == _HULL:
        raise Refusal(ResultCode.UNSUPPORTED, "bounds of the type convex hull are not supported; use a box or a sphere")
    if kind not in (_BOX, _SPHERE) or len(points) != 2:
        raise Refusal(
            ResultCode.FAILED, f"found bounds of type {kind} with {counted(len(points), 'point')}; expected two points"
        )
    if kind == _SPHERE:
        return lambda sim, name: _distance(sim, name, points[0]) <= points[1][0]
    low, high = np.minimum(*points), np.maximum(*points)

    def overlaps(sim: Simulation, name: str) -> bool:
        corners = _corners_or_point(sim, name)
        return bool((corners[0] <= high).all() and (corners[1] >= low).all())

    return overlaps


def _corners_or_point(sim: Simulation, name: str) -> Vector:
    corners = _corners(sim, "model", name)
    return corners if corners is not None else np.array([sim.model(name).pose.position] * 2)


def _distance(sim: Simulation, name: str, centre: Vector) -> float:
    low, high = _corners_or_point(sim, name)
    return norm(centre - np.clip(centre, low, high))
