"""Interface of the controller server for its controllers."""

from __future__ import annotations

from collections.abc import Mapping
from typing import TYPE_CHECKING, Any, Protocol

from simkit_navigation.plugins.navigation.server_interface import Node

if TYPE_CHECKING:
    from simkit import Params
    from simkit_navigation.plugins.costmaps.footprint import Footprint
    from simkit_navigation.plugins.navigation.planar_pose import Floats


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
