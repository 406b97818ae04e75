"""Presets of sensors."""

from __future__ import annotations

from simkit.codes import Code
from simkit.codes.sketch import sensor

CODES: tuple[Code, ...] = (
    Code(
        "SK-SENSOR-090",
        "error",
        "there is no preset of that name",
        "the closest name is given, and those of the kind are listed; [all of them](sensors/presets.md)",
        sensor("imu", "<preset>BMI808</preset>"),
    ),
    Code(
        "SK-SENSOR-091",
        "error",
        "a preset of another kind of sensor",
        "those of the kind are listed",
        sensor("imu", "<preset>LDS-01</preset>"),
    ),
    Code(
        "SK-SENSOR-092",
        "note",
        "what a preset gave that the file does not say itself",
        "`simkit inspect` shows the result",
        sensor("lidar", "<preset>LDS-01</preset>\n<lidar><range><max>2</max></range></lidar>"),
    ),
)
