"""A plugin that moves scenery does so at its own rate, and before each sample of a sensor that sees the scene."""

from __future__ import annotations

import pytest

import simkit
from simkit.sensors.rays.sonar import Sonar

WORLD = """<sdf version="1.9"><world name="w"><model name="m"><static>1</static><link name="l">
<sensor name="blind" type="imu"><update_rate>20</update_rate></sensor>{sensor}</link></model></world></sdf>"""
SONAR = '<sensor name="seeing" type="sonar"><update_rate>10</update_rate><sonar/></sensor>'


class Curtain(simkit.WorldPlugin):
    """Scenery that remembers at which ticks it was moved."""

    scenery_rate = 4.0

    def load(self, parent: object, params: simkit.Params) -> None:
        self.ticks: list[int] = []

    def move_scenery(self) -> None:
        self.ticks.append(self.sim.tick)


def moved_at(sensor: str) -> list[int]:
    curtain = Curtain()
    with simkit.load(WORLD.format(sensor=sensor), plugins=[curtain]) as sim:
        sim.run(0.5)
    return sorted(set(curtain.ticks))


def test_scenery_moves_at_the_samples_of_sensors_that_see_it() -> None:
    without, with_sonar = moved_at(""), moved_at(SONAR)
    assert without[-2:] == [250, 500] and 50 not in without  # 4 Hz, not the 20 Hz of the IMU
    assert {100, 200, 300, 400} <= {*with_sonar} and 50 not in with_sonar


def test_a_class_says_whether_its_sensors_see_the_scene(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(Sonar, "sees_scene", False)
    assert moved_at(SONAR) == moved_at("")
