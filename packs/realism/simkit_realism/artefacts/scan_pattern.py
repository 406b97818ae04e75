"""Scan pattern of a lidar: rays in other directions in each scan, from a file or a formula."""

from __future__ import annotations

import math
from dataclasses import replace
from pathlib import Path

import numpy as np

from simkit import InputError, Params
from simkit.extend import Artefact, LidarReading, SpecBuilder, Vector
from simkit.sensors.rays.lidar import Lidar
from simkit.sensors.rays.lidar_measurement import AngleRange
from simkit.sensors.rays.sweep import RayPattern, SweepOptions
from simkit_realism.scan_patterns import RosettePattern, ScanPattern, SpiralPattern, TablePattern, read_table

_MOST_RAYS = 1_000_000
_FASTEST = 1e6  # [Hz]


class ScanPatternOfLidar(Artefact):
    """`<simkit:scan_pattern>` of a lidar: its rays follow a pattern instead of a grid, each at its own time.

    The rays of a scan are spread evenly over the period, as with `<simkit:sweep>`. With `<instantaneous>` they all have
    the time of the stamp.

    Args:
        params: the element, with `samples`, the rays of a scan, and one of `file` (with `stride`, the rows from a ray
            to the next one), `rosette` and `spiral`.
        sensor: the lidar.
    """

    elements = ("lidar/scan_pattern",)
    sensor: Lidar
    _pattern: ScanPattern | None = None
    _last: tuple[tuple[int, float], RayPattern] | None = None

    def __init__(self, params: Params, sensor: Lidar) -> None:
        super().__init__(params, sensor)
        self._samples = params.integer("samples", 0, minimum=1, maximum=_MOST_RAYS)
        if self._samples < 1:
            params.error("SK-SENSOR-282", "found no <samples>; expected the number of rays of a scan")
            self._samples = 1
        self._is_instantaneous = params.boolean("instantaneous", False)
        self._file = params.text("file", "")
        self._stride = params.integer("stride", 1, minimum=1)
        self._formula = self._read_formula(params)
        if bool(self._file) == bool(self._formula):
            found = "found two patterns" if self._file else "found no pattern"
            params.error("SK-SENSOR-282", f"{found}; expected one of <file>, <rosette> and <spiral>")
        rate = sensor.update_rate
        if not rate > 0:
            message = "<scan_pattern> needs the time of a scan, and the sensor has no <update_rate>"
            params.error("SK-SENSOR-282", message, "add an <update_rate>, for example <update_rate>10</update_rate>")
            rate = 1.0
        count = self._samples
        duration = 1e-12 if self._is_instantaneous else (count - 1) / count / rate
        one_layer = AngleRange(count, -math.pi, math.pi), AngleRange(1, 0.0, 0.0)
        sensor.options = replace(
            sensor.options, horizontal=one_layer[0], vertical=one_layer[1], sweep=SweepOptions(duration)
        )

    def _read_formula(self, params: Params) -> ScanPattern | None:
        rosette, spiral = params.child("rosette"), params.child("spiral")
        if rosette is not None:
            rates = [rosette.number(f"rate_{i}", required=True, minimum=-_FASTEST, maximum=_FASTEST) for i in (1, 2)]
            angles = [rosette.number(f"deflection_{i}", required=True, minimum=0.0, maximum=1.0) for i in (1, 2)]
            return RosettePattern(self._samples, (rates[0], rates[1]), (angles[0], angles[1]))
        if spiral is not None:
            turns = spiral.number("azimuth_rate", required=True, minimum=-_FASTEST, maximum=_FASTEST)
            rises = spiral.number("elevation_rate", required=True, minimum=0.0, maximum=_FASTEST)
            limits = [
                spiral.number(name, required=True, minimum=-math.pi / 2, maximum=math.pi / 2)
                for name in ("min_angle", "max_angle")
            ]
            return SpiralPattern(self._samples, turns, rises, limits[0], limits[1])
        return None

    def build(self, builder: SpecBuilder) -> None:
        self._pattern = self._formula or self._read_file(builder)
        if self._pattern is not None:
            self.sensor.use_rays(_directions(*self._pattern.angles(1, self._period)))

    def _read_file(self, builder: SpecBuilder) -> ScanPattern | None:
        element = self.params.child_or_self("file")
        folder = Path(element.where.file).resolve().parent if element.where.file else None
        try:
            path = builder.find_file(self._file, folder)
        except (OSError, ValueError):  # the URI is not a valid file name
            path = None
        if path is None or not path.is_file():
            hint = "the path is relative to the file that names it; package:// and model:// work too"
            element.error("SK-SENSOR-281", f"there is no scan pattern {self._file!r}", hint)
            return None
        builder.files_read.append(path)
        try:
            angles = read_table(path)
        except InputError as error:
            element.error(error.code, error.message, error.help)
            return None
        return TablePattern(*angles, self._samples, self._stride)

    def prepare(self) -> None:
        self.sensor.ray_pattern = self._ray_pattern  # type: ignore[method-assign]

    @property
    def _period(self) -> float:
        """Time of a scan [s]."""
        return 1.0 / self.sensor.update_rate if self.sensor.update_rate > 0 else 1.0

    def _ray_pattern(self, index: int) -> RayPattern:
        key = index, self._period
        if self._last is None or self._last[0] != key:
            assert self._pattern is not None
            times = np.arange(float(self._samples)) * (self._period / self._samples)
            if self._is_instantaneous:
                times = np.zeros(self._samples)
            self._last = key, RayPattern(_directions(*self._pattern.angles(index, self._period)), times)
        return self._last[1]

    def apply(self, reading: LidarReading, truth: LidarReading, index: int) -> LidarReading:
        return reading


def _directions(azimuths: Vector, elevations: Vector) -> Vector:
    """Return unit vectors (x forward, y left, z up), shape (n, 3)."""
    level = np.cos(elevations)
    return np.stack((level * np.cos(azimuths), level * np.sin(azimuths), np.sin(elevations)), axis=-1)
