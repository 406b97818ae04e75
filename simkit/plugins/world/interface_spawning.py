"""Spawning and deletion of models for ROS 2's `simulation_interfaces`."""

from __future__ import annotations

import os
import re
from collections.abc import Container, Iterator
from contextlib import contextmanager
from typing import TYPE_CHECKING, Final

from simkit import msgs
from simkit.errors import InputError, LoadError
from simkit.plugins.world.interface_entities import Refusal, ResultCode, requested_pose, result_fields
from simkit.plugins.world.service_entities import (
    RequestRefused,
    add_namespace,
    find_entity,
    spawn_entities,
)
from simkit.trusted_folders import OutsideError

if TYPE_CHECKING:
    from simkit.pose import Pose
    from simkit.runtime import Simulation

    _Arguments = tuple[str, str, Pose]
    _Request = msgs.SpawnEntity | msgs.simulation_interfaces__srv__SpawnEntity_Request

NAME_NOT_UNIQUE, NAME_INVALID, UNSUPPORTED_FORMAT, NO_RESOURCE = 101, 102, 103, 104
NAMESPACE_INVALID, PARSE_ERROR, MISSING_ASSETS, INVALID_POSE = 105, 106, 107, 109
ENTITIES_SPAWN_FAILED: Final = 150
_NAMESPACE: Final = re.compile(r"/?[A-Za-z_]\w*(/[A-Za-z_]\w*)*/?", re.ASCII)
_FAILURES: Final = (Refusal, RequestRefused, InputError)
_FORMATS: Final = ("", ".sdf", ".urdf", ".xacro", ".xml", ".world", ".model")


def spawn_entity(sim: Simulation, request: _Request) -> dict[str, object]:
    """Spawn a model at a pose in the world, or in the frame that the header of the pose names."""
    with _published_codes():
        return {"entity_name": spawn_entities(sim.spawn, *_arguments(sim, request)).name}


def spawn_several(
    sim: Simulation, request: msgs.simulation_interfaces__srv__SpawnEntities_Request
) -> dict[str, object]:
    """Spawn a model for each request of a list; the other models are spawned too if one request fails."""
    group = _SpawnGroup(sim)
    for number, spawn_request in enumerate(request.spawn_requests):
        group.add(number, spawn_request)
    group.spawn_waiting()
    results = [group.results[number] for number in range(len(request.spawn_requests))]
    failed = [str(number) for number, fields in enumerate(results) if "entity_name" not in fields]
    if not failed:
        return {"results": results}
    text = f"{len(failed)} of {len(results)} requests failed: {', '.join(failed[:10])}{', …' if failed[10:] else ''}"
    return {"result": {"result": ENTITIES_SPAWN_FAILED, "error_message": text}, "results": results}


class _SpawnGroup:
    """Requests of one list. Models that depend on no other request wait, and the world is compiled once for them.

    Attributes:
        results: fields of the `SpawnResult` of each request, by its number.
    """

    def __init__(self, sim: Simulation) -> None:
        self.results: dict[int, dict[str, object]] = {}
        self._sim = sim
        self._waiting: dict[str, tuple[int, _Request, _Arguments]] = {}

    def add(self, number: int, request: _Request) -> None:
        """Let the model of a request wait; if the request may depend on a waiting model, spawn that one first."""
        for _ in range(2):
            try:
                with _published_codes():
                    arguments = _arguments(self._sim, request, self._waiting)
            except _FAILURES as error:
                if not self._waiting:
                    self._refuse(number, error)
                    return
                self.spawn_waiting()
            else:
                self._waiting[arguments[1]] = number, request, arguments
                return

    def spawn_waiting(self) -> None:
        """Spawn the waiting models; if one of them cannot be spawned, each of them alone."""
        waiting, self._waiting = list(self._waiting.values()), {}
        if not waiting:
            return
        try:
            models = spawn_entities(self._sim.contents.spawn_all, [arguments for _, _, arguments in waiting])
        except (InputError, RequestRefused):
            for number, request, _ in waiting:
                self._spawn_alone(number, request)
        else:
            for (number, _, _), model in zip(waiting, models, strict=True):
                self._accept(number, model.name)

    def _spawn_alone(self, number: int, request: _Request) -> None:
        try:
            self._accept(number, str(spawn_entity(self._sim, request)["entity_name"]))
        except _FAILURES as error:
            self._refuse(number, error)

    def _accept(self, number: int, name: str) -> None:
        self.results[number] = {"result": {"result": ResultCode.OK}, "entity_name": name}

    def _refuse(self, number: int, error: Exception) -> None:
        self._sim.engine.log.warning("/spawn_entities: request %d: %s", number, error)
        self.results[number] = {"result": result_fields(error)}


def _arguments(sim: Simulation, request: _Request, waiting: Container[str] = ()) -> _Arguments:
    """Return source, name and pose of a new model, as arguments of `sim.spawn`.

    Args:
        sim: simulation.
        request: request with the fields of `simulation_interfaces/msg/SpawnEntity`.
        waiting: names that models of the same list will have.
    """
    source = sim.control.client_source(_source(request))
    pose = _pose(sim, request.initial_pose)
    name = request.name or sim.contents.name_in_file(source)
    if name in sim.models or name in waiting:
        if not request.allow_renaming:
            raise Refusal(NAME_NOT_UNIQUE, f"a model {name!r} already exists, and allow_renaming is false")
        numbered = (f"{name}_{number}" for number in range(1, 10**9))
        name = next(free for free in numbered if free not in sim.models and free not in waiting)
    return source, name, pose


@contextmanager
def _published_codes() -> Iterator[None]:
    """Raise a `Refusal` with the published result code for the errors of a load."""
    try:
        yield
    except LoadError as error:
        raise Refusal(_load_code(error), str(error)) from error
    except OutsideError as error:
        raise Refusal(NO_RESOURCE, str(error)) from error
    except InputError as error:
        raise Refusal(NAME_INVALID if error.code == "SK-NAME-005" else ResultCode.FAILED, str(error)) from error


def delete_entity(sim: Simulation, request: msgs.simulation_interfaces__srv__DeleteEntity_Request) -> None:
    """Remove a top-level model."""
    name = request.entity
    if name not in sim.models:
        try:
            _, scoped = find_entity(sim, name, ("model", "link", "light"), "entity")
        except RequestRefused as error:
            raise Refusal(ResultCode.NOT_FOUND, str(error)) from error
        raise Refusal(ResultCode.FAILED, f"{scoped!r} is no model of the world itself, so it cannot be deleted")
    sim.remove(name)


def _source(request: _Request) -> str:
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
    if not text.lstrip("\ufeff \t\r\n").startswith("<"):
        raise Refusal(UNSUPPORTED_FORMAT, f"found the text {text!r:.80}; expected SDF, URDF or MJCF")
    return add_namespace(text, namespace.strip("/")) if namespace else str(text)


def _pose(sim: Simulation, stamped: msgs.PoseStamped) -> Pose:
    try:
        return requested_pose(sim, stamped.header, stamped.pose, "initial_pose")
    except RequestRefused as error:
        raise Refusal(INVALID_POSE, str(error)) from error


def _load_code(error: LoadError) -> int:
    """Return the result code for a model that cannot be read."""
    errors = [item for item in error.diagnostics if item.severity == "error"]
    codes = [item.code for item in errors]
    # the place of a URI that is not found is the URI itself
    if codes[:1] == ["SK-LOAD-002"] or (errors and "://" in (errors[0].file or "")):
        return NO_RESOURCE
    if any(code.startswith(("SK-URI-", "SK-MESH-")) for code in codes):
        return MISSING_ASSETS
    return NAME_NOT_UNIQUE if "SK-LOAD-011" in codes else PARSE_ERROR
