"""Publisher of velocities, with or without a header, as Nav2's parameter `enable_stamped_cmd_vel` selects."""

from __future__ import annotations

from typing import TYPE_CHECKING, Final

from simkit import Plugin, msgs
from simkit.extend import SharedByCopies

if TYPE_CHECKING:
    from simkit import Publisher

_TWIST: Final = "geometry_msgs/msg/Twist"
_STAMPED: Final = "geometry_msgs/msg/TwistStamped"


class VelocityCommand(SharedByCopies):
    """Publisher on `cmd_vel`.

    Args:
        plugin: plugin that publishes.
        frame: frame of the robot; None for messages without a header.
    """

    def __init__(self, plugin: Plugin, frame: str | None) -> None:
        self._plugin, self._frame = plugin, frame
        self._publisher: Publisher = plugin.advertise("cmd_vel", _TWIST if frame is None else _STAMPED)

    def publish(self, speeds: tuple[float, ...]) -> None:
        """Publish a forward speed [m/s] and a turning rate [rad/s]; of three, the second is to the left [m/s]."""
        forward, *aside, rate = speeds
        twist = {"linear": {"x": forward, "y": aside[0] if aside else 0.0}, "angular": {"z": rate}}
        if self._frame is None:
            self._publisher.publish(msgs.make(_TWIST, **twist))
        else:
            header = msgs.header(self._plugin.sim.time_ns, self._frame)
            self._publisher.publish(msgs.make(_STAMPED, header=header, twist=twist))
