"""Interfaces of the navigation servers for the classes that do a part of their work."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from typing import TYPE_CHECKING, Any, Protocol

if TYPE_CHECKING:
    from simkit import Params, Simulation
    from simkit.msgs import Message
    from simkit.runtime.communication.publisher import Publisher
    from simkit.runtime.communication.subscription import Subscription
    from simkit.topic_logger import TopicLogger
    from simkit_navigation.plugins.navigation.cost_grid import Cells
    from simkit_navigation.plugins.navigation.footprint import Footprint
    from simkit_navigation.plugins.navigation.planar_pose import Floats


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
        goal_tolerance: distance at which the position of the goal is reached [m].
        lateral_speed: measured speed to the left [m/s]; 0 for a robot that does not move sideways.
        tracks_unknown_space: True if the costmap has unknown cells, which are then no obstacles.
        cost_scaling_factor: decay of the costs of the costmap's inflation layer [1/m].
        inflation_radius: distance from an obstacle up to which that layer has costs [m].
    """

    controller_frequency: float
    footprint: Footprint
    is_at_goal_position: bool
    goal_tolerance: float
    lateral_speed: float
    tracks_unknown_space: bool
    cost_scaling_factor: float
    inflation_radius: float

    def random(self, channel: str, width: int = 1) -> Any:
        """Return a random stream; see `Plugin.random`."""

    def find_class(self, name: str, wanted: str, block: Params, known: Mapping[str, type[Any]]) -> type[Any] | None:
        """Return a class of a user or of simkit; see `ServerPlugin.find_class`."""

    def wants_path(self, topic: str) -> bool:
        """Check whether a topic of paths has subscribers."""

    def publish_path(self, topic: str, poses: Floats) -> None:
        """Publish poses in the frame of the path, shape (n, 3), if the topic has subscribers."""

    def publish_point(self, topic: str, point: Floats) -> None:
        """Publish a point in the frame of the path, shape (1, 2), if the topic has subscribers."""

    def wants_markers(self, topic: str) -> bool:
        """Check whether a topic of markers has subscribers."""

    def publish_markers(self, topic: str, markers: list[dict[str, Any]]) -> None:
        """Publish the fields of markers whose poses are in the frame of the path."""
