"""Radios that measure their distances by the received power: `libRFRange.so` of the MBZIRC challenge.

Parameters, defaults and formulas follow `RFRange.cc` of osrf/mbzirc.
"""

from __future__ import annotations

from typing import TYPE_CHECKING, Any, Final, Self

from simkit import ModelPlugin, Params, WorldPlugin, msgs
from simkit.extend import Options, OptionsOf, block, number, publishes
from simkit.linear_algebra import norm
from simkit.msgs import valid_topic
from simkit_water_and_air.plugins.comms.signal_loss import RadioOptions, RangeOptions, read_channel

if TYPE_CHECKING:
    from simkit import Model, Simulation

_PARAMETERS: Final = "ros_gz_interfaces/msg/ParamVec"
_PAYLOAD: Final = 100  # bytes of a request
_FLOAT, _STRING = 3, 4  # types of a `rcl_interfaces/msg/ParameterValue`
_TOPIC: Final = "/world/{world}/model/{model}/rfsensor"


class RfRangeSensorOptions(Options):
    """Options of `RfRangeSensor` and `RfRange`."""

    reach: RangeOptions = block(RangeOptions, element="range_config")
    radio: RadioOptions = block(RadioOptions, element="radio_config")

    def read_all(self) -> Self:
        """Read all options, also those of the blocks, which the plugin uses later."""
        super().read_all()
        self.reach.read_all()
        self.radio.read_all()
        return self


class RfRangeSensor(ModelPlugin):
    """Is a radio on the model that contains its model; `RFRange` in the world measures the distances.

    The readings are on `/world/<world>/model/<robot>/model/<sensor>/rfsensor`. Its blocks replace those of the world
    for all radios, if it is the first one with blocks.
    """

    endpoints = (publishes(_TOPIC, _PARAMETERS),)
    options = OptionsOf(RfRangeSensorOptions)
    names = ("gz::sim::systems::RFRangeSensor",)

    def load(self, parent: Model, params: Params) -> None:
        self.settings = self.options.read_all()
        names = parent.scoped.split("::")
        self.robot = self.sim.model("::".join(names[:-1]) if len(names) > 1 else names[0])
        path = "".join(f"/model/{name}" for name in names)
        self.output = self.advertise(valid_topic(f"/world/{self.sim.world.name}{path}/rfsensor"), _PARAMETERS)


class RfRangeOptions(RfRangeSensorOptions):
    """Options of `RfRange`."""

    rate: float = number(1.0, "Hz", element="update_rate", minimum=0.0, maximum=1e9)


class RfRange(WorldPlugin):
    """Publishes for each radio the others that answer: `model`, `range` [m] and `rssi` [dBm], at `<update_rate>`."""

    options = OptionsOf(RfRangeOptions)
    names = ("gz::sim::systems::RFRange",)

    def load(self, parent: Simulation, params: Params) -> None:
        options = self.options.read_all()
        self.after_step_rate = options.rate or None
        self._fading, self._loss, self._index = self.random("fading"), self.random("loss"), 0

    def after_step(self) -> None:
        """Measure and publish all distances."""
        plugins = self.sim.engine.structure.all_plugins()
        radios = {plugin.robot.scoped: plugin for plugin in plugins if isinstance(plugin, RfRangeSensor)}
        given = [r.settings for r in radios.values() if r.settings.reach.is_given or r.settings.radio.is_given]
        settings: Any = self.options
        reach = next((s.reach for s in given if s.reach.is_given), settings.reach)
        radio = next((s.radio for s in given if s.radio.is_given), settings.radio)
        channel = read_channel(reach, radio)
        for name, sensor in radios.items():
            answers: list[dict[str, object]] = []
            for other, target in radios.items():
                if other == name:
                    continue
                distance = norm(sensor.robot.pose.position - target.robot.pose.position)
                power = channel.received_power(distance, self._fade(channel.sigma))
                uniform = 0.5 + 0.5 * float(self._loss.uniform(self._index)[0])
                self._index += 1
                if uniform > channel.loss_probability(power, _PAYLOAD):
                    measured = 10.0 ** ((reach.rssi_1 - power) / (10.0 * max(channel.exponent, 1e-9)))
                    answers += _answer(target.robot.name, measured, power)
            if answers and sensor.output.wanted:
                header = msgs.header(self.sim.time_ns, "")
                sensor.output.publish(msgs.make(_PARAMETERS, header=header, params=answers))

    def _fade(self, sigma: float) -> float:
        """Return a normal number; here `<sigma>` is the variance, as in the source."""
        drawn = float(self._fading.normal(self._index)[0])
        return drawn / sigma**0.5 if sigma > 0 else 0.0


def _answer(model: str, distance: float, power: float) -> list[dict[str, object]]:
    return [
        {"name": "model", "value": {"type": _STRING, "string_value": model}},
        {"name": "range", "value": {"type": _FLOAT, "double_value": distance}},
        {"name": "rssi", "value": {"type": _FLOAT, "double_value": power}},
    ]
