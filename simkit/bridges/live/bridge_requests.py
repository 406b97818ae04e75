"""Handlers of the requests that only bridges to other middleware send: the whole graph, and parts of actions."""

from __future__ import annotations

from collections.abc import Collection, Mapping
from pathlib import Path
from types import MappingProxyType
from typing import Final

from simkit.bridges.live.introspection import node_list, topic_list
from simkit.bridges.live.request_fields import RequestRefused, client_text
from simkit.bridges.live.requests import Request, RequestHandler, Response
from simkit.errors import MessageError
from simkit.msgs.derived_types import derived_type
from simkit.msgs.message_builder import builder_of
from simkit.msgs.message_types import full_name, type_of
from simkit.msgs.type_hashes import rihs
from simkit.runtime.communication.service_server import Service
from simkit.scene.geometry import Mesh
from simkit.scene.urdf_text import urdf_text
from simkit.trusted_folders import OutsideError, TrustedFolders, join_below

_TEXTURES: Final = (".bmp", ".gif", ".jpeg", ".jpg", ".mtl", ".png", ".tga", ".tif", ".tiff", ".webp")


def graph(request: Request) -> object:
    """Return topics, heard topics, services, actions, nodes and URDF robots, with type hashes and simulated time.

    `bridged` has the services of bridges, which are not part of the simulation.

    If nothing has changed since the graph with the revision in the request, return only revision and time.
    """
    sim = request.sim
    services, actions = sim.communication.services.names(), sim.communication.actions.names()
    robots = [name for name, model in sim.models.items() if model.scene.urdf is not None]
    peers = [(p.node, *p.nodes, *p.subscriptions, *p.endpoints) for p in request.server.peers.values()]
    content = tuple(services.items()), tuple(actions.items()), robots, peers
    revision = f"{sim.communication.bus.revision} {content!r}".__hash__()
    stamp = {"revision": revision, "time_ns": sim.time_ns}
    if request.args.get("revision") == revision:
        return stamp
    topics = topic_list(sim, request.server.peers.values())
    types = {t for row in topics for t in row["types"]} | {
        t for row in topics for s in row["subscribers"] for t in s["types"]
    }
    names = [*types, *services.values()]
    for action in actions.values():
        names += [f"{action}_SendGoal", f"{action}_GetResult", f"{action}_FeedbackMessage"]
    heard = sorted({subscription.topic for subscription in sim.communication.bus.subscriptions()})
    return {
        **stamp,
        "topics": topics,
        "heard": heard,
        "services": services,
        "bridged": _bridged(request),
        "actions": actions,
        "nodes": list(node_list(sim, request.server.peers.values())),
        "robots": robots,
        "hashes": _hashes(names),
    }


def _bridged(request: Request) -> list[str]:
    """Return the names of the services that bridges offer."""
    bridges = [peer for peer in request.server.peers.values() if peer.is_bridge]
    endpoints = [endpoint.opened for peer in bridges for endpoint in peer.endpoints.values()]
    return [endpoint.name for endpoint in endpoints if isinstance(endpoint, Service)]


def _hashes(names: Collection[str]) -> dict[str, str]:
    """Return the type hashes by name; types without a hash are left out."""
    hashes = {}
    for name in dict.fromkeys(names):
        try:
            hashes[name] = rihs(name)
        except (MessageError, KeyError, ValueError):
            continue
    return hashes


def goal_result(request: Request) -> object:
    """Return the response of an action's service GetResult, whose CDR is aligned otherwise than the result's own."""
    action, status = request.arg("action", str), request.arg("status", int)
    result = request.message() if request.data else None
    try:
        response = derived_type(f"{action}_GetResult_Response")
        if result is None:
            result = builder_of(f"{action}_Result").default()
    except (MessageError, ValueError, LookupError) as error:
        raise RequestRefused(client_text(error)) from None
    if not isinstance(result, type_of(f"{action}_Result")):
        raise RequestRefused(f"the result is not one of {action}")
    return Response(response(status, result))


def robot_description(request: Request) -> object:
    """Return the URDF of a robot."""
    root = request.sim.model(request.arg("name", str)).scene.urdf
    if root is None:
        raise RequestRefused("the model is not in URDF")
    return urdf_text(root)


def asset(request: Request) -> object:
    """Return the path of a mesh of the scene, or of a file for a texture in the folder of a mesh, by its URI."""
    uri = request.arg("uri", str)
    folder, _, name = uri.rpartition("/")
    links = (link for model in request.sim.models.values() for link in model.scene.all_links())
    shapes = ([*(v.geometry for v in link.visuals), *(c.geometry for c in link.collisions)] for link in links)
    for mesh in (shape for group in shapes for shape in group if isinstance(shape, Mesh) and not shape.missing):
        for known in (mesh.uri, mesh.file.as_uri()):
            if uri == known:
                return str(mesh.file)
            if folder == known.rpartition("/")[0] and Path(name).suffix.lower() in _TEXTURES:
                path = _beside(mesh.file, name)
                if path is not None:
                    return str(path)
    raise RequestRefused(f"{uri!r:.200} is no mesh of the simulation")


def _beside(file: Path, name: str) -> Path | None:
    """Return the path of a file in the folder of another one; None if the name or a link leads out of the folder."""
    try:
        path = join_below(file.parent, name)
    except OutsideError:
        return None
    return path if TrustedFolders([file.parent, file.resolve().parent]).allows(path) else None


def default_message(request: Request) -> object:
    """Return a message of a type with all fields zero."""
    return Response(builder_of(full_name(request.arg("type", str))).default())


BRIDGE_REQUESTS: Final[Mapping[str, RequestHandler]] = MappingProxyType(
    {
        "graph": graph,
        "goal_result": goal_result,
        "asset": asset,
        "default_message": default_message,
        "robot_description": robot_description,
    }
)
"""Handler of each request, by the name that a bridge sends."""
