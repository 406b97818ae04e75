"""Sensor kinds of SDF that simkit knows and does not simulate: they are read in full, checked and reported.

They are radios (`wireless_transmitter`, `wireless_receiver`), tags (`rfid`, `rfidtag`) and the Doppler velocity log
(`dvl`), which needs water. Gazebo does not simulate the first four either; Gazebo Classic did.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Mapping
from dataclasses import dataclass
from typing import Final

from simkit.diagnostics import Diagnostics
from simkit.params import Params
from simkit.scene import SceneSensor, SceneWorld
from simkit.sensors.noise import NoiseModel, read_noise
from simkit.sensors.topics_and_frames import read_frame_id

_COMMON_ELEMENTS = ("always_on", "visualize", "enable_metrics", "pose", "update_rate", "topic")
_DVL_ELEMENTS = ("gz:dvl", "ignition:dvl")


@dataclass(frozen=True, slots=True)
class Transceiver:
    """The `<transceiver>` block of a radio.

    Attributes:
        essid: name of the network that a transmitter offers.
        frequency: frequency of a transmitter [MHz].
        band: lowest and highest frequency of a receiver [MHz].
        gain: gain of the antenna [dBi].
        power: transmitted power [dBm].
        sensitivity: sensitivity of a receiver [dBm].
    """

    essid: str
    frequency: float
    band: tuple[float, float]
    gain: float
    power: float
    sensitivity: float


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
    """

    type: str
    beams: tuple[Beam, ...]
    modes: Mapping[str, TrackingMode]
    layer: tuple[float, float, int]
    resolution: float
    range: tuple[float, float]


def read_transceiver(params: Params) -> Transceiver:
    """Read the radio of a `wireless_transmitter` or `wireless_receiver`."""
    block = params.block("transceiver")
    low = block.number("min_frequency", 2412.0, minimum=0)
    high = block.number("max_frequency", 2484.0, minimum=0)
    if low > high:
        block.error("SK-PARAM-002", f"found <min_frequency> {low:g} above <max_frequency> {high:g}; expected min ≤ max")
    return Transceiver(
        essid=block.text("essid", "wireless"),
        frequency=block.number("frequency", 2442.0, minimum=0),
        band=(low, high),
        gain=block.number("gain", 2.5),
        power=block.number("power", 14.5),
        sensitivity=block.number("sensitivity", -90.0, maximum=0),
    )


def read_dvl(params: Params) -> DopplerVelocityLog:
    """Read the `<gz:dvl>` of a Doppler velocity log, with Gazebo's defaults and checks."""
    block = next((child for name in _DVL_ELEMENTS if (child := params.child(name))), params.block("dvl"))
    reach = (block.number("minimum_range", 0.1, minimum=0), block.number("maximum_range", 100.0, minimum=0))
    if reach[0] >= reach[1]:
        block.error("SK-PARAM-002", f"found a range from {reach[0]:g} to {reach[1]:g}; expected min < max")
    modes, layer = _read_tracking(block.block("tracking"), reach[1])
    block.pose("reference_frame")
    return DopplerVelocityLog(
        type=block.choice("type", ("piston", "phased_array"), "piston"),
        beams=_read_beams(block.block("arrangement")),
        modes=modes,
        layer=layer,
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
            velocity, bounds = mode.block("water_velocity"), mode.block("boundaries")
            for axis in "xyz":
                velocity.text(axis, "")
            near, end = bounds.number("near", layer[0], minimum=0), bounds.number("far", layer[1], minimum=0)
            if not near < end <= far:
                message = f"found a layer from {near:g} to {end:g}; expected near < far ≤ the maximum range {far:g}"
                bounds.error("SK-PARAM-002", message)
            layer = (near, end, mode.integer("bins", layer[2], minimum=1))
    return modes, layer


def _read_tag(params: Params) -> None:
    """Read the blocks `<rfid>` and `<rfidtag>`, which have no elements in SDF."""
    for name in ("rfid", "rfidtag"):
        params.child(name)


UNSIMULATED_READERS: Final[Mapping[str, Callable[[Params], object]]] = {
    "rfid": _read_tag,
    "rfidtag": _read_tag,
    "wireless_transmitter": read_transceiver,
    "wireless_receiver": read_transceiver,
    "dvl": read_dvl,
}
"""Reader of each kind's own block."""


def report_sensors_without_model(world: SceneWorld, diagnostics: Diagnostics) -> None:
    """Report the sensors on joints of the world itself; these sensors have no model to belong to."""
    for scene in (sensor for joint in world.joints for sensor in joint.sensors):
        message = f"sensor {scene.scoped!r} is on a joint of the world itself; it is left out"
        diagnostics.warning("SK-SENSOR-053", message, scene.where, "move the joint into one of its two models")


def report_unsimulated(scene: SceneSensor, diagnostics: Diagnostics) -> bool:
    """Read and report a sensor of a kind that is known and not simulated; return False for any other kind."""
    read = UNSIMULATED_READERS.get(scene.kind)
    if read is None:
        return False
    params = scene.params
    for element in _COMMON_ELEMENTS:
        params.child(element)
    read_frame_id(params)
    read(params)
    lost = f", and its plugin {scene.plugins[0].name!r} is ignored" if scene.plugins else ""
    message = f"sensor {scene.scoped!r}: the kind {scene.kind} is not simulated, so the sensor gives no readings{lost}"
    diagnostics.warning("SK-SENSOR-052", message, scene.where)
    for owner in (params, *(child for name in _DVL_ELEMENTS if (child := params.child(name)))):
        owner.report_unread("SK-PARAM-003", f"sensor {scene.scoped!r}")
    return True
