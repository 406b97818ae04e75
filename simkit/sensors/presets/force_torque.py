"""Force and torque sensors."""

from __future__ import annotations

from simkit.sensors.presets.blocks import axes, gaussian, quantized
from simkit.sensors.presets.preset import Preset, Settings

_ATI = "ATI F/T transducer manual, {}: resolution with 16 bit, calibration {}"
_ONROBOT = "OnRobot {} data sheet: signal noise, typical (1 σ of one second without load)"


def _counted(force: float, force_z: float, torque: float, torque_z: float) -> Settings:
    """Steps [N, N·m] of x and y, and of z."""
    forces = axes(quantized(precision=force), z=quantized(precision=force_z))
    return {
        "force_torque": {"force": forces, "torque": axes(quantized(precision=torque), z=quantized(precision=torque_z))}
    }


def _noisy(force: float, force_z: float, torque: float, torque_z: float) -> Settings:
    """Deviations [N, N·m] of x and y, and of z."""
    forces = axes(gaussian(stddev=force), z=gaussian(stddev=force_z))
    return {"force_torque": {"force": forces, "torque": axes(gaussian(stddev=torque), z=gaussian(stddev=torque_z))}}


PRESETS = (
    Preset(
        "ATI Mini40",
        "force_torque",
        "ATI",
        _ATI.format("Mini40", "SI-40-2"),
        _counted(1 / 100, 1 / 50, 1 / 4000, 1 / 4000),
        aliases=("Mini40", "Mini40 SI-40-2"),
        remark="only its counts: no noise is published",
        unconfirmed=("precision",),
    ),
    Preset(
        "ATI Mini45",
        "force_torque",
        "ATI",
        _ATI.format("Mini45", "SI-290-10"),
        _counted(1 / 8, 1 / 8, 1 / 376, 1 / 752),
        aliases=("Mini45", "Mini45 SI-290-10"),
        remark="only its counts: no noise is published",
        unconfirmed=("precision",),
    ),
    Preset(
        "OnRobot HEX-E",
        "force_torque",
        "OnRobot",
        _ONROBOT.format("HEX-E"),
        _noisy(0.035, 0.15, 0.002, 0.001),
        aliases=("HEX-E", "HEX-E QC"),
        unconfirmed=("stddev",),
    ),
    Preset(
        "OnRobot HEX-H",
        "force_torque",
        "OnRobot",
        _ONROBOT.format("HEX-H"),
        _noisy(0.1, 0.2, 0.006, 0.002),
        aliases=("HEX-H", "HEX-H QC"),
        unconfirmed=("stddev",),
    ),
)
