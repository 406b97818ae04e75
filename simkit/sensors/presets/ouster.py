"""Lidars of Ouster with evenly spaced beams."""

from __future__ import annotations

from simkit.sensors.presets.blocks import lidar, sweep, turn
from simkit.sensors.presets.preset import Preset


def _os0(beams: int) -> Preset:
    return Preset(
        f"OS0-{beams}",
        "lidar",
        "Ouster",
        "Ouster OS0 data sheet, Rev 06 sensors, optical performance, mode 1024x10",
        lidar(turn(1024), 0.5, 50.0, 0.0, sweep(beams, -45.0, 45.0)),
        rate=10.0,
        remark="no noise: its precision changes with range and target",
    )


def _os1(beams: int) -> Preset:
    return Preset(
        f"OS1-{beams}",
        "lidar",
        "Ouster",
        "Ouster OS1 data sheet, Rev 06 sensors, optical performance, mode 1024x10",
        lidar(turn(1024), 0.5, 100.0, 0.01, sweep(beams, -22.5, 22.5)),
        rate=10.0,
        remark="deviation: the precision (1 σ) from 1 to 20 m; beyond, it is 2 cm, from 50 m on 5 cm",
    )


PRESETS = (*(_os0(n) for n in (32, 64, 128)), *(_os1(n) for n in (32, 64, 128)))
