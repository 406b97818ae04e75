"""Bridge between one simulation and ROS 2: opens in ROS what the simulation has, and passes messages on.

`main` is the program of the bridge process.
"""

from __future__ import annotations

import select
import time
from collections.abc import Callable, Mapping
from functools import partial
from pathlib import Path
from typing import TypeVar

from simkit.bridges.bridge_program import begin, run_until_end, tell
from simkit.bridges.live.protocol import JsonObject, LiveClosed
from simkit.bridges.simulation_link import SimulationLink, robot_descriptions
from simkit_ros.action_bridge import ActionBridge
from simkit_ros.ros_names import parameter_node, ros_name
from simkit_ros.ros_session import RosSession
from simkit_ros.ros_types import RosType, TypeUnavailable
from simkit_ros.service_bridge import RemoteService, ServiceBridge
from simkit_ros.topic_bridge import IncomingTopic, OutgoingTopic, RobotDescription
from simkit_ros.wait_thread import RosWaiter

_LOOK_PERIOD = 0.1  # [s] between two counts of ROS's subscriptions
_GRAPH_PERIOD = 0.5  # [s] between two looks at the graphs of the simulation and of ROS
_LAST_WAIT = 1.0  # [s], longest wait for subscriptions of ROS that have not received the last messages yet

Reader = IncomingTopic | ServiceBridge | ActionBridge | RemoteService

T = TypeVar("T")
Served = TypeVar("Served", ServiceBridge, ActionBridge)


class Bridge:
    """Bridge between a simulation and ROS 2.

    Args:
        path: path of the simulation's socket.
        session: session of ROS.
        namespace: namespace of all names in ROS, such as `/robot`; empty for none.
        report: callback for a note to the user.
    """

    def __init__(self, path: Path, session: RosSession, namespace: str, report: Callable[[str], None]) -> None:
        self._session, self._namespace, self._report = session, namespace, report
        self.link = SimulationLink(path, report)
        self._waiter = RosWaiter(session.context)
        self._outgoing: dict[str, OutgoingTopic] = {}
        self._incoming: dict[str, IncomingTopic] = {}
        self._services: dict[str, ServiceBridge] = {}
        self._actions: dict[str, ActionBridge] = {}
        self._remote: dict[str, RemoteService] = {}
        self._descriptions: dict[str, RobotDescription] = {}
        self._reported: set[str] = set()
        self._names: dict[str, str] = {}
        self._readers: dict[int, Reader] = {}
        self._graph: JsonObject = {}
        self._now_ns = 0
        self._next_look = self._next_graph = 0.0
        self._is_asking = False

    # ------------------------------------------------------------------ the loop

    def open(self) -> JsonObject:
        """Open everything that the simulation has now, and return the numbers of what is open."""
        self._apply_graph(self.link.request("graph", {})[0])
        self._look()
        self.link.dispatch_answers()
        self._waiter.resume()
        counts = {"topics": len(self._outgoing.keys() | self._incoming.keys()), "services": len(self._services)}
        return {**counts, "actions": len(self._actions), "nodes": self._session.node_count}

    def run(self) -> None:
        """Pass messages, requests and goals on until the simulation ends.

        Raises:
            LiveClosed: the simulation has ended, or has closed the connection.
        """
        while True:
            left = max(0.0, min(self._next_look, self._next_graph) - time.monotonic())
            ready, _, _ = select.select([self.link.fileno(), self._waiter.fileno()], [], [], left)
            if self.link.fileno() in ready:
                self.link.receive(0.0)
                self.link.dispatch_answers()
                self._send_requests()
            if self._waiter.fileno() in ready and self._waiter.is_stopped():
                self._take_from_ros()
            now = time.monotonic()
            if now >= self._next_look:
                self._next_look = now + _LOOK_PERIOD
                self._look()
            if now >= self._next_graph and not self._is_asking:
                self._next_graph, self._is_asking = now + _GRAPH_PERIOD, True
                self.link.ask("graph", {"revision": self._graph.get("revision")}, then=self._take_graph)
            self._waiter.resume()

    def _look(self) -> None:
        for outgoing in self._outgoing.values():
            outgoing.look()
        self._send_requests()

    def _send_requests(self) -> None:
        """Send the requests of the simulation to services of ROS; a client is opened with the first request."""
        unopened = [remote.open for remote in self._remote.values() if remote.needs_client]
        if unopened:
            self._change(*unopened)
        for remote in self._remote.values():
            remote.send()

    def _take_from_ros(self) -> None:
        for pointer in self._waiter.ready:
            reader = self._readers.get(pointer)
            if reader is not None:
                self._guarded(getattr(reader, "topic", "") or str(getattr(reader, "ros_type", reader)), reader.take)

    def _guarded(self, what: str, take: Callable[[], None]) -> None:
        """Call a function that reads from ROS; report the data that cannot be decoded."""
        try:
            take()
        except LiveClosed:
            raise
        except Exception as error:  # noqa: BLE001 - rclpy raises many errors for data that it cannot decode
            self._note(what, f"data of {what} are dropped: {error!r}")

    def _note(self, key: str, text: str) -> None:
        """Report a note once."""
        if key not in self._reported:
            self._reported.add(key)
            self._report(text)

    # ------------------------------------------------------------------ the graph

    def _take_graph(self, graph: JsonObject, _: bytes) -> None:
        self._is_asking = False
        self._now_ns = int(graph["time_ns"])
        if "topics" in graph:
            self._apply_graph(graph)
        else:
            self._apply_incoming()
        self._apply_remote()

    def _apply_graph(self, graph: JsonObject) -> None:
        """Open what is new in the simulation's graph, and close what is gone."""
        self._graph, self._now_ns = graph, int(graph["time_ns"])
        self._session.types.hashes.update(graph["hashes"])
        self._apply_outgoing()
        self._apply_incoming()
        services = {name: kind for name, kind in graph["services"].items() if name not in graph["bridged"]}
        self._apply(self._services, services, self._service)
        self._apply(self._actions, graph["actions"], self._action)
        self._apply_descriptions()
        parameter_nodes = {parameter_node(self._ros_name(name)) for name in services}
        self._session.close_nodes_except(parameter_nodes)

    def _apply_descriptions(self) -> None:
        """Publish the URDF of every robot, and that of the first robot without the robot's name."""
        wanted = robot_descriptions(self._graph)
        for topic in [t for t, d in self._descriptions.items() if wanted.get(t) != d.robot]:
            self._descriptions.pop(topic).close()
        for topic, name in wanted.items():
            if topic not in self._descriptions and topic not in self._outgoing:
                self._descriptions[topic] = RobotDescription(self.link, self._session, self._ros_name(topic), name)

    def _apply_outgoing(self) -> None:
        wanted: dict[str, tuple[str, bool]] = {}
        for row in self._graph["topics"]:
            ends = [end for end in row["publishers"] if end["node"] != self.link.node]
            if ends:
                wanted[row["name"]] = ends[0]["type"], any(end["latched"] for end in ends)
        for topic in [t for t, out in self._outgoing.items() if wanted.get(t, ("",))[0] != out.ros_type.name]:
            self._outgoing.pop(topic).close()
        for topic, (type_name, is_latched) in wanted.items():
            ros_type = self._type(topic, type_name)
            if topic not in self._outgoing and ros_type is not None:
                name = self._ros_name(topic)
                # one participant can have only one type for a topic
                if topic in self._incoming and self._incoming[topic].ros_type != ros_type:
                    self._change(self._incoming.pop(topic).close)
                arguments = self.link, self._session, topic, name, ros_type, is_latched, self._report
                self._open(self._outgoing, topic, partial(OutgoingTopic, *arguments))

    def _apply_incoming(self) -> None:
        """Open and close subscriptions of ROS, so that their types and qualities of service suit ROS's publishers."""
        changes: list[Callable[[], None]] = []
        wanted = self._takable()
        for topic in [t for t in self._incoming if t not in wanted]:
            changes.append(self._incoming.pop(topic).close)
        for topic, (types, is_input) in wanted.items():
            publishers = self._session.publishers_of(self._ros_name(topic))
            usable = [p for p in publishers if p[0] in types or not types]
            if not usable and not is_input:
                if topic in self._incoming:
                    changes.append(self._incoming.pop(topic).close)
                continue
            type_name = usable[0][0] if usable else types[0]
            if topic in self._outgoing:
                type_name = self._outgoing[topic].ros_type.name
            qos = self._session.subscription_qos([p for p in usable if p[0] == type_name])
            current = self._incoming.get(topic)
            ros_type = self._type(topic, type_name)
            is_right = current is not None and current.ros_type.name == type_name and (current.qos == qos or not usable)
            if ros_type is None or is_right:
                continue
            if current is not None:
                changes.append(current.close)
            arguments = self.link, self._session, topic, self._ros_name(topic), ros_type, qos, self._report
            changes.append(partial(self._open, self._incoming, topic, partial(IncomingTopic, *arguments)))
        if changes:
            self._change(*changes)

    def _apply_remote(self) -> None:
        """Offer the services of ROS nodes in the simulation, and close those that are gone."""
        wanted = self._session.services_of_others()
        gone = [name for name, remote in self._remote.items() if wanted.get(name) != remote.type_name]
        if gone:
            self._change(*(self._remote.pop(name).close for name in gone))
        for name in [name for name in wanted if name not in self._remote]:
            service = name.removeprefix(self._namespace) if name.startswith(f"{self._namespace}/") else name
            arguments = self.link, self._session, service, name, wanted[name], partial(self._note, name)
            self._remote[name] = RemoteService(*arguments)

    def _takable(self) -> dict[str, tuple[tuple[str, ...], bool]]:
        """Return the topics that the simulation takes: their types (none: any), and whether they are command inputs.

        A topic with only subscriptions, of a script or of another client, is taken from ROS if nothing in the
        simulation publishes it.
        """
        takable: dict[str, tuple[tuple[str, ...], bool]] = {}
        published = set()
        for row in self._graph["topics"]:
            if any(end["node"] != self.link.node for end in row["publishers"]):
                published.add(row["name"])
            types = [t for end in row["subscribers"] if end["kind"] == "input" for t in end["types"]]
            if types:
                takable[row["name"]] = tuple(dict.fromkeys(types)), True
        for topic in self._graph["heard"]:
            if topic not in published and topic not in takable:
                takable[topic] = (), False
        return takable

    def _apply(self, table: dict[str, Served], wanted: Mapping[str, str], make: Callable[[str, str], Served]) -> None:
        """Open and close services or actions."""
        gone = [name for name, bridge in table.items() if wanted.get(name) != bridge.type_name]
        fresh = [name for name in wanted if name not in table or name in gone]
        if not gone and not fresh:
            return

        def change() -> None:
            for name in gone:
                table.pop(name).close()
            for name in fresh:
                self._open(table, name, partial(make, name, wanted[name]))

        self._change(change)

    def _change(self, *changes: Callable[[], None]) -> None:
        """Open and close subscriptions and services while the waiting thread is stopped."""
        self._waiter.stop()
        for change in changes:
            change()
        subscriptions = [incoming.subscription for incoming in self._incoming.values()]
        bridges: list[ServiceBridge | ActionBridge] = [*self._services.values(), *self._actions.values()]
        services = [(end.service, bridge) for bridge in bridges for end in bridge.ends]
        self._readers = {incoming.subscription.handle.pointer: incoming for incoming in self._incoming.values()}
        self._readers |= {service.handle.pointer: bridge for service, bridge in services}
        clients = [(remote.end.client, remote) for remote in self._remote.values() if remote.end is not None]
        self._readers |= {client.handle.pointer: remote for client, remote in clients}
        self._waiter.watch(subscriptions, [service for service, _ in services], [client for client, _ in clients])

    def _open(self, table: dict[str, T], name: str, make: Callable[[], T]) -> None:
        """Open a topic, service or action; report one that ROS does not accept."""
        try:
            table[name] = make()
        except LiveClosed:
            raise
        except Exception as error:  # noqa: BLE001 - rclpy raises many errors for names and types
            self._note(name, f"{name} is left out: {error}")

    def _service(self, service: str, type_name: str) -> ServiceBridge:
        ros_type = self._session.types.find(type_name)
        return ServiceBridge(self.link, self._session, service, self._ros_name(service), ros_type, self._report)

    def _action(self, action: str, type_name: str) -> ActionBridge:
        name = self._ros_name(action)
        return ActionBridge(self.link, self._session, action, name, type_name, self._now, self._report)

    def _now(self) -> int:
        """Return the simulated time of the last look at the graph [ns]."""
        return self._now_ns

    def _type(self, name: str, type_name: str) -> RosType | None:
        """Return a type for a topic or service; None with a note if the type cannot be passed on."""
        try:
            return self._session.types.find(type_name)
        except TypeUnavailable as reason:
            self._note(name, f"{name} is left out: {reason}")
            return None

    def _ros_name(self, name: str) -> str:
        """Return the name in ROS; report names that ROS does not accept, and names that become equal."""
        if name not in self._names:
            in_ros = ros_name(name, self._namespace)
            if not in_ros.endswith(name):
                self._note(name, f"{name} is {in_ros} in ROS, which does not accept the name")
            self._names[name] = in_ros
        return self._names[name]

    # ------------------------------------------------------------------ the end

    def close(self) -> None:
        """Wait until ROS has the last messages, and close the connection to the simulation."""
        end = time.monotonic() + _LAST_WAIT
        for outgoing in self._outgoing.values():
            outgoing.flush(max(0.0, end - time.monotonic()))
        self._waiter.close()
        self.link.close()


def main(options: JsonObject) -> int:
    """Run the bridge until the simulation ends; return the exit code.

    Args:
        options: `socket`, the path of the simulation's socket, `namespace` and `arguments` of ROS.
    """
    begin()
    try:
        session = RosSession("simkit", options["namespace"], options["arguments"])
    except Exception as error:  # noqa: BLE001 - rclpy raises its own errors, whose class is not known before the import
        is_unknown = type(error).__name__ == "UnknownROSArgsError"
        reason = f"unknown arguments after --ros-args: {error}" if is_unknown else error
        tell(error=f"ROS cannot be opened: {reason}")
        return 1

    def run() -> None:
        bridge = Bridge(Path(options["socket"]), session, options["namespace"], lambda text: tell(note=text))
        try:
            tell(ready=bridge.open())
            bridge.run()
        finally:
            bridge.close()

    try:
        return run_until_end(run)
    finally:
        session.close()
