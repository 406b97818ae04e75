"""Thermal cameras and temperatures."""

from __future__ import annotations

from simkit.codes import Code
from simkit.codes.sketch import sensor, static

_IMAGE = "<image><width>64</width><height>48</height>{}</image>"


def _thermal(content: str) -> str:
    return (
        '<visual name="plate">\n  <geometry><box><size>1 1 1</size></box></geometry>\n'
        f'  <plugin filename="gz-sim-thermal-system" name="gz::sim::systems::Thermal">\n    {content}\n  </plugin>\n'
        "</visual>"
    )


CODES: tuple[Code, ...] = (
    Code(
        "SK-SENSOR-140",
        "warning",
        "a thermal camera has a pixel format that no temperature fits into; its pictures are L16",
        "`<format>L16</format>` (steps of 0.01 K) or `L8` (3 K)",
        sensor("thermal_camera", f"<camera>{_IMAGE.format('<format>R8G8B8</format>')}</camera>"),
    ),
    Code(
        "SK-SENSOR-141",
        "warning",
        "a temperature, or a setting of one, has no effect or another one than written",
        "temperatures are in kelvin, from 0 up, and belong into a `<visual>`",
        static(_thermal("<temperature>-20</temperature>")),
    ),
    Code(
        "SK-SENSOR-142",
        "warning",
        "the picture of a heat signature is not found or cannot be read; its surface is as warm as the air",
        "the path is taken beside the file that names it; `model://` and `package://` work too",
        static(_thermal("<heat_signature>warm.png</heat_signature>\n    <max_temp>310</max_temp>")),
    ),
)
