"""Rotary encoders."""

from __future__ import annotations

from simkit.sensors.presets.blocks import DEGREE, gaussian
from simkit.sensors.presets.preset import Preset

PRESETS = (
    Preset(
        "AMT102",
        "encoder",
        "CUI Devices",
        "CUI Devices AMT10 series data sheet (2019-11-21): 2048 pulses a turn, counted in quadrature",
        {"encoder": {"counts_per_revolution": 8192, "absolute": False}},
        aliases=("AMT102-V",),
        remark="its accuracy of 0.25° is left out",
    ),
    Preset(
        "AS5048A",
        "encoder",
        "ams",
        "AS5048A/B data sheet: 14 bit, output noise 0.06° (1 σ)",
        {"encoder": {"counts_per_revolution": 16384, "position": gaussian(stddev=0.06 * DEGREE)}},
        aliases=("AS5048B",),
        remark="its non-linearity is left out",
        unconfirmed=("stddev",),
    ),
    Preset(
        "AS5600",
        "encoder",
        "ams",
        "AS5600 data sheet v1-06: 12 bit, RMS noise 0.015° (1 σ) with the slowest filter, SF = 00",
        {"encoder": {"counts_per_revolution": 4096, "position": gaussian(stddev=0.015 * DEGREE)}},
        remark="its non-linearity is left out",
    ),
)
