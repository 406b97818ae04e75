"""Bumper of Gazebo Classic: `libgazebo_ros_bumper.so`, with its ROS 2 and its ROS 1 spelling."""

from __future__ import annotations

from typing import TYPE_CHECKING

from simkit.diagnostics import did_you_mean
from simkit.params import Params
from simkit.plugins.base import SensorPlugin
from simkit.plugins.endpoints import publishes
from simkit.plugins.find_entities import SensorFrameOptions
from simkit.plugins.options import OptionsOf, text, without_effect

if TYPE_CHECKING:
    from simkit.sensors.devices.contact import Contact


class GazeboRosBumperOptions(SensorFrameOptions):
    """Options of `GazeboRosBumper`."""

    bumper_topic_name: str = text(element="bumperTopicName")
    always_on: bool = without_effect(element="alwaysOn")


class GazeboRosBumper(SensorPlugin):
    """Publishes the contacts of its sensor on `bumper_states` at the sensor's rate, even if the list is empty.

    Positions, normals and wrenches are in the frame of the link `<frame_name>` (ROS 1: `<frameName>`), or in the world.
    """

    endpoints = (publishes("bumper_states", "gazebo_msgs/msg/ContactsState", named_by=("bumperTopicName",)),)
    options = OptionsOf(GazeboRosBumperOptions)
    filenames = ("libgazebo_ros_bumper.so",)

    def load(self, parent: Contact, params: Params) -> None:
        topic = self.ros.topic(self.options.bumper_topic_name or "bumper_states")
        frame = self.options.frame_name or "world"
        _ = self.options.always_on
        if not hasattr(parent, "publish_states"):
            self.refuse(parent, "contact")
            return
        if not parent.publish_states(topic, frame):
            links = [scoped.rsplit("::", 1)[-1] for scoped in self.sim.engine.names.links]
            message = f"plugin {self.name!r}: there is no link {frame!r}; contacts use the world frame until it exists"
            params.diagnostics.warning("SK-SENSOR-042", message, self.where, did_you_mean(frame, links))
