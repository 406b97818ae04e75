"""Master of ROS 1, as far as the communication graph can answer for it."""

from __future__ import annotations

from collections.abc import Iterator
from typing import Any

from simkit_nodes.ros1_modules.rospy import client
from simkit_nodes.ros1_modules.rospy.ros_node import ros_node

__all__ = ["MasterProxy", "get_master"]

_Answer = tuple[int, str, Any]  # code (1 for success), text, value


class MasterProxy:
    """Questions for the master; its items are the parameters."""

    target = property(lambda self: self)

    def getPublishedTopics(self, subgraph: str = "/") -> _Answer:
        """Return the published topics and their types."""
        return 1, "current topics", client.get_published_topics(subgraph or "/")

    def getTopicTypes(self) -> _Answer:
        """Return the types of all topics."""
        topics = ros_node().host.graph.topics()
        return 1, "current system state", [[name, kinds[0].replace("/msg/", "/")] for name, kinds in topics.items()]

    def getSystemState(self) -> _Answer:
        """Return the publishers and subscribers of each topic, and the services."""
        graph = ros_node().host.graph
        publishers = [[topic, [end.node for end in graph.publishers(topic)]] for topic in graph.topics()]
        subscribers = [[topic, [end.node for end in graph.subscriptions(topic)]] for topic in graph.topics()]
        services = [[name, []] for name in graph.services()]
        state = [[item for item in items if item[1]] for items in (publishers, subscribers)]
        return 1, "current system state", [*state, services]

    def getParamNames(self) -> _Answer:
        """Return the names of all parameters."""
        return 1, "Parameter names", client.get_param_names()

    def getPid(self) -> _Answer:
        """Return a process identifier; the master is no process of its own."""
        return 1, "", 1

    def search_param(self, key: str) -> str | None:
        """Return the global name of a parameter in the innermost namespace around the node that has it."""
        return client.search_param(key)

    def __getitem__(self, key: str) -> Any:
        return client.get_param(key)

    def __setitem__(self, key: str, val: object) -> None:
        client.set_param(key, val)

    def __delitem__(self, key: str) -> None:
        client.delete_param(key)

    def __contains__(self, key: str) -> bool:
        return client.has_param(key)

    def __iter__(self) -> Iterator[str]:
        return iter(client.get_param_names())


def get_master(env: object = None) -> MasterProxy:
    """Return the master of the programs."""
    return MasterProxy()
