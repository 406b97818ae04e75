"""Planar laser scanners of SICK."""

from __future__ import annotations

from simkit.sensors.presets.blocks import lidar, sweep
from simkit.sensors.presets.preset import Preset, Settings

_TIM = "SICK TiM55x/TiM56x, technical data 8015886 (2014-08-27): typical statistical error (1 σ) 20 mm; {}"
_LMS = "SICK LMS1xx operating instructions 8012471, data sheets: typical statistical error (1 σ) 12 mm, at 25 Hz"
_SYSTEMATIC = "the systematic error (up to ±{} mm) is left out"


def _around_the_front(samples: int, low: float, high: float, stddev: float) -> Settings:
    return lidar(sweep(samples, -135.0, 135.0), low, high, stddev)


PRESETS = (
    Preset(
        "TiM551",
        "lidar",
        "SICK",
        _TIM.format("TIM551-2050001"),
        _around_the_front(271, 0.05, 10.0, 0.02),
        rate=15.0,
        remark=_SYSTEMATIC.format(60),
    ),
    Preset(
        "TiM561",
        "lidar",
        "SICK",
        _TIM.format("TIM561-2050101"),
        _around_the_front(811, 0.05, 10.0, 0.02),
        rate=15.0,
        remark=_SYSTEMATIC.format(60),
    ),
    Preset(
        "TiM571",
        "lidar",
        "SICK",
        "SICK TIM571-2050101 data sheet: working range, angular resolution, statistical error",
        _around_the_front(811, 0.05, 25.0, 0.02),
        rate=15.0,
        remark=_SYSTEMATIC.format(60) + "; the deviation is that of the TiM561",
        unconfirmed=("stddev",),
    ),
    Preset(
        "LMS111",
        "lidar",
        "SICK",
        _LMS,
        _around_the_front(1081, 0.5, 20.0, 0.012),
        rate=25.0,
        aliases=("LMS100",),
        remark=_SYSTEMATIC.format(30) + "; at 50 Hz it has 541 samples",
    ),
    Preset(
        "LMS151",
        "lidar",
        "SICK",
        _LMS,
        _around_the_front(1081, 0.5, 50.0, 0.012),
        rate=25.0,
        remark=_SYSTEMATIC.format(30) + "; at 50 Hz it has 541 samples",
        unconfirmed=("stddev",),
    ),
)
