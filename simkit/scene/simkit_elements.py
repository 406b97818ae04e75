"""simkit's own elements, for data that SDF has no element for.

They are read with their plain name and with simkit's prefix: `<latency>` and `<simkit:latency>`. Files are written
with the prefix, because Gazebo ignores prefixed elements without a message.
"""

from __future__ import annotations

from collections.abc import Mapping
from types import MappingProxyType
from typing import Final

PREFIX: Final = "simkit:"

OWN_ELEMENTS: Final[Mapping[str, frozenset[str]]] = MappingProxyType(
    {
        "world": frozenset({"entity_services", "gazebo_quirks", "renderer"}),
        "actor": frozenset({"person"}),
        "scene": frozenset({"quality", "renderer"}),
        "light": frozenset({"irradiance"}),
        "collision": frozenset({"reflectivity", "specularity", "transmittance"}),
        "visual": frozenset({"reflectivity", "specularity", "transmittance"}),
        "sensor": frozenset(
            {"dropout", "encoder", "jitter", "latency", "latency_jitter", "phase", "preset", "set_rate_topic", "solar"}
            | {"exposure_control", "image_sensor", "shutter", "tone_curve", "vignetting", "white_balance"}
            | {"depth_error", "depth_holes", "flying_pixels", "lost_depth", "multipath", "occlusion_shadow"}
            | {"phase_wrap", "point_layout", "scan_pattern", "sweep"}
            | {"bandwidth", "calibration_error", "clock", "gaps", "latency_histogram", "saturation"}
            | {"fix_types", "multipath", "outages"}
            | {"beam", "blind_zone", "glass_and_mirrors", "intensity", "no_return", "range_error", "signal", "sun"}
        ),
        "noise": frozenset({"bias_instability", "correlation_time", "noise_density", "random_walk"}),
        "camera": frozenset({"disparity_noise"}),
        "imu": frozenset({"orientation"}),
        "magnetometer": frozenset({"date"}),
        "sonar": frozenset({"axis", "noise"}),
        "plugin": frozenset(
            {"actuation_error", "controllers", "interpolation", "odometry_noise", "on_error", "point_times"}
            | {"pose_type", "ros2_control", "shadow_gz"}
        ),
    }
)
"""SDF element -> names of simkit's own elements in it. Elements inside these, or inside a plugin, need no prefix."""


def written_name(name: str, parent: str) -> str:
    """Return the name of an element in a file for Gazebo: with simkit's prefix if the element is simkit's own."""
    return PREFIX + name if name in OWN_ELEMENTS.get(parent, ()) else name
