"""Sonar: the distance of the nearest surface in a cone."""

from __future__ import annotations

import math
from dataclasses import dataclass

import mujoco
import numpy as np

from simkit import msgs
from simkit.compiler import Compiled
from simkit.compiler.geom_groups import SEEN_AS_COLLISIONS
from simkit.diagnostics import Diagnostics
from simkit.params import Params
from simkit.scene import SceneSensor
from simkit.sensors.base import Product, Sensor
from simkit.sensors.measured_rows import MeasuredRows
from simkit.sensors.noise import Noise, NoiseModel, read_noise
from simkit.sensors.rays.nearest_in_cone import NearestInCone

TYPE = "sensor_msgs/msg/Range"
ULTRASOUND = 0
_MAX_RANGE = 3e38  # messages contain 32-bit floats


@dataclass(frozen=True, slots=True)
class SonarOptions:
    """The `<sonar>` block.

    Attributes:
        half_angle: angle between the axis and the edge of the cone [rad]; pi for a sphere.
        axis: axis of the cone, a unit vector in the sensor's frame.
        range_min, range_max: range limits [m].
        noise: noise of the range [m].
    """

    half_angle: float
    axis: tuple[float, float, float]
    range_min: float
    range_max: float
    noise: NoiseModel


@dataclass(frozen=True, slots=True)
class SonarReading:
    """Nearest surface.

    Attributes:
        range: distance [m]; `inf` if nothing is within the range, `-inf` if the surface is nearer than the minimum.
        hit: scoped name of the surface's collision, or empty.
    """

    range: float
    hit: str


def _read_axis(block: Params) -> tuple[float, float, float]:
    x, y, z = block.vector3("axis", (0.0, 0.0, -1.0))
    length = math.hypot(x, y, z)
    if length == 0:
        block.block("axis").error("SK-PARAM-002", "found an <axis> of length 0; expected any other vector")
        return (0.0, 0.0, -1.0)
    return (x / length, y / length, z / length)


class Sonar(Sensor["msgs.Range"]):
    """Sonar, `sonar`: the distance to the nearest collision in a cone (or sphere) from the sensor's origin.

    The cone opens along the sensor's -z axis, as in Gazebo Classic, or along `<axis>`. Rays sample the cone: one on its
    axis and rings around it, the last on its edge. Around the nearest hits, denser rays follow. A surface of any
    orientation is detected; echoes are not modelled. The sensor's own link is never hit.
    """

    kinds = ("sonar",)
    example = "<sonar><min>0.02</min><max>4</max><radius>0.5</radius></sonar>"
    _names_for_users = ("hit",)
    options: SonarOptions
    noise: Noise

    def __init__(self, scene: SceneSensor, diagnostics: Diagnostics) -> None:
        super().__init__(scene, diagnostics)
        options = self.options
        self._cone = NearestInCone(options.half_angle, options.axis, SEEN_AS_COLLISIONS, options.range_max)

    def read_options(self, params: Params) -> SonarOptions:
        block = params.block("sonar")
        geometry = block.choice("geometry", ("cone", "sphere"), "cone")
        low = block.number("min", 0.0, minimum=0)
        high = block.number("max", 1.0, minimum=0, maximum=_MAX_RANGE)
        if not high > low:
            block.error("SK-PARAM-002", f"found a range from {low:g} to {high:g} m; expected a <max> above <min>")
            low, high = 0.0, 1.0
        radius = block.number("radius", 0.5, minimum=0)
        half_angle = math.atan2(radius, high) if geometry == "cone" else math.pi
        return SonarOptions(half_angle, _read_axis(block), low, high, read_noise(block))

    def describe(self) -> dict[str, object]:
        o = self.options
        return {
            "sonar": {
                "field_of_view": 2 * o.half_angle,
                "axis": list(o.axis),
                "range_min": o.range_min,
                "range_max": o.range_max,
            }
        }

    def prepare(self) -> None:
        self.noise = self._make_noise((self.options.noise,), "range")

    def products(self) -> dict[str, Product]:
        return {"range": Product(TYPE, self._message_of)}

    def default_topics(self) -> dict[str, str]:
        return {"range": self._default_topic("sonar")}

    def bind(self, compiled: Compiled) -> None:
        super().bind(compiled)
        names = compiled.names
        self._cone.bind(compiled.model, names, self._body, names.link(self.scene.parent).ray_geoms)
        self._geom_owner = names.geom_owner

    @property
    def hit(self) -> str:
        """Scoped name of the collision that the newest reading hit; empty for none."""
        reading: SonarReading | None = self._true_reading()
        return reading.hit if reading is not None else ""

    def array_rule(self) -> MeasuredRows:
        return MeasuredRows(self, casts=True)

    def measure(self, model: mujoco.MjModel, data: mujoco.MjData) -> SonarReading:
        options = self.options
        distance, geom = self._cone.find(model, data, *self._frame_in_world(data))
        if distance > options.range_max:
            return SonarReading(math.inf, "")
        owner = str(self._geom_owner(geom)[1])
        return SonarReading(distance if distance >= options.range_min else -math.inf, owner)

    def perturb(self, reading: SonarReading, index: int) -> SonarReading:
        if self.noise.is_silent or math.isinf(reading.range):
            return reading
        value = float(self.noise.apply(np.array([reading.range]), index)[0])
        low, high = self.options.range_min, self.options.range_max
        return SonarReading(min(max(value, low), high), reading.hit)

    def _message_of(self, reading: SonarReading, time_ns: int) -> msgs.Range:
        o = self.options
        return msgs.Range(
            header=msgs.header(time_ns, self.frame_id),
            radiation_type=ULTRASOUND,
            field_of_view=2 * o.half_angle,
            min_range=o.range_min,
            max_range=o.range_max,
            range=reading.range,
            variance=min(self.noise.variance(), _MAX_RANGE),
        )
