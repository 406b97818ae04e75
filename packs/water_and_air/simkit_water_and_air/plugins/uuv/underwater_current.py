"""Current of the water: `libuuv_underwater_current_ros_plugin.so` of uuv_simulator.

Parameters, defaults, topics and services are those of `UnderwaterCurrentPlugin.cc`, `UnderwaterCurrentROSPlugin.cc` and
`GaussMarkovProcess.cc`. Speed and the two angles are each a Gauss-Markov process in the interval from `min` to `max`:

    x ← (1 - mu · step) · x + noiseAmp · r,    r uniform within ±1/2
"""

from __future__ import annotations

import math
from dataclasses import dataclass, replace
from functools import partial
from typing import TYPE_CHECKING, Any, ClassVar, Final

from simkit import Params, WorldPlugin
from simkit.extend import Options, OptionsOf, block, number, offers, publishes, text
from simkit_water_and_air.plugins.fluids.water_current import TWIST, current_message

if TYPE_CHECKING:
    from simkit import Simulation
    from simkit.msgs import Message

_TYPES: Final = "uuv_world_ros_plugins_msgs"
_PERIOD: Final = 0.05  # between two messages [s]
_MODELS: Final = ("velocity", "horz_angle", "vert_angle")


class GaussMarkovOptions(Options):
    """Options of one process."""

    mean: float = number(0.0, minimum=-1e6, maximum=1e6)
    low: float = number(-1.0, element="min", minimum=-1e6, maximum=1e6)
    high: float = number(1.0, element="max", minimum=-1e6, maximum=1e6)
    mu: float = number(0.0, "1/s", minimum=0.0, maximum=1.0)
    noise: float = number(0.0, element="noiseAmp", minimum=0.0, maximum=1.0)


class ConstantCurrentOptions(Options):
    """Options of `<constant_current>`."""

    topic: str = text("current_velocity")
    velocity: GaussMarkovOptions = block(GaussMarkovOptions)
    horz_angle: GaussMarkovOptions = block(GaussMarkovOptions, element="horizontal_angle")
    vert_angle: GaussMarkovOptions = block(GaussMarkovOptions, element="vertical_angle")


class UnderwaterCurrentOptions(Options):
    """Options of `UnderwaterCurrent`."""

    namespace: str = text()
    current: ConstantCurrentOptions = block(ConstantCurrentOptions, element="constant_current")


@dataclass(frozen=True)
class GaussMarkovProcess:
    """Parameters and present value of a process."""

    mean: float
    low: float
    high: float
    mu: float
    noise: float
    value: float

    def after(self, step: float, drawn: float) -> GaussMarkovProcess:
        """Return the process after a time step [s], with a number within ±1/2."""
        value = (1.0 - step * self.mu) * self.value + self.noise * drawn
        return replace(self, value=max(self.low, min(self.high, value)))

    @property
    def is_valid(self) -> bool:
        """True if the mean is within the limits and mu and noise are not negative."""
        return self.low <= self.mean <= self.high and self.low < self.high and self.noise >= 0 and 0 <= self.mu <= 1


def velocity_of(speed: float, around: float, above: float) -> tuple[float, float, float]:
    """Return a velocity [m/s] from the speed and the angles in the horizontal plane and above it [rad]."""
    flat = speed * math.cos(above)
    return flat * math.cos(around), flat * math.sin(around), speed * math.sin(above)


def current_endpoints(types: str) -> tuple[Any, ...]:
    """Return the topic and the services of a current, whose types are those of a package."""
    return (
        publishes("/{namespace}/current_velocity", TWIST, named_by=("constant_current/topic",)),
        offers("/{namespace}/set_current_velocity", f"{types}/srv/SetCurrentVelocity"),
        *(offers(f"/{{namespace}}/set_current_{name}", f"{types}/srv/SetCurrentDirection") for name in _MODELS[1:]),
        *(offers(f"/{{namespace}}/set_current_{name}_model", f"{types}/srv/SetCurrentModel") for name in _MODELS),
        *(offers(f"/{{namespace}}/get_current_{name}_model", f"{types}/srv/GetCurrentModel") for name in _MODELS),
    )


class UnderwaterCurrent(WorldPlugin):
    """Publishes the velocity of the water [m/s] on `/<namespace>/<topic>`, twenty times a second.

    Vehicles with `libuuv_underwater_object_ros_plugin.so` and this topic as `<flow_velocity_topic>` drift with it. The
    angles are those of the velocity in the horizontal plane and above it [rad]. Services set the mean values and the
    processes.
    """

    types: ClassVar[str] = _TYPES
    endpoints: ClassVar[tuple[Any, ...]] = current_endpoints(_TYPES)
    options = OptionsOf(UnderwaterCurrentOptions)
    filenames: ClassVar[tuple[str, ...]] = (
        "libuuv_underwater_current_ros_plugin.so",
        "libuuv_underwater_current_plugin.so",
        "libunderwater_current_ros_plugin.so",
        "libunderwater_current_plugin.so",
    )

    def load(self, parent: Simulation, params: Params) -> None:
        options, types = self.options.read_all(), self.types
        current = options.current
        self._processes: dict[str, GaussMarkovProcess] = {}
        for name in _MODELS:
            given: GaussMarkovOptions = getattr(current, name)
            process = GaussMarkovProcess(given.mean, given.low, given.high, given.mu, given.noise, given.mean)
            if not process.is_valid:
                message = f"found a mean of {process.mean:g} with min {process.low:g} and max {process.high:g}"
                given.params.error("SK-PARAM-002", f"{message}; expected min ≤ mean ≤ max and min < max")
            self._processes[name] = process
        self._stream, self._index, self._next_message = self.random("current", 3), 0, 0.0
        base = self._base = "/" + options.namespace.strip("/") if options.namespace.strip("/") else ""
        self._output = self.advertise(f"{base}/{current.topic.strip('/')}", TWIST)
        self.offer(f"{base}/set_current_velocity", f"{types}/srv/SetCurrentVelocity", self._set_velocity)
        for name in _MODELS:
            self.offer(
                f"{base}/set_current_{name}_model", f"{types}/srv/SetCurrentModel", partial(self._set_process, name)
            )
            self.offer(
                f"{base}/get_current_{name}_model", f"{types}/srv/GetCurrentModel", partial(self._get_process, name)
            )
            if name != "velocity":
                self.offer(
                    f"{base}/set_current_{name}", f"{types}/srv/SetCurrentDirection", partial(self._set_angle, name)
                )

    @property
    def velocity(self) -> tuple[float, float, float]:
        """Velocity of the water [m/s] in world axes."""
        speed, around, above = (self._processes[name].value for name in _MODELS)
        return velocity_of(speed, around, above)

    def before_step(self) -> None:
        """Advance the processes, and publish the velocity when it is due."""
        drawn = self._stream.uniform(self._index).tolist()
        self._index += 1
        step = self.period if self._index > 1 else 0.0
        for name, number_of_name in zip(_MODELS, drawn, strict=True):
            self._processes[name] = self._processes[name].after(step, 0.5 * number_of_name)
        if self.sim.time >= self._next_message - 1e-9:
            self._next_message = self.sim.time + _PERIOD
            self.publish()

    def publish(self) -> None:
        """Publish the velocity."""
        self._output.publish(current_message(self.sim.time_ns, self.velocity))

    def _set_mean(self, name: str, mean: float) -> bool:
        changed = replace(self._processes[name], mean=mean, value=mean)
        if changed.is_valid:
            self._processes[name] = changed
        return changed.is_valid

    def _set_velocity(self, request: Message) -> dict[str, object]:
        means = (request.velocity, request.horizontal_angle, request.vertical_angle)
        return {"success": all(self._set_mean(name, float(mean)) for name, mean in zip(_MODELS, means, strict=True))}

    def _set_angle(self, name: str, request: Message) -> dict[str, object]:
        return {"success": self._set_mean(name, float(request.angle))}

    def _set_process(self, name: str, request: Message) -> dict[str, object]:
        mean, low, high = float(request.mean), float(request.min), float(request.max)
        if name == "velocity":
            mean, low, high = max(0.0, mean), max(0.0, low), max(0.0, high)
        process = GaussMarkovProcess(mean, low, high, float(request.mu), float(request.noise), mean)
        if process.is_valid:
            self._processes[name] = process
        return {"success": process.is_valid}

    def _get_process(self, name: str, _: Message) -> dict[str, object]:
        process = self._processes[name]
        limits = {"mean": process.mean, "min": process.low, "max": process.high}
        return {**limits, "noise": process.noise, "mu": process.mu}
