"""Sunlight in a lidar's receiver: it loses returns in the direction of the sun and from sunlit surfaces."""

from __future__ import annotations

import math
from typing import NamedTuple

import mujoco
import numpy as np

from simkit import Params
from simkit.extend import Artefact, LidarMeasurement, LidarReading, Sensor, Vector
from simkit.linear_algebra import matmul
from simkit.sensors.rays.hit_normals import dots
from simkit.sensors.rays.ray_probes import RayCast
from simkit_realism.lidar_returns import Mask, lose_returns, surfaces_of

_GROUPS = np.array((1, 0, 0, 0, 0, 0), dtype=np.uint8)


class Sunlight(NamedTuple):
    """Sun at the time of a sample.

    Attributes:
        direction: unit vector towards the sun in the world, shape (3,).
        glares: True for rays within the angle around the sun, shape (n,).
    """

    direction: Vector
    glares: Mask


class LidarSun(Artefact):
    """`<simkit:sun>` of a lidar: background light raises the losses while the sensor sees the sun.

    Rays within `angle` of the sun lose their return with `probability`, because the sun shines into the receiver.
    Returns from surfaces that the sun shines on are lost with `lit_probability` times the cosine of the sun's angle of
    incidence on them; shadows on surfaces are not computed. One ray from the sensor to the sun decides whether it is
    hidden; nothing is lost then, as indoors.

    Args:
        params: the element, with `angle` [rad], `probability`, `lit_probability`, and optionally `azimuth` and
            `elevation` of the sun in the world [rad]; without them, the world's first directional light is the sun.
        sensor: the lidar.
    """

    elements = ("lidar/sun",)
    order = 25.0
    sensor: LidarMeasurement

    def __init__(self, params: Params, sensor: Sensor) -> None:
        super().__init__(params, sensor)
        self._cosine = math.cos(params.number("angle", 0.1, minimum=0.0, maximum=math.pi))
        self._probability = params.number("probability", 1.0, minimum=0.0, maximum=1.0)
        self._lit_probability = params.number("lit_probability", 0.0, minimum=0.0, maximum=1.0)
        self._fixed: Vector | None = None
        if params.has("azimuth") or params.has("elevation"):
            azimuth, elevation = params.number("azimuth", 0.0), params.number("elevation", 0.0)
            flat = math.cos(elevation)
            self._fixed = np.array((flat * math.cos(azimuth), flat * math.sin(azimuth), math.sin(elevation)))

    def prepare(self) -> None:
        count, sim = self.sensor.fan.count, self.sensor.sim
        self._streams = [self.stream(name, count) for name in ("rays", "second rays")]
        lights = sim.contents.lights.values()
        self._light = next((light for light in lights if light.scene.type == "directional"), None)
        if self._fixed is None and self._light is None:
            message = f"<sun> of sensor {self.sensor.scoped!r} has no effect: the world has no directional light"
            hint = "write <azimuth> and <elevation> in <simkit:sun>, or add a light to the world"
            sim.engine.reports.warning("SK-SENSOR-213", message, self.params.where, hint)
            return
        self.sensor.probes.add("sun", self._find_sun)
        self.sensor.probes.wants_surfaces |= self._lit_probability > 0.0

    def _find_sun(self, cast: RayCast) -> Sunlight | None:
        """Return the sun at the time of a sample; None if it is hidden."""
        towards = self._towards_sun(cast.data)
        targets, body = self.sensor.fan.targets, self.sensor.fan.body
        origin, geom = np.array(cast.origins.reshape(-1, 3)[0]), np.empty(1, np.int32)
        distance = mujoco.mj_ray(
            targets.whole.model, cast.data, origin, towards, _GROUPS, 1, body if body > 0 else -1, geom, None
        )
        return Sunlight(towards, matmul(cast.directions, towards) >= self._cosine) if distance < 0 else None

    def _towards_sun(self, data: mujoco.MjData) -> Vector:
        light, sim = self._light, self.sensor.sim
        if self._fixed is not None or light is None:
            assert self._fixed is not None
            return self._fixed
        # the time of the sample and not the present one, because a sample may be measured later
        time_ns = round(data.time / sim.timestep) * round(sim.timestep * 1e9)
        return -np.asarray(light.motion.at(time_ns).pose.rotate(light.scene.direction))

    def apply(self, reading: LidarReading, truth: LidarReading, index: int) -> LidarReading:
        sun: Sunlight | None = (reading.probed or {}).get("sun")
        if sun is None:
            return reading

        def is_lost(part: LidarReading, number: int) -> Mask:
            kept = np.where(sun.glares, 1.0 - self._probability, 1.0)
            if self._lit_probability > 0.0:
                towards = np.broadcast_to(sun.direction, (len(kept), 3))
                cosines = np.maximum(dots(surfaces_of(part).normals, towards), 0.0)
                kept = kept * (1.0 - self._lit_probability * cosines)
            lost: Mask = self._streams[number].uniform(index) < 1.0 - 2.0 * kept
            return lost

        return lose_returns(reading, is_lost)
