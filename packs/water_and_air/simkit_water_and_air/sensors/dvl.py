"""Doppler velocity log: velocity over the bottom or through the water, from beams of sound.

Elements, beams and least squares are those of `DopplerVelocityLog.cc` of gz-sensors. Each beam is a cone; its target is
the nearest surface in it, and it measures the component of the relative velocity along its axis.
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import Any, NamedTuple

import mujoco
import numpy as np

from simkit import Params, msgs
from simkit.extend import Diagnostics, Noise, Product, SceneSensor, Sensor, Vector
from simkit.linear_algebra import matmul
from simkit.matrix_decompositions import pinv
from simkit.sensors.rays.nearest_in_cone import NearestInCone
from simkit_water_and_air.sensors.dvl_options import Beam, DopplerVelocityLog, read_dvl

TYPE = "dave_interfaces/msg/DVL"
_SEEN = (0, 3)
_BODY = mujoco.mjtObj.mjOBJ_XBODY
_FEWEST = 3  # beams that give a velocity


@dataclass(frozen=True, slots=True)
class Estimate:
    """Velocity that beams have measured.

    Attributes:
        target: `BOTTOM` or `WATER_MASS`.
        ranges: range of each beam [m]; `inf` for a beam without a target.
        speeds: component of the velocity along each beam [m/s]; 0 without a target.
        variance: variance of the speeds [m²/s²].
    """

    target: str
    ranges: Vector
    speeds: Vector
    variance: float

    @property
    def is_locked(self) -> np.ndarray:
        """True for each beam that has a target."""
        return np.isfinite(self.ranges)


class BottomTrack(NamedTuple):
    """Measurement of the beams over the bottom, in world axes.

    Attributes:
        origin, own: position [m] and velocity [m/s] of the sensor.
        directions: unit vectors of the beams, shape (n, 3).
        ranges: ranges of the beams [m]; `inf` without a target.
        speeds: velocities relative to the targets along the beams [m/s]; 0 without a target.
    """

    origin: Vector
    own: Vector
    directions: Vector
    ranges: Vector
    speeds: Vector


class Dvl(Sensor):
    """Doppler velocity log, `dvl` (`<sensor type="custom" gz:type="dvl">`): its velocity over the bottom [m/s].

    The velocity is in the `<reference_frame>` (default: the sensor's frame) and needs three beams with a target. With
    `best` in both tracking modes, the mode with the smaller variance counts; without a bottom, it is the water.
    """

    kinds = ("dvl",)
    example = (
        "<dvl><arrangement degrees='true'><beam id='0'><aperture>4</aperture><tilt>30</tilt></beam><beam id='1'>"
        "<aperture>4</aperture><rotation>120</rotation><tilt>30</tilt></beam><beam id='2'><aperture>4</aperture>"
        "<rotation>-120</rotation><tilt>30</tilt></beam></arrangement><tracking><bottom_mode/></tracking></dvl>"
    )
    options: DopplerVelocityLog
    noise: Noise

    def __init__(self, scene: SceneSensor, diagnostics: Diagnostics) -> None:
        super().__init__(scene, diagnostics)
        log = self.options
        self._axes = np.array([_axis(beam) for beam in log.beams]).reshape(-1, 3)  # in the sensor's frame
        self._basis = matmul(self._axes, self.options.frame)  # in the frame of the velocities
        reach = log.range[1]
        self._cones = [
            NearestInCone(beam.aperture / 2, tuple(axis), _SEEN, reach)
            for beam, axis in zip(log.beams, self._axes.tolist(), strict=True)
        ]

    def read_options(self, params: Params) -> DopplerVelocityLog:
        return read_dvl(params)

    def describe(self) -> dict[str, object]:
        """Return the number of beams and the ranges [m]."""
        low, high = self.options.range
        return {"dvl": {"beams": len(self._axes), "range_min": low, "range_max": high}}

    def prepare(self) -> None:
        modes = self.options.modes
        names = ("bottom_mode", "water_mass_mode")
        self._modes = [name for name in names if name in modes and modes[name].when != "never"]
        models = [modes[name].noise for name in self._modes for _ in self._axes]
        self.noise = self._make_noise(models, "beams")

    def products(self) -> dict[str, Product]:
        return {"dvl": Product(TYPE, self._message_of)}

    def default_topics(self) -> dict[str, str]:
        return {"dvl": self._default_topic("dvl/velocity")}

    def bind(self, compiled: Any) -> None:
        super().bind(compiled)
        model, names = compiled.model, compiled.names
        for cone in self._cones:
            cone.bind(model, names, self._body, names.link(self.scene.parent).ray_geoms)

    def _track_bottom(self, model: mujoco.MjModel, data: mujoco.MjData) -> BottomTrack:
        """Return what the beams measure over the bottom."""
        origin, rotation = self._frame_in_world(data)
        body_axes = data.xmat[self._body].reshape(3, 3)
        own = self._velocity_in_world(model, data, matmul(body_axes, self._offset_position))
        low, high = self.options.range
        ranges, speeds = np.full(len(self._axes), math.inf), np.zeros(len(self._axes))
        directions = matmul(self._axes, rotation.T)
        for index, cone in enumerate(self._cones):
            distance, geom = cone.find(model, data, origin, rotation)
            if low <= distance <= high:
                point = origin + distance * directions[index]
                target = _velocity_of(model, data, int(model.geom_bodyid[geom]), point)
                ranges[index], speeds[index] = distance, float(matmul(own - target, directions[index]))
        return BottomTrack(origin, own, directions, ranges, speeds)

    def measure(self, model: mujoco.MjModel, data: mujoco.MjData) -> Any:
        _, own, directions, ranges, speeds = self._track_bottom(model, data)
        modes = self.options.modes
        estimates = []
        for name in self._modes:
            variance = modes[name].noise.stddev ** 2
            if name == "bottom_mode":
                estimates.append(Estimate("BOTTOM", ranges, speeds, variance))
            else:
                estimates.append(self._through_water(own, directions, ranges, variance))
        return tuple(estimates)

    def _through_water(self, own: Vector, directions: Vector, bottom: Vector, variance: float) -> Estimate:
        """Return the velocity through the layer of water; a bottom within the layer ends it."""
        near, far, _ = self.options.layer
        is_open = bottom > near
        ranges = np.where(is_open, (near + np.minimum(far, bottom)) / 2, math.inf)
        speeds = np.where(is_open, matmul(directions, own - self.options.water), 0.0)
        return Estimate("WATER_MASS", ranges, speeds, variance)

    def perturb(self, reading: Any, index: int) -> Any:
        if self.noise.is_silent or not reading:
            return reading
        noisy = self.noise.apply(np.concatenate([estimate.speeds for estimate in reading]), index)
        count = len(self._axes)
        return tuple(
            Estimate(e.target, e.ranges, np.where(e.is_locked, noisy[i * count : (i + 1) * count], 0.0), e.variance)
            for i, e in enumerate(reading)
        )

    def _solve(self, estimate: Estimate) -> tuple[Vector, Vector]:
        """Return the velocity [m/s], shape (3,), and its covariance, shape (3, 3), by least squares.

        Without enough beams, the velocity is zero and the covariance infinite.
        """
        locked = estimate.is_locked
        if int(locked.sum()) < _FEWEST:
            return np.zeros(3), np.full((3, 3), math.inf)
        inverse = pinv(self._basis[locked])
        return matmul(inverse, estimate.speeds[locked]), estimate.variance * matmul(inverse, inverse.T)

    def _message_of(self, reading: tuple[Estimate, ...], time_ns: int) -> msgs.Message:
        solved = [(estimate, *self._solve(estimate)) for estimate in reading]
        kind = f"DVL_TYPE_{self.options.type.upper()}"
        header = msgs.header(time_ns, self.frame_id)
        if not solved:
            return msgs.make(TYPE, header=header, type=kind)
        modes = self.options.modes
        always = [s for s, name in zip(solved, self._modes, strict=True) if modes[name].when == "always"]
        estimate, velocity, covariance = (always or sorted(solved, key=lambda s: float(s[2].trace())))[0]
        beams = [
            {
                "id": beam.id,
                "reference": "DVL_REFERENCE_SHIP",
                "range": 0.0 if math.isinf(distance) else distance,
                "locked": not math.isinf(distance),
                "velocity": _twist(speed * axis, estimate.variance * np.outer(axis, axis)),
            }
            for beam, distance, speed, axis in zip(
                self.options.beams, estimate.ranges.tolist(), estimate.speeds.tolist(), self._basis, strict=True
            )
        ]
        nearest = float(estimate.ranges.min())
        target = {"type": f"DVL_TARGET_{estimate.target}", "range": nearest}
        twist = _twist(velocity, covariance)
        return msgs.make(TYPE, header=header, type=kind, target=target, velocity=twist, beams=beams)


def _axis(beam: Beam) -> tuple[float, float, float]:
    """Return the axis of a beam in the sensor's frame: without tilt and rotation, it points along -z."""
    along, across = math.cos(beam.tilt), math.sin(beam.tilt)
    return -across * math.cos(beam.rotation), across * math.sin(beam.rotation), -along


def _velocity_of(model: mujoco.MjModel, data: mujoco.MjData, body: int, point: Vector) -> Vector:
    """Return the velocity of a point of a body [m/s], in world axes."""
    if body == 0 or not model.body_dofnum[model.body_rootid[body]]:
        return np.zeros(3)
    motion = np.empty(6)
    mujoco.mj_objectVelocity(model, data, _BODY, body, motion, 0)
    velocity: Vector = motion[3:] + np.cross(motion[:3], point - data.xpos[body])
    return velocity


def _twist(velocity: Vector, covariance: Vector) -> dict[str, object]:
    """Return the fields of a `TwistWithCovariance`; as in the bridge, the nine first numbers are the 3 × 3 matrix."""
    numbers = np.zeros(36)
    numbers[:9] = covariance.reshape(9)
    return {"twist": {"linear": dict(zip("xyz", velocity.tolist(), strict=True))}, "covariance": numbers}
