"""Elements of a Doppler velocity log, with the defaults and checks of gz-sensors."""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import dataclass

import numpy as np

from simkit import Params
from simkit.extend import NoiseModel, Vector, read_noise
from simkit.number_text import number_or_nan

_DVL_ELEMENTS = ("gz:dvl", "ignition:dvl")


@dataclass(frozen=True, slots=True)
class Beam:
    """One beam of a Doppler velocity log; angles in rad."""

    id: int
    aperture: float
    rotation: float
    tilt: float


@dataclass(frozen=True, slots=True)
class TrackingMode:
    """Condition (`never`, `always`, `best`) for measuring the velocity against bottom or water, and its noise [m/s]."""

    when: str
    noise: NoiseModel


@dataclass(frozen=True, slots=True)
class DopplerVelocityLog:
    """The `<gz:dvl>` block; lengths in m.

    Attributes:
        type: `piston` or `phased_array`.
        modes: tracking modes by name; empty where the file has none.
        layer: nearest and farthest distance of the water-mass mode, and its number of bins.
        water: velocity of the water [m/s], in world axes.
        frame: rotation matrix from the frame of the velocities to the sensor's frame.
    """

    type: str
    beams: tuple[Beam, ...]
    modes: Mapping[str, TrackingMode]
    layer: tuple[float, float, int]
    water: Vector
    frame: Vector
    resolution: float
    range: tuple[float, float]


def read_dvl(params: Params) -> DopplerVelocityLog:
    """Read the `<gz:dvl>` of a Doppler velocity log, with Gazebo's defaults and checks."""
    block = next((child for name in _DVL_ELEMENTS if (child := params.child(name))), params.block("dvl"))
    reach = (block.number("minimum_range", 0.1, minimum=0), block.number("maximum_range", 100.0, minimum=0))
    if reach[0] >= reach[1]:
        block.error("SK-PARAM-002", f"found a range from {reach[0]:g} to {reach[1]:g}; expected min < max")
    modes, layer = _read_tracking(block.block("tracking"), reach[1])
    return DopplerVelocityLog(
        type=block.choice("type", ("piston", "phased_array"), "piston"),
        beams=_read_beams(block.block("arrangement")),
        modes=modes,
        layer=layer,
        water=_read_water(block.block("tracking").block("water_mass_mode").block("water_velocity")),
        frame=block.pose("reference_frame").matrix,
        resolution=block.number("resolution", 0.01, minimum=1e-9),
        range=reach,
    )


def _read_beams(arrangement: Params) -> tuple[Beam, ...]:
    degrees = arrangement.attribute("degrees") or arrangement.text("degrees", "false")
    unit = math.pi / 180 if degrees.strip().lower() in ("1", "true") else 1.0
    beams: list[Beam] = []
    for element in arrangement.all("beam"):
        number = element.attribute("id")
        beam = Beam(
            int(number) if number.strip().isdecimal() else element.integer("id", len(beams)),
            element.number("aperture", math.pi / 2 / unit) * unit,
            element.number("rotation", 0.0) * unit,
            element.number("tilt", 0.0) * unit,
        )
        element.child("visualize")
        if abs(beam.tilt) >= math.pi / 2:
            element.error("SK-PARAM-002", f"found a tilt of {beam.tilt:g} rad; expected less than a right angle")
        beams.append(beam)
    if arrangement.was_read and len(beams) < 3:
        arrangement.error("SK-PARAM-002", f"found {len(beams)} <beam>; expected three or more")
    return tuple(beams)


def _read_water(velocity: Params) -> Vector:
    """Read the velocity of the water; it is zero if the file names data of an environment instead of numbers."""
    water = [number_or_nan(velocity.text(axis, "0")) for axis in "xyz"]
    if not all(map(math.isfinite, water)):
        message = "<water_velocity> names data of an environment, which are not used: the water is at rest"
        velocity.warning("SK-PARAM-003", message, "write numbers [m/s]")
        return np.zeros(3)
    return np.array(water)


def _read_tracking(tracking: Params, far: float) -> tuple[Mapping[str, TrackingMode], tuple[float, float, int]]:
    modes: dict[str, TrackingMode] = {}
    layer = (0.2 * far, 0.8 * far, 5)
    for name in ("bottom_mode", "water_mass_mode"):
        mode = tracking.child(name)
        if mode is None:
            continue
        modes[name] = TrackingMode(mode.choice("when", ("always", "never", "best"), "always"), read_noise(mode))
        mode.boolean("visualize", False)
        if name == "water_mass_mode":
            bounds = mode.block("boundaries")
            near, end = bounds.number("near", layer[0], minimum=0), bounds.number("far", layer[1], minimum=0)
            if not near < end <= far:
                message = f"found a layer from {near:g} to {end:g}; expected near < far ≤ the maximum range {far:g}"
                bounds.error("SK-PARAM-002", message)
            layer = (near, end, mode.integer("bins", layer[2], minimum=1))
    return modes, layer
