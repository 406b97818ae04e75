"""Description of a publisher or a subscription."""

from __future__ import annotations

from dataclasses import dataclass, field
from enum import IntEnum

from simkit_nodes.ros_modules.rclpy.qos import HistoryPolicy, QoSProfile, qos_profile_unknown

__all__ = ["TopicEndpointInfo", "TopicEndpointTypeEnum"]


class TopicEndpointTypeEnum(IntEnum):
    """Kind of an endpoint."""

    INVALID = 0
    PUBLISHER = 1
    SUBSCRIPTION = 2


@dataclass(kw_only=True)
class TopicEndpointInfo:
    """Publisher or subscription of a topic.

    Attributes:
        node_name: name of its node, without the namespace.
        node_namespace: namespace of its node.
        topic_type: type of the messages.
        topic_type_hash: hash of the type; empty.
        endpoint_type: publisher or subscription.
        endpoint_gid: 16 numbers that distinguish it from all others.
        qos_profile: quality of service.
    """

    node_name: str = ""
    node_namespace: str = ""
    topic_type: str = ""
    topic_type_hash: str = ""
    endpoint_type: TopicEndpointTypeEnum = TopicEndpointTypeEnum.INVALID
    endpoint_gid: list[int] = field(default_factory=list)
    qos_profile: QoSProfile = field(default_factory=lambda: qos_profile_unknown)

    def __str__(self) -> str:
        qos = self.qos_profile
        depth = f" ({qos.depth})" if qos.history == HistoryPolicy.KEEP_LAST else ""
        lines = (
            f"Node name: {self.node_name}",
            f"Node namespace: {self.node_namespace}",
            f"Topic type: {self.topic_type}",
            f"Topic type hash: {self.topic_type_hash or 'INVALID'}",
            f"Endpoint type: {self.endpoint_type.name}",
            f"GID: {'.'.join(f'{number:02x}' for number in self.endpoint_gid)}",
            "QoS profile:",
            f"  Reliability: {qos.reliability.name}",
            f"  History (Depth): {qos.history.name}{depth}",
            f"  Durability: {qos.durability.name}",
            f"  Lifespan: {qos.lifespan}",
            f"  Deadline: {qos.deadline}",
            f"  Liveliness: {qos.liveliness.name}",
            f"  Liveliness lease duration: {qos.liveliness_lease_duration}",
        )
        return "\n".join(lines)
