"""Codes about robots that stand alone, without the world that they are made for."""

from __future__ import annotations

from simkit.codes import Code
from simkit.codes.sketch import INERTIAL, model

_SOLAR = f"""
<link name="base">{INERTIAL}</link>
<plugin name="solar" filename="libsolar_sensor.so"><light_name>sun</light_name></plugin>
"""

CODES: tuple[Code, ...] = (
    Code(
        "SK-PLUGIN-009",
        "note",
        "a bare model's solar sensor has no light to look at: it publishes nothing",
        "run it in a world that has the light",
        model(_SOLAR),
    ),
)
