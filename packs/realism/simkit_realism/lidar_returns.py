"""Changes of the returns of a lidar that its artefacts share."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace

import numpy as np
import numpy.typing as npt

from simkit.extend import LidarMeasurement, LidarReading, Vector
from simkit.sensors.rays.ray_probes import HitSurfaces
from simkit_realism.optical_rays import Returns

Mask = npt.NDArray[np.bool_]


def surfaces_of(reading: LidarReading) -> HitSurfaces:
    """Return the surfaces that an artefact has requested with `probes.wants_surfaces`."""
    assert reading.surfaces is not None
    return reading.surfaces


def change_returns(reading: LidarReading, change: Callable[[LidarReading, int], LidarReading]) -> LidarReading:
    """Apply a function to the first returns (number 0) and to the second returns (number 1) of a reading."""
    changed = change(reading, 0)
    return changed if changed.second is None else replace(changed, second=change(changed.second, 1))


def change_ranges(reading: LidarReading, ranges: Vector) -> LidarReading:
    """Return a reading with other ranges [m]; those without a return stay infinite."""
    return replace(reading, ranges=np.where(reading.infinite, reading.ranges, ranges))


def lose_returns(reading: LidarReading, is_lost: Callable[[LidarReading, int], Mask]) -> LidarReading:
    """Return a reading without some returns, which read +inf with intensity 0.

    The second return of a ray takes the place of a first one that is lost. A range of -inf, which says that a surface
    is too near, is no return and is not lost.

    Args:
        reading: the reading.
        is_lost: function that returns which of the first (number 0) or second (number 1) returns are lost.
    """
    return _fill_first(change_returns(reading, lambda part, number: _without(part, is_lost(part, number))))


def _without(reading: LidarReading, is_lost: Mask) -> LidarReading:
    is_lost = is_lost & ~reading.infinite
    return replace(
        reading,
        ranges=np.where(is_lost, np.inf, reading.ranges),
        intensities=np.where(is_lost, 0.0, reading.intensities),
        infinite=reading.infinite | is_lost,
    )


def _fill_first(reading: LidarReading) -> LidarReading:
    second = reading.second
    if second is None:
        return reading
    fills = reading.infinite & ~second.infinite
    if not fills.any():
        return reading
    filled = choose(fills, second, reading)
    rest = _without(second, fills)
    return replace(filled, second=rest)


def choose(is_first: Mask, first: LidarReading, second: LidarReading) -> LidarReading:
    """Return a reading with the rays of one reading where a mask is set, and of another elsewhere."""
    surfaces = None
    if first.surfaces is not None and second.surfaces is not None:
        pairs = zip(first.surfaces, second.surfaces, strict=True)
        surfaces = HitSurfaces(*(np.where(is_first if a.ndim == 1 else is_first[:, None], a, b) for a, b in pairs))
    return replace(
        second,
        ranges=np.where(is_first, first.ranges, second.ranges),
        intensities=np.where(is_first, first.intensities, second.intensities),
        infinite=np.where(is_first, first.infinite, second.infinite),
        hits=np.where(is_first, first.hits, second.hits),
        surfaces=surfaces,
    )


def reading_of(reading: LidarReading, returns: Returns, sensor: LidarMeasurement) -> LidarReading:
    """Return a reading with the given returns; a ray whose surface is too near keeps its range of -inf."""
    is_near = reading.ranges == -np.inf
    infinite = ~np.isfinite(returns.ranges)
    hits = np.where(infinite, -1, returns.geoms).astype(np.int32)
    return replace(
        reading,
        ranges=np.where(is_near, -np.inf, returns.ranges),
        intensities=np.where(infinite | is_near, 0.0, sensor.retro_of(hits)),
        infinite=infinite | is_near,
        hits=hits,
        geoms=np.append(np.arange(sensor.fan.targets.model.ngeom), -1).astype(np.int32),
        surfaces=HitSurfaces(returns.normals, returns.cosines, returns.reflectivities),
    )
