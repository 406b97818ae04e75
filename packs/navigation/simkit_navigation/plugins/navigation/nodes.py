"""Interfaces of the navigation servers for the classes that do a part of their work."""

from __future__ import annotations

from collections.abc import Callable
from typing import TYPE_CHECKING, Any, Protocol

if TYPE_CHECKING:
    from simkit import Simulation
    from simkit.msgs import Message
    from simkit.runtime.communication.publisher import Publisher
    from simkit.runtime.communication.subscription import Subscription
    from simkit.topic_logger import TopicLogger
    from simkit_navigation.plugins.navigation.cost_grid import Cells
    from simkit_navigation.plugins.navigation.footprint import Footprint


class Node(Protocol):
    """Plugin of a server.

    Attributes:
        sim: simulation.
        log: logger of the plugin.
    """

    sim: Simulation
    log: TopicLogger

    def subscribe(
        self, topic: str, callback: Callable[[Message], None] | None = None, keep: int | None = None
    ) -> Subscription:
        """Receive each message on a topic; see `Plugin.subscribe`."""

    def receive(self, topic: str, type_name: str, parameter: str, callback: Callable[[Message], None]) -> Subscription:
        """Receive the messages of a type on a topic; see `ServerPlugin.receive`."""

    def advertise(self, topic: str, type_name: str, *, latched: bool = False) -> Publisher:
        """Open a publisher; see `Plugin.advertise`."""

    def offer(self, name: str, type_name: str, callback: Callable[[Any], Any]) -> None:
        """Offer a service; see `Plugin.offer`."""


class CostmapNode(Node, Protocol):
    """Plugin of a costmap.

    Attributes:
        footprint: outline of the robot.
        inscribed_radius: largest radius around the robot's origin within its outline [m].
        default_cost: cost of unknown cells.
        lethal_cost_threshold: smallest occupancy of an obstacle in a map.
        map_costs: cost by occupancy of a map as an unsigned byte, shape (256,).
        uses_maximum: True if the map does not lower the costs of the layers before it.
        is_rolling: True if the costmap moves with the robot.
    """

    footprint: Footprint
    inscribed_radius: float
    default_cost: int
    lethal_cost_threshold: int
    map_costs: Cells
    uses_maximum: bool
    is_rolling: bool

    def report_once(self, cause: str, message: str) -> None:
        """Warn about a sensor, a mask or a parameter that cannot be used, once for each cause."""


class ControllerNode(Node, Protocol):
    """Plugin of a controller.

    Attributes:
        controller_frequency: rate of the commands [Hz].
        footprint: outline of the robot.
        is_at_goal_position: True if the position of the goal is reached, and only the yaw may still differ.
    """

    controller_frequency: float
    footprint: Footprint
    is_at_goal_position: bool
