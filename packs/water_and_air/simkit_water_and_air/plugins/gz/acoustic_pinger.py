"""Receiver of an acoustic pinger: `vrx::AcousticPingerPlugin` of VRX.

Parameters, defaults and formulas are those of `AcousticPingerPlugin.cc`.
"""

from __future__ import annotations

import math
from typing import TYPE_CHECKING, Final

from simkit import ModelPlugin, Params, msgs
from simkit.extend import NoiseModel, Options, OptionsOf, listens, number, publishes, read_noise, text, vector3
from simkit.msgs import valid_topic
from simkit.plugins.one_time_warnings import are_usable

if TYPE_CHECKING:
    from simkit import Model
    from simkit.msgs import Message

_PARAMETERS: Final = "ros_gz_interfaces/msg/ParamVec"
_VECTOR: Final = "geometry_msgs/msg/Vector3"
_FLOAT: Final = 3  # type of a `rcl_interfaces/msg/ParameterValue`
_READINGS: Final = ("range", "bearing", "elevation")


class AcousticPingerOptions(Options):
    """Options of `AcousticPinger`."""

    frame: str = text("pinger", element="frame_id")
    topic: str = text("/pinger/range_bearing")
    position_topic: str = text("/pinger/set_pinger_position", element="set_position_topic")
    position: tuple[float, float, float] = vector3(unit="m")
    rate: float = number(1.0, "Hz", element="update_rate", minimum=1e-6, maximum=1e9)


class AcousticPinger(ModelPlugin):
    """Measures range [m], bearing and elevation [rad] from its model to a pinger at `<position>` in the world.

    They are the parameters `range`, `bearing` and `elevation` of the messages on `<topic>`. `<range_noise>`,
    `<bearing_noise>` and `<elevation_noise>` contain a `<noise>`. A message on `<set_position_topic>` moves the pinger.
    """

    endpoints = (
        publishes("/pinger/range_bearing", _PARAMETERS, named_by=("topic",)),
        listens("/pinger/set_pinger_position", _VECTOR, named_by=("set_position_topic",)),
    )
    options = OptionsOf(AcousticPingerOptions)
    filenames = ("libAcousticPingerPlugin.so",)
    names = ("vrx::AcousticPingerPlugin",)

    def load(self, parent: Model, params: Params) -> None:
        options = self.options.read_all()
        self._model, self._position = parent, options.position
        models = [read_noise(params.block(f"{name}_noise")) for name in _READINGS]
        drawn = self.random("bias", 3).normal(0).tolist()
        self._noises = [
            (model, model.mean + model.bias_mean + model.bias_stddev * bias)
            for model, bias in zip(models, drawn, strict=True)
        ]
        self._stream, self._count, self._last = self.random("noise", 3), 0, 0.0
        self._output = self.advertise(valid_topic("/" + options.topic.strip().strip("/")), _PARAMETERS)
        self.listen(valid_topic("/" + options.position_topic.strip().strip("/")), _VECTOR, self._on_position)

    def _on_position(self, message: Message) -> None:
        position = float(message.x), float(message.y), float(message.z)
        if are_usable(*position):
            self._position = position

    def before_step(self) -> None:
        """Measure, if a reading is due."""
        if self.sim.time - self._last < 1.0 / self.options.rate - 1e-9:
            return
        self._last = self.sim.time
        x, y, z = self._model.pose.inverse().transform(self._position).tolist()
        flat = math.sqrt(x * x + y * y)
        true = math.sqrt(x * x + y * y + z * z), math.atan2(y, x), math.atan2(z, flat)
        drawn = self._stream.normal(self._count).tolist()
        self._count += 1
        values = [_noisy(value, *noise, d) for value, noise, d in zip(true, self._noises, drawn, strict=True)]
        listed = [
            {"name": name, "value": {"type": _FLOAT, "double_value": value}}
            for name, value in sorted(zip(_READINGS, values, strict=True))
        ]
        header = msgs.header(self.sim.time_ns, self.options.frame)
        self._output.publish(msgs.make(_PARAMETERS, header=header, params=listed))


def _noisy(value: float, model: NoiseModel, offset: float, drawn: float) -> float:
    value += offset + model.stddev * drawn
    return round(value / model.precision) * model.precision if model.precision > 0 else value
