"""Wind and sheets of sails of asv_sim: `asv_sim2-wind-system`, `asv_sim2-sail-position-controller-system`.

Parameters and formulas are those of `Wind.cc`, `Anemometer.cc` and `SailPositionController.cc`.
"""

from __future__ import annotations

import math
from typing import TYPE_CHECKING, Final

from simkit import Params, WorldPlugin
from simkit.extend import Options, OptionsOf, listens, text
from simkit.msgs import valid_topic
from simkit.plugins.joints.joint_commands import DOUBLE, JointCommander, JointCommandOptions
from simkit.plugins.joints.pid import Pid
from simkit.plugins.one_time_warnings import are_usable
from simkit_water_and_air.plugins.fluids.wind_effects import WindPluginBase

if TYPE_CHECKING:
    from simkit import Model, Simulation
    from simkit.extend import SceneModel, SpecBuilder
    from simkit.msgs import Vector3

_VECTOR: Final = "geometry_msgs/msg/Vector3"


class AsvWindOptions(Options):
    """Options of `AsvWind`."""

    topic: str = text()


class AsvWind(WorldPlugin):
    """Sets the wind of the world [m/s] by `Vector3` messages on `<topic>` (`/world/<world>/wind`)."""

    endpoints = (listens("/world/{world}/wind", _VECTOR, named_by=("topic",)),)
    options = OptionsOf(AsvWindOptions)
    filenames = ("asv_sim2-wind-system", "asv_sim-wind-system")

    def load(self, parent: Simulation, params: Params) -> None:
        x, y, z = parent.world.wind
        self._wind = float(x), float(y), float(z)
        if parent.engine.wind.source is None:
            parent.engine.wind.source = self.velocity
        self.listen(valid_topic(self.options.topic or f"/world/{parent.world.name}/wind"), _VECTOR, self._on_wind)

    def velocity(self, tick: int) -> tuple[float, float, float]:
        """Return the velocity of the air [m/s] in the world frame, during the step after a tick."""
        return self._wind

    def _on_wind(self, message: Vector3) -> None:
        wind = float(message.x), float(message.y), float(message.z)
        if not are_usable(*wind):
            self._once.not_finite("a wind")
            return
        plugins = self.sim.engine.structure.all_plugins()
        for plugin in plugins:
            if isinstance(plugin, WindPluginBase):  # its gusts blow around the new wind
                plugin.set_wind(message)
        for sensor in self.sim.engine.structure.all_sensors():
            sensor.take_held()  # pending readings belong to the old wind
        self._wind = wind


class AsvAnemometerSystem(WorldPlugin):
    """Has no effect: the sensors of the kind `anemometer` work without it."""

    options = OptionsOf(Options)
    filenames = ("asv_sim2-anemometer-system", "asv_sim-anemometer-system")

    def load(self, parent: Simulation, params: Params) -> None:
        self.options.read_all()


class SailPositionController(JointCommander):
    """Limits the angle of a sail [rad] by its sheet, which only pulls: the wind sets the angle below the command.

    A PID on the angle of the first joint computes the effort; an effort that would push the sail out is zero. Commands
    are read from `/model/<model>/joint/<joint>/cmd_pos`, from `<sub_topic>` below the model's topics, or from
    `<topic>`.
    """

    endpoints = (listens("/model/{model}/joint/{joint_name}/cmd_pos", DOUBLE, named_by=("topic", "sub_topic")),)
    options = OptionsOf(JointCommandOptions)
    filenames = ("asv_sim2-sail-position-controller-system", "asv_sim-sail-position-controller-system")
    names = ("gz::sim::systems::SailPositionController",)
    actuator_field = "position"
    target_element = "initial_position"

    def prepare(self, scene: SceneModel, params: Params, builder: SpecBuilder) -> None:
        super().prepare(scene, params, builder)
        self.own_topic = f"joint/{self._first_name}/cmd_pos"

    def load(self, parent: Model, params: Params) -> None:
        super().load(parent, params)
        self.declare_controller(Pid(1.0, 0.1, 0.01, 1.0, -1.0, 1000.0, -1000.0))

    def command(self) -> None:
        position = self.axes[0].position
        side = math.copysign(1.0, position) if position else 1.0
        assert self._pid is not None
        effort = self._pid.update(position - side * self._target, self.period)
        for axis in self.axes:
            axis.push(effort if effort * side < 0.0 else 0.0)
