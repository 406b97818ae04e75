"""Interface of a plugin that executes behaviour trees."""

from __future__ import annotations

from collections.abc import Mapping
from typing import TYPE_CHECKING, Any, Protocol

from simkit_navigation.plugins.navigation.planar_pose import PlanarPose

if TYPE_CHECKING:
    from simkit.extend import GoalHandle


class PendingCall(Protocol):
    """Call of a service.

    Attributes:
        is_done: True if there is a response or an error.
        response: response; None before the end, and after an error.
        error: error of the service; None without one.
    """

    is_done: bool
    response: Any
    error: Any


class Navigator(Protocol):
    """Plugin that executes trees."""

    @property
    def time_ns(self) -> int:
        """Time of the simulation [ns]."""

    def tree_option(self, name: str, default: object) -> Any:
        """Return an option of the navigator."""

    def look_up(self, target: str, source: str) -> PlanarPose | None:
        """Return the pose of the frame `source` in the frame `target`; None if it is not known."""

    def open_topic(self, topic: str, type_name: str) -> None:
        """Keep the two newest messages of a topic from now on."""

    def newest(self, topic: str) -> tuple[Any, Any]:
        """Return the message before the newest one, and the newest one; None for those that are missing."""

    def send_goal(self, action: str, request: Mapping[str, object]) -> GoalHandle:
        """Send a goal; raise TreeError if there is no such action."""

    def call_service(self, service: str, request: Mapping[str, object]) -> PendingCall:
        """Call a service; raise TreeError if there is no such service."""

    def warn_once(self, cause: str, text: str) -> None:
        """Report a warning once for each cause."""
