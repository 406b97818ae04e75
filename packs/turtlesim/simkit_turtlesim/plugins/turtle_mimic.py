"""Plugin that drives one turtle like another one, as turtlesim's node `mimic`."""

from __future__ import annotations

from typing import TYPE_CHECKING, Final

from simkit import Plugin, msgs
from simkit.extend import listens, publishes

if TYPE_CHECKING:
    from simkit import Model, Params, Simulation

_POSE: Final = "turtlesim/msg/Pose"
_TWIST: Final = "geometry_msgs/msg/Twist"


class TurtleMimic(Plugin):
    """Publishes the velocities of each pose on `input/pose` as a command on `output/cmd_vel`.

    Names and types are those of turtlesim's node `mimic`. Remappings choose the two turtles.
    """

    filenames = ("libsimkit_turtle_mimic.so",)
    names = ("simkit::TurtleMimic",)
    parent_kind = ("world", "model")
    endpoints = (listens("input/pose", _POSE), publishes("output/cmd_vel", _TWIST))

    def load(self, parent: Simulation | Model, params: Params) -> None:
        self._command = self.advertise("output/cmd_vel", _TWIST)
        self.subscribe("input/pose", self._on_pose)

    def _on_pose(self, message: msgs.turtlesim__msg__Pose) -> None:
        if self._once.has_type(message, _POSE, "remapping"):
            speeds = {"x": message.linear_velocity}, {"z": message.angular_velocity}
            self._command.publish(msgs.make(_TWIST, linear=speeds[0], angular=speeds[1]))
