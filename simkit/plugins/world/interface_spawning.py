"""Spawning and deletion of models for ROS 2's `simulation_interfaces`."""

from __future__ import annotations

import os
import re
from typing import TYPE_CHECKING, Any, Final

from simkit.errors import InputError, LoadError
from simkit.plugins.world.interface_entities import Refusal, ResultCode
from simkit.plugins.world.service_entities import (
    RequestRefused,
    add_namespace,
    find_entity,
    frame_of,
    pose_of,
    spawn_entities,
)

if TYPE_CHECKING:
    from simkit.pose import Pose
    from simkit.runtime import Simulation

NAME_NOT_UNIQUE, NAME_INVALID, UNSUPPORTED_FORMAT, NO_RESOURCE = 101, 102, 103, 104
NAMESPACE_INVALID, PARSE_ERROR, MISSING_ASSETS, INVALID_POSE = 105, 106, 107, 109
_NAMESPACE: Final = re.compile(r"/?[A-Za-z_]\w*(/[A-Za-z_]\w*)*/?", re.ASCII)
_FORMATS: Final = ("", ".sdf", ".urdf", ".xacro", ".xml", ".world", ".model")


def spawn_entity(sim: Simulation, request: Any) -> dict[str, object]:
    """Spawn a model at a pose in the world, or in the frame that the header of the pose names."""
    source = _source(request)
    pose = _pose(sim, request.initial_pose)
    try:
        name = request.name or sim.contents.name_in_file(source)
        if name in sim.models:
            if not request.allow_renaming:
                raise Refusal(NAME_NOT_UNIQUE, f"a model {name!r} already exists, and allow_renaming is false")
            name = next(free for free in (f"{name}_{i}" for i in range(1, 10**9)) if free not in sim.models)
        return {"entity_name": spawn_entities(sim.spawn, source, name, pose).name}
    except LoadError as error:
        raise Refusal(_load_code(error), str(error)) from error
    except InputError as error:
        raise Refusal(NAME_INVALID if error.code == "SK-NAME-005" else ResultCode.FAILED, str(error)) from error


def delete_entity(sim: Simulation, request: Any) -> None:
    """Remove a top-level model."""
    name = request.entity
    if name not in sim.models:
        try:
            _, scoped = find_entity(sim, name, ("model", "link", "light"), "entity")
        except RequestRefused as error:
            raise Refusal(ResultCode.NOT_FOUND, str(error)) from error
        raise Refusal(ResultCode.FAILED, f"{scoped!r} is no model of the world itself, so it cannot be deleted")
    sim.remove(name)


def _source(request: Any) -> str:
    """Return the text or URI of a resource, with the namespace added to the plugins of a text."""
    resource, namespace = request.entity_resource, request.entity_namespace
    uri, text = resource.uri, resource.resource_string
    if namespace and not _NAMESPACE.fullmatch(namespace):
        raise Refusal(NAMESPACE_INVALID, f"found the namespace {namespace!r}; expected words of letters, digits and _")
    if uri:
        if namespace:
            raise Refusal(ResultCode.FAILED, "a namespace needs the model as text; set resource_string instead of uri")
        extension = os.path.splitext(uri)[1].lower()  # noqa: PTH122 (a URI is no path)
        if extension not in _FORMATS:
            raise Refusal(UNSUPPORTED_FORMAT, f"found a file {extension!r}; expected one of {', '.join(_FORMATS[1:])}")
        return str(uri)
    if not text.strip():
        raise Refusal(NO_RESOURCE, "the request has neither a uri nor a resource_string")
    return add_namespace(text, namespace.strip("/")) if namespace else str(text)


def _pose(sim: Simulation, stamped: Any) -> Pose:
    try:
        return frame_of(sim, stamped.header.frame_id) @ pose_of(stamped.pose, "initial_pose")
    except RequestRefused as error:
        raise Refusal(INVALID_POSE, str(error)) from error


def _load_code(error: LoadError) -> int:
    """Return the result code for a model that cannot be read."""
    codes = [item.code for item in error.diagnostics if item.severity == "error"]
    if codes[:1] == ["SK-LOAD-002"]:
        return NO_RESOURCE
    if any(code.startswith(("SK-URI-", "SK-MESH-")) for code in codes):
        return MISSING_ASSETS
    return NAME_NOT_UNIQUE if "SK-LOAD-011" in codes else PARSE_ERROR
