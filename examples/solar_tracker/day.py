"""The day of two solar panels, one that follows the sun and one on a stand: `python day.py`."""

from __future__ import annotations

import importlib.util
import sys
from pathlib import Path
from typing import NamedTuple

import numpy as np

import simkit
from simkit.install_command import install_command

FOLDER = Path(__file__).resolve().parent
SENSORS = {"tracker": "tracker::panel::sun", "stand": "stand::panel::sun"}
START, TIME_SCALE = 2.0, 1200.0  # [h] UTC, and how many times faster the sun goes, both as in the world
LENGTH = 18.0  # [h]


class Day(NamedTuple):
    """What a panel had of a day, a reading every two minutes.

    Attributes:
        hours: UTC [h].
        power: [W].
        incidence: angle between the panel's normal and the sun [rad].
        shadow: what stood in the way; empty texts where nothing did.
    """

    hours: np.ndarray
    power: np.ndarray
    incidence: np.ndarray
    shadow: np.ndarray

    @property
    def energy(self) -> float:
        """[W·h]"""
        return float(np.sum(self.power) * (self.hours[1] - self.hours[0]))


def run(seed: int = 0) -> dict[str, Day]:
    """Runs the world through the day; one record a panel."""
    if importlib.util.find_spec("pvlib") is None:
        sys.exit(f"the path of the sun needs pvlib: {install_command('sun')}")
    with simkit.load(FOLDER / "world.sdf", plugin_paths=[FOLDER], seed=seed) as sim:
        sensors = {name: sim.sensor(scoped) for name, scoped in SENSORS.items()}
        readings = {name: [] for name in sensors}
        hours = []
        for _ in range(round(LENGTH * 3600 / TIME_SCALE * 10)):
            sim.run(0.1)
            hours.append(START + sim.time * TIME_SCALE / 3600)
            for name, sensor in sensors.items():
                readings[name].append(sensor.reading)
    return {
        name: Day(
            np.array(hours),
            np.array([r.power for r in found]),
            np.array([r.incidence for r in found]),
            np.array([r.shadow for r in found]),
        )
        for name, found in readings.items()
    }


if __name__ == "__main__":
    for name, day in run().items():
        shaded = sorted({str(s) for s in day.shadow} - {""})
        print(f"{name}: {day.energy:.0f} W·h, at most {day.power.max():.0f} W, in the shadow of {', '.join(shaded)}")
