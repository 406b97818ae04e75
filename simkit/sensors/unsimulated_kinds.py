"""Sensor kinds of SDF that simkit knows and does not simulate: they are read in full, checked and reported.

They are radios (`wireless_transmitter`, `wireless_receiver`) and tags (`rfid`, `rfidtag`). Gazebo does not simulate
them either; Gazebo Classic did.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass
from typing import Final

from simkit.diagnostics import Diagnostics
from simkit.params import Params
from simkit.scene import SceneSensor, SceneWorld
from simkit.sensors.topics_and_frames import read_frame_id

_COMMON_ELEMENTS = ("always_on", "visualize", "enable_metrics", "pose", "update_rate", "topic")


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


def _read_tag(params: Params) -> None:
    """Read the blocks `<rfid>` and `<rfidtag>`, which have no elements in SDF."""
    for name in ("rfid", "rfidtag"):
        params.child(name)


UNSIMULATED_READERS: Final[Mapping[str, Callable[[Params], object]]] = {
    "rfid": _read_tag,
    "rfidtag": _read_tag,
    "wireless_transmitter": read_transceiver,
    "wireless_receiver": read_transceiver,
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
    params.report_unread("SK-PARAM-003", f"sensor {scene.scoped!r}")
    return True
