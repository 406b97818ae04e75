"""Doppler velocity log of ds_sim, `dsros_dvl`, with a profile of the current.

Elements, beams, formulas and messages are those of `dsros_dvl.cc` and `dsros_dvl_plugin.cc` of ds_sim, which dave's
vehicles use. The parameters are in the sensor's plugin `libdsros_ros_dvl.so`.
"""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import dataclass, replace
from typing import TYPE_CHECKING, Final

import numpy as np

from simkit import Params, msgs
from simkit.extend import NoiseModel, Options, Product, Vector, boolean, integer, number, text, without_effect
from simkit.linear_algebra import matmul
from simkit.matrix_decompositions import pinv
from simkit_water_and_air.sensors.dvl import Dvl
from simkit_water_and_air.sensors.dvl_options import Beam, DopplerVelocityLog

if TYPE_CHECKING:
    import mujoco

DVL: Final = "ds_sensor_msgs/msg/Dvl"
RANGES: Final = "ds_sensor_msgs/msg/Ranges3D"
PROFILE: Final = "ds_sensor_msgs/msg/Adcp"
CLOUD: Final = "sensor_msgs/msg/PointCloud"
PLUGIN: Final = "libdsros_ros_dvl.so"
_BEAMS, _FEWEST = 4, 3
_BEAM_AXES, _INSTRUMENT_AXES = 0, 1
_FROM_RANGE_TO_ALTITUDE: Final = math.cos(math.pi / 6)  # as in the source, for all angles of beams
_SPEED_OF_SOUND: Final = 1500.0  # [m/s]
_POINTS_OF_BEAM: Final = 1000
_GOOD, _BAD = 250.0, 10.0  # quality of a range


class DsrosDvlOptions(Options):
    """Options of `DsrosRosDvl`, which the sensor reads, too."""

    namespace: str = text(None, element="robotNamespace")
    topic: str = text("/dvl", element="topicName")
    ranges_topic: str = text("/dvl_ranges", element="rangesTopicName")
    frame: str = text(element="frameName", required=True)
    cloud_frame: str = text(element="pointcloudFrame", required=True)
    rate: float = number(1.0, "Hz", element="updateRateHZ", minimum=0.0)
    noise_speed: float = number(0.0, "m/s", element="gaussianNoiseBeamVel", minimum=0.0, maximum=1e6)
    noise_water: float = number(None, "m/s", element="gaussianNoiseBeamWtrVel", minimum=0.0, maximum=1e6)
    noise_range: float = number(0.0, "m", element="gaussianNoiseBeamRange", minimum=0.0, maximum=1e6)
    low: float = number(0.0, "m", element="minRange", minimum=0.0, maximum=1e6)
    high: float = number(element="maxRange", unit="m", minimum=1e-6, maximum=1e6, required=True)
    difference: bool = without_effect(element="maxRangeDiff")
    tilt: float = number(0.0, "deg", element="beamAngleDeg", minimum=-180.0, maximum=180.0)
    width: bool = without_effect(element="beamWidthDeg")
    azimuth_1: float = number(0.0, "deg", element="beamAzimuthDeg1")
    azimuth_2: float = number(0.0, "deg", element="beamAzimuthDeg2")
    azimuth_3: float = number(0.0, "deg", element="beamAzimuthDeg3")
    azimuth_4: float = number(0.0, "deg", element="beamAzimuthDeg4")
    tracks_water: bool = boolean(element="enableWaterTrack")
    bins: int = integer(1, element="waterTrackBins", minimum=1, maximum=255)
    axes: int = integer(_BEAM_AXES, element="currentProfileCoordMode", minimum=0, maximum=3)
    is_along_z: bool = boolean(element="pos_z_down")
    mask: bool = without_effect(element="collide_bitmask")


@dataclass(frozen=True)
class DsrosReading:
    """Measurement of the four beams.

    Attributes:
        ranges: ranges [m]; `inf` for a beam without a target.
        speeds: velocities over the bottom along the beams [m/s].
        water: velocities through the water along the beams [m/s].
        profile: the same in each bin, shape (bins, 4); NaN below the bottom.
    """

    ranges: Vector
    speeds: Vector
    water: Vector
    profile: Vector

    @property
    def is_locked(self) -> np.ndarray:
        """True for each beam that has a target."""
        return np.isfinite(self.ranges)


class DsrosDvl(Dvl):
    """Doppler velocity log of ds_sim, `dsros_dvl`: velocity over the bottom or through the water, and its current.

    Four beams, each a ray, are `<beamAngleDeg>` away from the -z axis, or from the z axis with `<pos_z_down>`. Without
    three targets, the velocity is that through the water if `<enableWaterTrack>` is on.
    """

    kinds = ("dsros_dvl",)
    example = (
        '<plugin name="dvl" filename="libdsros_ros_dvl.so"><frameName>dvl</frameName><pointcloudFrame>dvl'
        "</pointcloudFrame><updateRateHZ>0</updateRateHZ><minRange>0.7</minRange><maxRange>90</maxRange><beamAngleDeg>30</beamAngleDeg>"
        "<beamAzimuthDeg1>-135</beamAzimuthDeg1><beamAzimuthDeg2>135</beamAzimuthDeg2><beamAzimuthDeg3>45"
        "</beamAzimuthDeg3><beamAzimuthDeg4>-45</beamAzimuthDeg4></plugin>"
    )
    cloud_frame = ""

    def read_options(self, params: Params) -> DopplerVelocityLog:
        given = next((p.params for p in self.scene.plugins if p.filename == PLUGIN), None)
        if given is None:
            message = f"sensor {self.scoped!r} has its parameters in a <plugin filename={PLUGIN!r}>, which is missing"
            params.error("SK-PARAM-001", message, "copy the plugin from a sensor of the same type")
        options = self._given = DsrosDvlOptions(params if given is None else given)
        if given is None:
            return DopplerVelocityLog("piston", (), {}, (0.0, 1.0, 1), np.zeros(3), np.eye(3), 0.0, (0.0, 1.0))
        options.read_all()
        if options.low >= options.high:
            message = f"found a range from {options.low:g} to {options.high:g}; expected minRange < maxRange"
            given.error("SK-PARAM-002", message)
        tilt = math.radians(options.tilt)
        tilt = math.pi - tilt if options.is_along_z else -tilt
        azimuths = (options.azimuth_1, options.azimuth_2, options.azimuth_3, options.azimuth_4)
        beams = tuple(Beam(i, 0.0, -math.radians(azimuth), tilt) for i, azimuth in enumerate(azimuths, 1))
        layer = (options.low, options.high, options.bins)
        return DopplerVelocityLog("piston", beams, {}, layer, np.zeros(3), np.eye(3), 0.0, (options.low, options.high))

    def prepare(self) -> None:
        options = self._given
        self._water_noise = 2 * options.noise_speed if options.noise_water is None else options.noise_water
        self._cell = (options.high - options.low) / options.bins
        self._distances = options.low + self._cell / 2 + self._cell * np.arange(options.bins)
        sizes = (options.noise_range, options.noise_speed, *[self._water_noise] * (1 + options.bins))
        self.noise = self._make_noise([NoiseModel(stddev=size) for size in sizes for _ in range(_BEAMS)], "beams")
        self.water: Callable[[float | None], Vector] = _still_water

    def products(self) -> dict[str, Product]:
        return {
            "dvl": Product(DVL, self._dvl_message),
            "ranges": Product(RANGES, self._ranges_message),
            "profile": Product(PROFILE, self._profile_message),
            "cloud": Product(CLOUD, self._cloud_message, needs_reading=False),
        }

    def measure(self, model: mujoco.MjModel, data: mujoco.MjData) -> DsrosReading:
        origin, own, directions, ranges, speeds = self._track_bottom(model, data)
        water = matmul(directions, own - self.water(None))
        profile = np.full((len(self._distances), _BEAMS), math.nan)
        if self._given.tracks_water:
            for row, distance in enumerate(self._distances.tolist()):
                for beam in np.flatnonzero(distance <= ranges).tolist():
                    height = float(origin[2] + distance * directions[beam, 2])
                    profile[row, beam] = float(matmul(directions[beam], own - self.water(-height)))
        return DsrosReading(ranges, speeds, water, profile)

    def perturb(self, reading: DsrosReading, index: int) -> DsrosReading:
        if self.noise.is_silent:
            return reading
        flat = np.concatenate((reading.ranges, reading.speeds, reading.water, reading.profile.reshape(-1)))
        noisy = self.noise.apply(flat, index).reshape(-1, _BEAMS)
        return replace(reading, ranges=noisy[0], speeds=noisy[1], water=noisy[2], profile=noisy[3:])

    def _headers(self, time_ns: int) -> dict[str, object]:
        header = msgs.header(time_ns, self.frame_id)
        return {"header": header, "ds_header": {"io_time": header.stamp}}

    def _dvl_message(self, reading: DsrosReading, time_ns: int) -> msgs.Message:
        options, locked = self._given, reading.is_locked
        count = int(locked.sum())
        velocity, altitude = np.zeros(3), 0.0
        if count >= _FEWEST:
            velocity = matmul(pinv(self._axes[locked]), reading.speeds[locked])
            altitude = math.fsum(reading.ranges[locked].tolist()) / count * _FROM_RANGE_TO_ALTITUDE
        is_over_bottom = count >= _FEWEST or not options.tracks_water
        if not is_over_bottom:
            velocity = matmul(pinv(self._axes), reading.water)
        spread = options.noise_speed if is_over_bottom else self._water_noise
        raw_spread = options.noise_speed if count >= _FEWEST else self._water_noise
        x, y, _ = velocity.tolist()
        return msgs.make(
            DVL,
            **self._headers(time_ns),
            dvl_time=time_ns * 1e-9,
            velocity=_xyz(velocity),
            velocity_covar=(spread * spread * np.eye(3)).reshape(9),
            altitude=altitude,
            course_gnd=math.degrees(math.atan2(x, y)) % 360.0,
            speed_gnd=math.sqrt(x * x + y * y),
            num_good_beams=count,
            speed_sound=_SPEED_OF_SOUND,
            beam_unit_vec=[_xyz(axis) for axis in self._axes],
            range=np.where(locked, reading.ranges, math.nan),
            range_covar=np.full(_BEAMS, options.noise_range**2),
            raw_velocity=np.where(locked, reading.speeds, 0.0) if count >= _FEWEST else reading.water,
            raw_velocity_covar=np.full(_BEAMS, raw_spread * raw_spread),
            velocity_mode=1 if is_over_bottom else 2,
            coordinate_mode=1,
        )

    def _ranges_message(self, reading: DsrosReading, time_ns: int) -> msgs.Message:
        headers = self._headers(time_ns)
        ranges = [
            {
                "range": {"header": headers["header"], "point": _xyz((distance if is_valid else math.nan) * axis)},
                "range_quality": _GOOD if is_valid else _BAD,
                "range_validity": 3 if is_valid else 0,
            }
            for axis, distance, is_valid in zip(
                self._axes, reading.ranges.tolist(), reading.is_locked.tolist(), strict=True
            )
        ]
        return msgs.make(RANGES, **headers, ranges=ranges)

    def _profile_message(self, reading: DsrosReading, time_ns: int) -> msgs.Message:
        """Make the profile: the velocity of the water relative to the sensor in each bin; 0 without a solution."""
        cells = []
        for speeds in reading.profile:
            solved = np.isfinite(speeds)
            if self._given.axes == _BEAM_AXES:
                vectors = -np.where(solved, speeds, 0.0)[:, None] * self._axes
            else:
                vectors = -matmul(pinv(self._axes), speeds)[None] if solved.all() else np.zeros((1, 3))
            cells.append({"velocity_bin_beam": [_xyz(vector) for vector in vectors + 0.0]})
        return msgs.make(
            PROFILE,
            **self._headers(time_ns),
            coordinate_mode=self._given.axes,
            cells=len(cells),
            cell_depth=int(self._cell),
            bin0_distance=float(self._distances[0]),
            beam_unit_vec=[_xyz(axis) for axis in self._axes],
            vel_bin_beams=cells,
        )

    def _cloud_message(self, _: object, time_ns: int) -> msgs.PointCloud:
        """Make points along the beams, which show where they are, in the frame `<pointcloudFrame>`."""
        distances = np.linspace(self._given.low, self._given.high, _POINTS_OF_BEAM)
        axes = matmul(self._axes, self._offset_rotation.T)
        points = np.concatenate([self._offset_position + distances[:, None] * axis for axis in axes])
        header = msgs.header(time_ns, self.cloud_frame)
        return msgs.PointCloud(header, [msgs.Point32(*point) for point in points.tolist()], [])


def _still_water(_: float | None) -> Vector:
    return np.zeros(3)


def _xyz(vector: Vector) -> dict[str, float]:
    return dict(zip("xyz", vector.tolist(), strict=True))
