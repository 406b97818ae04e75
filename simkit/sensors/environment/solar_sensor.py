"""Solar sensor: the direction of a light, its visibility, and the irradiance and power that it gives."""

from __future__ import annotations

import math
from dataclasses import dataclass, replace
from typing import Any

import mujoco
import numpy as np

from simkit import msgs
from simkit.compiler import Compiled
from simkit.diagnostics import NOWHERE, Diagnostics, did_you_mean
from simkit.params import LARGEST, Params
from simkit.pose import quat_from_rpy, quat_rotate, rpy_from_quat
from simkit.runtime.handles.light import Light, LightMotion, LightState
from simkit.scene import SceneSensor
from simkit.sensors.base import Product, Sample, Sensor
from simkit.sensors.environment import solar_irradiance
from simkit.sensors.environment.solar_irradiance import NO_LIGHT, SolarOptions, SolarReading, SolarView
from simkit.sensors.noise import Noise, NoiseModel, quantise, read_noise
from simkit.sensors.sample import Memory

TYPE = "sensor_msgs/msg/Imu"
NUMBER = "std_msgs/msg/Float64"
_ERRORS = np.zeros(2)  # zeros that the noise is added to


@dataclass(frozen=True, slots=True)
class SolarSensorOptions:
    """The `<solar>` block.

    Attributes:
        light_name: name of the light; empty for the first directional light.
        view: options of the measurement.
        noise: noise of the direction, about each of the two axes perpendicular to it [rad].
    """

    light_name: str
    view: SolarOptions
    noise: NoiseModel


class SolarSensor(Sensor["msgs.Imu"]):
    """Solar sensor, `solar`: the direction of a light as an orientation whose x axis points at the light.

    Attributes:
        light: handle of the light; None if there is none.
    """

    kinds = ("solar",)
    example = "<solar/>"
    _names_for_users = ("reading",)
    options: SolarSensorOptions
    noise: Noise
    light: Light | None = None

    def __init__(self, scene: SceneSensor, diagnostics: Diagnostics) -> None:
        super().__init__(scene, diagnostics)
        # the rounding applies to the angles and not to their errors
        self._precision = np.full(2, self.options.noise.precision)
        self._motions: list[tuple[int, LightMotion | None]] = []
        self._view: SolarView | None = None

    def read_options(self, params: Params) -> SolarSensorOptions:
        block = params.block("solar")
        noise, angular_noise = read_noise(block), block.number("angular_noise", 0.0, minimum=0, maximum=LARGEST)
        if angular_noise > 0:
            noise = replace(noise, stddev=math.hypot(noise.stddev, angular_noise))
        return SolarSensorOptions(
            block.text("light_name", ""), solar_irradiance.read_solar_options(block, "direction"), noise
        )

    def describe(self) -> dict[str, object]:
        options, view = self.options, self.options.view
        panel = view.panel
        return {
            "solar": {
                "light_name": options.light_name,
                "shadow": view.shadow,
                "field_of_view": view.field_of_view,
                "irradiance": view.irradiance,
                "panel": {"area": panel.area, "efficiency": panel.efficiency} if panel else None,
            }
        }

    def prepare(self) -> None:
        model = replace(self.options.noise, precision=0.0)
        self.noise = self._make_noise((model, model), "angles")
        self._find_light()
        if self.light is None:
            self._report_missing()
        else:
            solar_irradiance.report_unused_options(self.scene.params.block("solar"), self.options.view, self.light)

    def products(self) -> dict[str, Product]:
        return {
            "direction": Product(TYPE, self._message_of),
            "valid": Product("std_msgs/msg/Bool", lambda reading, _: msgs.Bool(reading.is_valid)),
            "irradiance": Product(NUMBER, lambda reading, _: msgs.Float64(reading.irradiance)),
            "power": Product(NUMBER, lambda reading, _: msgs.Float64(reading.power)),
            "shadow": Product("std_msgs/msg/String", lambda reading, _: msgs.String(reading.shadow)),
        }

    def default_topics(self) -> dict[str, str]:
        topic, view = self._default_topic("solar"), self.options.view
        topics = {"direction": topic, "valid": topic + "/valid", "irradiance": topic + "/irradiance"}
        if view.panel is not None:
            topics["power"] = topic + "/power"
        if view.shadow:
            topics["shadow"] = topic + "/shadow"
        return topics

    def bind(self, compiled: Compiled) -> None:
        super().bind(compiled)
        if self.light is None or self.sim.contents.lights.get(self.light.scoped) is not self.light:
            self._find_light()  # the light was spawned or removed with a model
        if self._view is not None:
            self._view.bind(compiled, self._link_name)

    # ------------------------------------------------------------------ light

    def _find_light(self) -> None:
        """Find the light that the file names, or the first directional light."""
        lights, name = self.sim.contents.lights, self.options.light_name
        suns = (light for light in lights.values() if light.scene.type == "directional")
        self.light = lights.get(name) if name else next(suns, None)
        self._view = SolarView(self.options.view, self.light) if self.light is not None else None

    def _report_missing(self) -> None:
        lights, name = self.sim.contents.lights, self.options.light_name
        where = self.scene.params.block("solar").block("light_name").where
        light_names = ", ".join(repr(n) for n in sorted(lights)) or "none"
        prefix = f"sensor {self.scoped!r}: "
        if not lights and self.sim.world.where == NOWHERE:
            message = prefix + "there is no light, so readings are invalid; put the model into a world with a light"
            self.diagnostics.note("SK-SENSOR-081", message, self.scene.where)
        elif name:
            message = prefix + f"there is no light {name!r}; lights are: {light_names}"
            self.diagnostics.error("SK-SENSOR-080", message, where, did_you_mean(name, lights))
        else:
            message = f"{prefix}the world has no directional light, so readings are invalid; lights are: {light_names}"
            self.diagnostics.warning("SK-SENSOR-082", message, self.scene.where, "name another light in <light_name>")

    def evolve(self, index: int, dt: float) -> None:
        super().evolve(index, dt)
        motion, motions = self.light.motion if self.light is not None else None, self._motions
        if motions and motions[-1][1] is motion:
            return
        # a sample that is measured later needs the light's motion at the time of the sample
        oldest = min((sample.index for sample in self._kept_samples()), default=index)
        while len(motions) > 1 and motions[1][0] <= oldest:
            del motions[0]
        motions.append((index, motion))

    def restart(self) -> None:
        super().restart()
        self._motions.clear()

    def memory(self) -> object:
        return super().memory(), tuple(self._motions)

    def remember(self, memory: Memory) -> None:
        noise, motions = memory
        super().remember(noise)
        self._motions = list(motions)

    # ------------------------------------------------------------------ measuring

    def measure(self, model: mujoco.MjModel, data: mujoco.MjData) -> SolarReading:
        return self._measure(model, data, self.light.state if self.light is not None else None)

    def capture_held(self, model: mujoco.MjModel, data: mujoco.MjData, sample: Sample) -> SolarReading:
        motion = next((motion for index, motion in reversed(self._motions) if index <= sample.index), None)
        return self._measure(model, data, motion.at(sample.time_ns) if motion is not None else None)

    def _measure(self, model: mujoco.MjModel, data: mujoco.MjData, state: LightState | None) -> SolarReading:
        """Compute the reading from the light's state at the time of `data`; `state` is None if there is no light."""
        if self._view is None or state is None:
            return NO_LIGHT
        return self._view.measure(model, data, state, *self._frame_in_world(data))

    def perturb(self, reading: SolarReading, index: int) -> SolarReading:
        orientation = reading.orientation
        if not self.noise.is_silent:
            orientation = solar_irradiance.deflect_orientation(orientation, self.noise.apply(_ERRORS, index))
        if self._precision[0] > 0:
            pitch, yaw = quantise(rpy_from_quat(orientation)[1:], self._precision).tolist()
            orientation = quat_from_rpy(0.0, pitch, yaw)
        if orientation is reading.orientation:
            return reading
        light = reading.irradiance, reading.power
        return SolarReading(orientation, reading.is_valid, reading.shadow, reading.incidence, *light)

    def _message_of(self, reading: SolarReading, time_ns: int) -> msgs.Imu:
        imu, vector, quaternion = msgs.types_of(TYPE, "geometry_msgs/msg/Vector3", "geometry_msgs/msg/Quaternion")
        w, x, y, z = (1.0, 0.0, 0.0, 0.0)
        covariance = np.zeros(9)
        if reading.is_valid:
            w, x, y, z = reading.orientation.tolist()
            variance = self.noise.variance(0)
            if variance > 0:
                covariance = solar_irradiance.covariance_across(
                    quat_rotate(reading.orientation, (1.0, 0.0, 0.0)), variance
                )
        else:
            covariance[0] = -1.0
        header = msgs.header(time_ns, self.frame_id)
        unknown = np.zeros(9), np.zeros(9)
        unknown[0][0] = unknown[1][0] = -1.0
        zeros = vector(0.0, 0.0, 0.0), vector(0.0, 0.0, 0.0)
        message: msgs.Imu = imu(header, quaternion(x, y, z, w), covariance, zeros[0], unknown[0], zeros[1], unknown[1])
        return message

    # ------------------------------------------------------------------ truth

    @property
    def reading(self) -> SolarReading | Any:
        """True reading of the newest sample (direction, shadow, incidence, light, power), or None before the first."""
        true_reading: SolarReading | None = self._true_reading()
        return true_reading

    @property
    def shadow(self) -> str:
        """Scoped name of the visual or collision that cast its shadow on the newest sample, or ""."""
        reading = self.reading
        return reading.shadow if reading is not None else ""
