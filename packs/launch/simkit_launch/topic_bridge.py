"""Bridge between topics of Gazebo and of ROS in a simulation, where both are topics of one bus."""

from __future__ import annotations

import re
from collections.abc import Callable
from dataclasses import dataclass, field
from typing import TYPE_CHECKING, Final

from simkit.diagnostics import did_you_mean
from simkit.errors import MessageError, SimkitError
from simkit.extend import Sensor
from simkit.msgs.topic_names import absolute_name
from simkit.msgs.type_conversions import conversion
from simkit.runtime.communication.topic_relay import NO_SOURCE, InputRelay, TopicRelay, input_types
from simkit_launch.bridge_rules import BridgeRule
from simkit_launch.program_simulation import report_other_world

if TYPE_CHECKING:
    from simkit import Simulation
    from simkit_nodes.graph import GraphNode

_SENSOR_TOPIC: Final = re.compile(
    r"(?P<before>/world/[^/]+/model/(?P<model>.+)/link/)(?P<link>[^/]+)/sensor/(?P<rest>.+)"
)
_WORLD_TOPIC: Final = re.compile(r"/world/(?P<world>[^/]+)/(?P<rest>.+)")
_NEVER: Final = "nothing in the world has such a topic"
_NO_HINT: Final = "the summary of a run lists its topics; a plugin or a sensor publishes or takes them"


@dataclass
class _Connection:
    """Rule that the bridge has not connected completely yet.

    Attributes:
        rule: rule.
        gz: absolute name in Gazebo.
        ros: absolute name in ROS.
        to_ros, to_gz: directions that wait.
        has_input: True if the topic of ROS is a command input.
        relays: relays of the connection.
    """

    rule: BridgeRule
    gz: str
    ros: str
    to_ros: bool
    to_gz: bool
    has_input: bool = False
    relays: list[TopicRelay | InputRelay] = field(default_factory=list)


class TopicBridge:
    """Connections of a bridge.

    A topic of Gazebo may appear later, with a model that is spawned. The two names of a rule are connected by a relay
    within the simulation, so large messages are not converted. Equal names need no relay: the topic is the same one.

    Args:
        sim: simulation.
        node: full name of the bridge's node.
        report: function that prints an error.
    """

    def __init__(self, sim: Simulation, node: str, report: Callable[[str], object]) -> None:
        self._sim, self._node, self._report = sim, node, report
        self._waiting: list[_Connection] = []
        self._relays: list[TopicRelay | InputRelay] = []

    @property
    def is_complete(self) -> bool:
        """True if no rule waits for its topic."""
        return not self._waiting

    def add(self, rule: BridgeRule, gz: str, ros: str) -> None:
        """Add a rule.

        Args:
            rule: rule.
            gz: absolute name in Gazebo.
            ros: absolute name in ROS, after remapping.
        """
        is_to_ros, is_to_gz = rule.direction != "ROS_TO_GZ", rule.direction != "GZ_TO_ROS"
        gz = self._in_present_world(absolute_name(gz))
        self._waiting.append(_Connection(rule, gz, absolute_name(ros), is_to_ros, is_to_gz))

    def _in_present_world(self, topic: str) -> str:
        """Return a topic of Gazebo with the name of the world that the run has."""
        match = _WORLD_TOPIC.fullmatch(topic)
        if match is None or not report_other_world(self._node, match["world"]):
            return topic
        return f"/world/{self._sim.world.name}/{match['rest']}"

    def connect(self) -> None:
        """Connect the rules whose topics are there."""
        self._waiting = [each for each in self._waiting if not self._is_connected(each)]

    def _use_merged_link(self, connection: _Connection) -> None:
        """Replace the link in a topic of Gazebo by the link of the sensor in simkit.

        Gazebo merges links of a URDF that fixed joints connect, and names a sensor after the link that remains.
        """
        match = _SENSOR_TOPIC.fullmatch(connection.gz)
        if match is None or self._output_types(connection.gz):
            return
        model, asked = match["model"].replace("/model/", "::"), match["link"]
        for sensor in self._sim.contents.sensors.values():
            link, _, name = sensor.scoped.removeprefix(f"{model}::").rpartition("::")
            topic = f"{match['before']}{link}/sensor/{match['rest']}"
            is_same = sensor.scoped.startswith(f"{model}::") and match["rest"].partition("/")[0] == name
            if is_same and self._output_types(topic) and asked in self._fixed_parents(model, link):
                connection.gz = topic
                if sensor.frame_id == sensor.scoped:
                    frame = f"{model}::{asked}::{name}".replace("::", "/")
                    self._sim.contents.set_sensor_frame(sensor.scoped, frame)
                return

    def _fixed_parents(self, model: str, link: str) -> set[str]:
        """Return the names of the links that fixed joints connect to a link, towards the root of the model."""
        joints = self._sim.model(model).scene.all_joints()
        parents = {joint.child_link: joint.parent_link for joint in joints if joint.type == "fixed"}
        found, scoped = set(), f"{model}::{link}"
        while scoped in parents and scoped not in found:
            found.add(scoped)
            scoped = parents[scoped]
        return {name.removeprefix(f"{model}::") for name in (*found, scoped)}

    def _use_ros_frame(self, topic: str) -> None:
        """Give the sensor of a topic the frame that Gazebo's bridge gives its messages: with / instead of ::."""
        for _, end, _, kind in list(self._sim.communication.bus.endpoints(topic)):
            sensor = end.owner
            if kind == "publishes" and isinstance(sensor, Sensor) and "::" in sensor.frame_id:
                self._sim.contents.set_sensor_frame(sensor.scoped, sensor.frame_id.replace("::", "/"))

    def _is_connected(self, connection: _Connection) -> bool:
        if connection.to_ros:
            self._use_merged_link(connection)
        try:
            if connection.gz == connection.ros:
                return self._is_same_topic(connection)
            if connection.to_ros:
                self._connect_to_ros(connection)
            if connection.to_gz:
                self._connect_to_gz(connection)
        except MessageError as error:
            self._fail(connection, str(error))
            return True
        return not (connection.to_ros or connection.to_gz) and all(
            self._has_source(connection, relay) for relay in connection.relays
        )

    def _is_same_topic(self, connection: _Connection) -> bool:
        """Check the types of a topic that has the same name on both sides."""
        inputs, ros_type = input_types(self._sim.communication.bus, connection.gz), connection.rule.ros_type
        outputs = self._output_types(connection.gz) if connection.to_ros else []
        if not (outputs or (inputs and connection.to_gz)):
            return False
        if outputs:
            self._use_ros_frame(connection.gz)
        if ros_type in (*outputs, *(inputs if connection.to_gz else ())):
            return True
        if connection.to_gz and any(conversion(ros_type, name) is not None for name in inputs):
            relay = self._sim.communication.relay_inputs(connection.gz, connection.gz, ros_type)
            self._keep(connection, relay)
            return True
        types = " or ".join(dict.fromkeys((*outputs, *inputs)))
        self._fail(connection, f"simkit has {types} there; remap the topic of ROS to another name")
        return True

    def _connect_to_ros(self, connection: _Connection) -> None:
        if _SENSOR_TOPIC.fullmatch(connection.gz) and not self._output_types(connection.gz):
            return  # the link may have another name here
        connection.to_ros = False
        if connection.ros == "/clock":
            return  # the simulation publishes it, and there must be one clock only
        relay = self._sim.communication.relay(connection.gz, connection.ros, connection.rule.ros_type)
        relay.publisher.node = self._node
        self._keep(connection, relay)

    def _connect_to_gz(self, connection: _Connection) -> None:
        """Connect a topic of ROS to one of Gazebo. It is a command input at once, and waits for those of the plugin."""
        is_both = connection.rule.direction == "BIDIRECTIONAL"
        inputs, ros_type = input_types(self._sim.communication.bus, connection.gz), connection.rule.ros_type
        if not connection.has_input and (inputs or not is_both):
            connection.has_input = True
            self._keep(connection, self._sim.communication.relay_inputs(connection.ros, connection.gz, ros_type))
        if not inputs:
            if is_both and self._output_types(connection.gz):
                connection.to_gz = False  # a topic of the simulation that takes nothing
            return
        connection.to_gz = False
        if not any(conversion(ros_type, name) is not None for name in inputs):
            self._fail(connection, f"simkit takes {' or '.join(inputs)} there")

    def _keep(self, connection: _Connection, relay: TopicRelay | InputRelay) -> None:
        connection.relays.append(relay)
        self._relays.append(relay)

    def _has_source(self, connection: _Connection, relay: TopicRelay | InputRelay) -> bool:
        """Check whether a relay to ROS has its topic of Gazebo, and whether the types fit."""
        if isinstance(relay, InputRelay) or relay.source != connection.gz:
            return True
        fault = relay.fault()
        if fault == NO_SOURCE:
            return connection.rule.direction == "BIDIRECTIONAL" and bool(
                input_types(self._sim.communication.bus, connection.gz)
            )
        self._use_ros_frame(connection.gz)
        if fault:
            self._fail(connection, f"simkit publishes {fault} there")
        return True

    def _output_types(self, topic: str) -> list[str]:
        """Return the types of what plugins and sensors publish on a topic."""
        ends = self._sim.communication.bus.endpoints(topic)
        return [types[0] for _, end, types, kind in ends if end.active and end.owner is not None and kind != "takes"]

    def _fail(self, connection: _Connection, reason: str) -> None:
        rule = connection.rule
        text = (
            f"Failed to create a bridge for topic [{connection.ros}] with ROS2 type [{rule.ros_type}] "
            f"to topic [{connection.gz}] with Gazebo Transport type [{rule.gz_type}]: {reason}"
        )
        self._report(text)
        self._sim.engine.reports.warning("SK-LAUNCH-061", f"{self._node}: {text}")
        connection.to_ros = connection.to_gz = False

    def add_service(self, node: GraphNode, name: str, target: str, type_name: str) -> None:
        """Offer a service of the simulation under a further name.

        Args:
            node: node of the bridge.
            name: absolute name in ROS.
            target: absolute name in Gazebo.
            type_name: service type.
        """
        services = self._sim.communication.services

        def answer() -> None:
            while (request := offered.take()) is not None:
                try:
                    call = services.request(target, request.message)
                    request.answer(call.response)
                except SimkitError as error:
                    request.fail(str(error))

        offered = node.offer(name, type_name, answer)

    def report_missing(self) -> None:
        """Report the topics of Gazebo that never came, with the closest names of those that are there."""
        missing = [connection.gz for connection in self._waiting]
        if not missing:
            return
        ends = self._sim.communication.bus.endpoints()
        topics = sorted({topic for topic, end, _, _ in ends if end.active and end.owner is not None} - set(missing))
        near = [f"{name}: {hint}" for name in missing if (hint := did_you_mean(name, topics))]
        text = f"{self._node}: no message came through the bridge for {', '.join(missing)}: {_NEVER}"
        self._sim.engine.reports.warning("SK-LAUNCH-062", text, hint="; ".join(near) or _NO_HINT)

    def close(self) -> None:
        """Close all relays."""
        while self._relays:
            self._relays.pop().close()
