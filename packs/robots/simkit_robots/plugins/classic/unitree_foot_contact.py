"""Foot contact of Unitree's quadrupeds in Gazebo Classic: `libunitreeFootContactPlugin.so`.

The topic, the mean over the contacts and the axes of the force are those of `foot_contact_plugin.cc` in unitree_ros.
One deliberate difference: the header has the time and the frame of the link; Unitree's plugin leaves it empty.
"""

from __future__ import annotations

from typing import TYPE_CHECKING, Any, Final

import numpy as np

from simkit import Params, SensorPlugin, msgs
from simkit.extend import publish_while_subscribed, publishes
from simkit.float_sum import float_sum
from simkit.linear_algebra import matmul
from simkit.plugins.find_entities import link_name

if TYPE_CHECKING:
    from simkit.pose import Vector

_WRENCH: Final = "geometry_msgs/msg/WrenchStamped"
_TOPIC: Final = "/visual/{}/the_force"


class UnitreeFootContact(SensorPlugin):
    """Publishes the contact force of a foot on `/visual/<sensor>/the_force`, at the rate of its contact sensor.

    The force [N] on the foot is the mean over the surfaces that it touches, in the axes of the sensor's link. Without a
    contact the force is zero. The torque is always zero.
    """

    filenames = ("libunitreeFootContactPlugin.so",)
    endpoints = (publishes(_TOPIC.format("{sensor}"), _WRENCH),)
    only_publishes = True

    def load(self, parent: Any, params: Params) -> None:
        if not hasattr(parent, "publish_states"):
            self.refuse(parent, "contact")
            return
        self._sensor = parent
        self._out = self.advertise(_TOPIC.format(parent.name), _WRENCH)
        publish_while_subscribed(self, self._out, max(0.0, parent.scene.rate), "publish")

    def force(self) -> Vector:
        """Return the force on the foot in the axes of its link [N], shape (3,)."""
        sensor = self._sensor
        pairs = sensor.measure(self.sim.mj_model, sensor.computed_data()).pairs
        mean = [
            float_sum(force for pair in pairs for force in pair.forces[:, axis].tolist()) / max(1, len(pairs))
            for axis in range(3)
        ]
        force: Vector = matmul(self.sim.link(sensor.scene.parent).pose.matrix.T, np.array(mean))
        return force

    def publish(self) -> None:
        """Publish the present force."""
        x, y, z = self.force().tolist()
        header = msgs.header(self.sim.time_ns, link_name(self._sensor))
        wrench = msgs.make("geometry_msgs/msg/Wrench", force=msgs.make("geometry_msgs/msg/Vector3", x=x, y=y, z=z))
        self._out.publish(msgs.make(_WRENCH, header=header, wrench=wrench))
