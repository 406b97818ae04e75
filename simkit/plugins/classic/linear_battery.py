"""Battery and battery consumers of Gazebo Classic: `libLinearBatteryPlugin.so`, `libLinearBatteryConsumerPlugin.so`."""

from __future__ import annotations

from typing import TYPE_CHECKING

from simkit.diagnostics import did_you_mean
from simkit.params import Params
from simkit.plugins.battery import Battery, BatteryConsumer, BatteryOptions, Cell
from simkit.plugins.find_entities import find_named_link, read_required_name
from simkit.plugins.options import Options, OptionsOf, number, text

if TYPE_CHECKING:
    from simkit.compiler import SpecBuilder
    from simkit.runtime import Model
    from simkit.scene import SceneModel


class ClassicLinearBatteryOptions(BatteryOptions):
    """Options of `ClassicLinearBattery`."""

    link_name: str = text(required=True)
    initial_charge: float = number(0.0, minimum=0.0)
    smooth_current_tau: float = number(0.0, minimum=0.0)


class ClassicLinearBattery(Battery):
    """Drains a battery from the start, by the equations of gz's linear battery; an empty battery has no effect.

    In Classic only other plugins can read the battery. simkit also publishes the battery's state, as for gz's battery.
    """

    options = OptionsOf(ClassicLinearBatteryOptions)
    filenames = ("libLinearBatteryPlugin.so",)

    def prepare(self, scene: SceneModel, params: Params, builder: SpecBuilder) -> None:
        find_named_link(scene, "link_name", params)
        self.battery = read_required_name(params, "battery_name")
        options = self.options
        capacity, charge = options.capacity or 1.0, options.initial_charge
        constant, linear = options.open_circuit_voltage_constant_coef, options.open_circuit_voltage_linear_coef
        resistance, tau = options.resistance, options.smooth_current_tau
        voltage = constant + linear * (1.0 - charge / capacity)
        self.cell = Cell(constant, linear, capacity, resistance, tau, voltage, charge)

    def load(self, parent: Model, params: Params) -> None:
        self.is_drained = True
        self.open_state(parent.name)


class LinearBatteryConsumerOptions(Options):
    """Options of `LinearBatteryConsumer`."""

    link_name: str = text(required=True)
    battery_name: str = text(required=True)


class LinearBatteryConsumer(BatteryConsumer):
    """Draws power from a battery of its model, which may be a plugin of Classic or of gz."""

    options = OptionsOf(LinearBatteryConsumerOptions)
    filenames = ("libLinearBatteryConsumerPlugin.so",)

    def prepare(self, scene: SceneModel, params: Params, builder: SpecBuilder) -> None:
        find_named_link(scene, "link_name", params)
        self.battery = read_required_name(params, "battery_name")

    def load(self, parent: Model, params: Params) -> None:
        self._power = self.declare("power_load", 0.0, description="power drawn from the battery [W]")
        plugins = [p for p in self.sim.engine.structure.all_plugins() if isinstance(p, Battery)]
        batteries = [p.battery for p in plugins if p.scoped == self.scoped]
        if self.battery and self.battery not in batteries:
            message = f"plugin {self.name!r}: its model has no battery {self.battery!r}; no power is drawn"
            params.diagnostics.warning("SK-PLUGIN-123", message, self.where, did_you_mean(self.battery, batteries))

    @property
    def power(self) -> float:
        return float(self._power.value)
