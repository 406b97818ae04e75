"""Describe the topics, nodes, parameters and models of a simulation as plain data."""

from __future__ import annotations

from collections.abc import Collection, Iterable
from typing import TYPE_CHECKING, Any

import numpy as np

from simkit.bridges.live.connection import ClientConnection
from simkit.bridges.live.protocol import JsonObject
from simkit.runtime.communication.node_names import name_part, node_of

if TYPE_CHECKING:
    from simkit.pose import Pose
    from simkit.runtime.simulation import Simulation


_ENDPOINTS = ("publishers", "subscribers", "services", "service_clients", "actions", "action_clients")


def topic_list(sim: Simulation, clients: Collection[ClientConnection]) -> list[JsonObject]:
    """List every topic with its publishers and subscribers, including clients, sorted by name."""
    names = NodeNames(sim, clients)
    rows: dict[str, JsonObject] = {
        topic: {"name": topic, "types": [], "publishers": [], "subscribers": []}
        for topic in sim.communication.bus.topics()
    }
    for topic, endpoint, types, role in sim.communication.bus.endpoints():
        if topic not in rows or not endpoint.active:
            continue
        row, node = rows[topic], names.endpoint_node(endpoint)
        row["types"] += [t for t in types[:1] if t not in row["types"]]
        if role == "publishes":
            latched = bool(getattr(endpoint, "latched", False))
            row["publishers"].append({"node": node, "type": types[0], "latched": latched})
        else:
            row["subscribers"].append({"node": node, "types": list(types), "kind": "input"})
    for reader in sim.communication.bus.subscriptions():
        if reader.node:
            fresh: JsonObject = {"name": reader.topic, "types": [reader.type_name], "publishers": [], "subscribers": []}
            row = rows.setdefault(reader.topic, fresh)
            row["subscribers"].append({"node": reader.node, "types": [reader.type_name], "kind": "program"})
    for peer in clients:
        for number, subscribed in peer.subscriptions.items():
            row = rows.get(subscribed.topic, {})
            if row:
                node = peer.node_of(number)
                row["subscribers"].append({"node": node, "types": row["types"][:1], "kind": "client"})
    return [rows[topic] for topic in sorted(rows)]


def node_list(sim: Simulation, clients: Collection[ClientConnection]) -> dict[str, JsonObject]:
    """List the nodes with their publishers, subscribers, services, actions and parameters.

    Returns:
        Node -> `publishers`, `subscribers`, `services`, `service_clients`, `actions`, `action_clients` (each name ->
        types) and `parameters` (names).
    """
    names = NodeNames(sim, clients)
    nodes: dict[str, JsonObject] = {}

    def entry(node: str) -> JsonObject:
        fresh: JsonObject = {kind: {} for kind in _ENDPOINTS}
        fresh["parameters"] = []
        return nodes.setdefault(node, fresh)

    for row in topic_list(sim, clients):
        for end in row["publishers"]:
            entry(end["node"])["publishers"][row["name"]] = [end["type"]]
        for end in row["subscribers"]:
            entry(end["node"])["subscribers"][row["name"]] = list(end["types"])
    for name in sim.communication.services.names():
        service = sim.communication.services.find(name)
        if service is not None:
            entry(names.endpoint_node(service))["services"][name] = [service.type_name]
    for name in sim.communication.actions.names():
        action = sim.communication.actions.find(name)
        if action is not None:
            entry(names.endpoint_node(action))["actions"][name] = [action.type_name]
    messages = sim.communication
    for kind, clients_of_kind in (
        ("service_clients", messages.services.clients),
        ("action_clients", messages.actions.clients),
    ):
        for client in clients_of_kind:
            entry(client.node)[kind][client.name] = [client.type_name]
    for node, parameters in sim.communication.parameters.items():
        entry(node)["parameters"] = list(parameters)
    for peer in clients:
        for node in peer.all_nodes:
            entry(node)
    return dict(sorted(nodes.items()))


def parameter_list(sim: Simulation) -> dict[str, JsonObject]:
    """List the parameters of all nodes.

    Returns:
        Node -> name -> `value`, `type`, `minimum`, `maximum`, `choices`, `allowed` and `description`.
    """
    return {
        node: {
            name: {
                "value": list(p.value) if isinstance(p.value, tuple) else p.value,
                "type": type(p.value).__name__,
                "minimum": p.minimum,
                "maximum": p.maximum,
                "choices": list(p.choices),
                "allowed": p.allowed,
                "description": p.description,
            }
            for name, p in of_node.items()
        }
        for node, of_node in sim.communication.parameters.items()
    }


def model_state(sim: Simulation, name: str) -> JsonObject:
    """Return pose, links and joints of a model.

    Raises:
        KeyError: no model has the name; the message suggests the closest name.
    """
    model = sim.model(name)
    return {
        "name": model.scoped,
        "static": model.static,
        "pose": _pose_dict(model.pose),
        "links": {
            link_name: {
                "pose": _pose_dict(link.pose),
                "linear_velocity": link.linear_velocity,
                "angular_velocity": link.angular_velocity,
            }
            for link_name, link in model.links.items()
        },
        "joints": {
            joint_name: {name: getattr(joint, name) for name in ("type", "position", "velocity", "effort")}
            for joint_name, joint in model.joints.items()
        },
        "models": list(model.models),
    }


def _pose_dict(pose: Pose) -> JsonObject:
    return {"position": pose.position, "quaternion": pose.quaternion, "rpy": np.asarray(pose.rpy)}


class NodeNames:
    """Names of the nodes that own publishers, subscribers, services and actions."""

    def __init__(self, sim: Simulation, clients: Iterable[ClientConnection]) -> None:
        self._world = "/" + name_part(sim.world.name)
        self._nodes: dict[int, list[str]] = {}
        for node, of_node in sim.communication.parameters.items():
            for owner in {id(p.owner): p.owner for p in of_node.values() if p.owner is not None}:
                self._nodes.setdefault(owner, []).append(node)
        self._clients = {id(end): peer.node_of(n) for peer in clients for n, end in peer.publishers.items()}
        self._clients |= {id(e.opened): peer.node_of(n) for peer in clients for n, e in peer.endpoints.items()}

    def endpoint_node(self, end: Any) -> str:
        """Return the node of a publisher, a subscriber, a service or an action."""
        remote = getattr(end, "remote", None)
        program = getattr(end, "node", "") if remote is None else remote.node
        if program:
            return str(program)
        name = str(getattr(end, "topic", None) or end.name)
        nodes = self._nodes.get(id(end.owner), ()) if end.owner is not None else ()
        below = [node for node in nodes if name.startswith(f"{node}/")]  # a controller manager has several nodes
        return self._clients.get(id(end)) or max(below, key=len, default="") or self.owner_node(end.owner)

    def owner_node(self, owner: object) -> str:
        """Return the node of a plugin or a sensor; the world's node if there is no owner."""
        if owner is None:
            return self._world
        known = self._nodes.get(id(owner))
        if known is not None and len(known) == 1:
            return known[0]
        return node_of(owner) or self._world
