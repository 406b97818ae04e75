"""Ultrasonic rangers with a published angle; MaxBotix gives beam patterns only, and so is left out."""

from __future__ import annotations

import math

from simkit.sensors.presets.blocks import DEGREE, gaussian
from simkit.sensors.presets.preset import Preset

PRESETS = (
    Preset(
        "HC-SR04",
        "sonar",
        "Elecfreaks",
        "HC-SR04 user guide: 2 cm to 4 m, measuring angle 15°, accuracy up to 3 mm, a cycle of over 60 ms",
        {
            "sonar": {
                "min": 0.02,
                "max": 4.0,
                "radius": round(4.0 * math.tan(7.5 * DEGREE), 6),
                **gaussian(stddev=0.003),
            }
        },
        rate=16.0,
        remark="deviation: our choice, the accuracy of 3 mm; the angle is taken for that of the whole cone",
    ),
)
