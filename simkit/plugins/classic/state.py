"""Gazebo Classic's states and properties of a world where a file names them: gazebo_ros_state, _properties."""

from __future__ import annotations

from typing import TYPE_CHECKING

from simkit.params import Params
from simkit.plugins.base import WorldPlugin
from simkit.plugins.classic.server_services import broadcast_states, offer_table, property_services, state_services
from simkit.plugins.classic.state_services import STATES_RATE
from simkit.plugins.endpoints import offers, offers_all
from simkit.plugins.options import Options, OptionsOf, number

if TYPE_CHECKING:
    from simkit.runtime import Simulation


class GazeboRosStateOptions(Options):
    """Options of `GazeboRosState`."""

    update_rate: float = number(STATES_RATE, "Hz", minimum=0.0)


class GazeboRosState(WorldPlugin):
    """Publishes `model_states` and `link_states`, and offers `get_entity_state`, `set_entity_state` and the rest.

    All in its own `<ros><namespace>`. `<update_rate>` [Hz] is 100 where it is not given; of 0 it is every step.
    """

    options = OptionsOf(GazeboRosStateOptions)
    endpoints = (
        *offers_all("gazebo_msgs", "GetEntityState", "SetEntityState"),
        offers("set_joint_positions", "gazebo_msgs/srv/SetModelConfiguration"),
    )
    filenames = ("libgazebo_ros_state.so",)

    def load(self, parent: Simulation, params: Params) -> None:
        rate = self.options.update_rate
        offer_table("", self.sim, state_services(self.sim), named=self.ros.topic)
        models, links = self.ros.topic("model_states"), self.ros.topic("link_states")
        broadcast_states(self.sim, models, links, rate, is_aside=False)


class GazeboRosProperties(WorldPlugin):
    """Offers `get_model_properties`, `get_physics_properties` and the rest in its own `<ros><namespace>`."""

    filenames = ("libgazebo_ros_properties.so",)
    endpoints = offers_all(
        "gazebo_msgs",
        *("GetWorldProperties", "GetModelProperties", "GetJointProperties", "SetJointProperties", "GetLinkProperties"),
        *("GetLightProperties", "SetLightProperties", "GetPhysicsProperties", "SetPhysicsProperties"),
    )

    def load(self, parent: Simulation, params: Params) -> None:
        offer_table("", self.sim, property_services(self.sim), named=self.ros.topic)
