"""Golden runs in tests."""

from __future__ import annotations

from simkit.codes import Code
from simkit.codes.sketch import python

_OPENED = """
from pathlib import Path

from simkit.golden.in_tests import Place, SensorRegression

# what pytest's fixture gives to a test that writes its golden runs
here = Path().absolute()
place = Place(here / "golden", "test_drive", here, "test_drive.py::test_drive", reason="new")
sensor_regression = SensorRegression(place, lambda sim, label: sim.close())
"""

CODES: tuple[Code, ...] = (
    Code(
        "SK-GOLDEN-020",
        "error",
        "a test compares two runs with one golden run",
        'give one of them a name: `sensor_regression("w.sdf", name="second")`',
        python(
            _OPENED
            + """
sensor_regression("empty", duration=0.01)
sensor_regression("empty", duration=0.02)
"""
        ),
    ),
    Code(
        "SK-GOLDEN-021",
        "error",
        "`sensor_regression` cannot use an argument: no tolerance, or not of an open simulation",
        "what is allowed is named",
        python(
            _OPENED
            + """
sensor_regression("empty", duration=0.01, tolerances={"/scan": "statistic"})
"""
        ),
    ),
)
