"""Readings that are read after the model has changed: they have the values at the time of their samples."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

import pytest
from sensor_worlds import box, sensor

import simkit
from simkit import msgs
from simkit.pose import Pose

LIDAR = (
    "<lidar><scan><horizontal><samples>5</samples><min_angle>-0.1</min_angle><max_angle>0.1</max_angle></horizontal></scan>"
    "<range><min>0.1</min><max>10</max></range></lidar>"
)


def arm() -> str:
    """Return a world with a wall and a link with sensors on a hinge."""
    sensors = (
        sensor("gpu_lidar", LIDAR, name="lidar", rate=10)
        + sensor("altimeter", "", name="height", rate=10)
        + sensor("imu", "", name="imu", rate=10)
        + sensor("logical_camera", "<logical_camera><far>9</far></logical_camera>", name="eye", rate=10)
    )
    return f"""<sdf version="1.9"><world name="w">{box("wall", "3 0 1 0 0 0", "1 1 1")}
      <model name="arm"><pose>0 0 1 0 0 0</pose><link name="l"><inertial><mass>1</mass></inertial>{sensors}</link>
      <joint name="j" type="revolute"><parent>world</parent><child>l</child><axis><xyz>0 0 1</xyz></axis></joint>
      </model></world></sdf>"""


def is_put_elsewhere(sim: Any) -> None:
    sim.model("arm").set_pose(Pose((1.0, 0.1, 1.3)))


def has_another_limit(sim: Any) -> None:
    sim.joint("arm::j").lower = 0.5


def read(change: Callable[[Any], None], is_read: bool, *, back: bool = False) -> dict[str, bytes]:
    """Return the newest reading of each sensor after a change; with `is_read`, sensors have subscribers before."""
    with simkit.load(arm()) as sim:
        for one in sim.contents.sensors.values() if is_read else ():
            for topic in one._topics.values():
                sim.subscribe(topic)
        sim.run(0.1)
        before = sim.snapshot()
        if back:
            sim.run(0.1)
        change(sim)
        if back:
            sim.run(0.1)
            sim.restore(before)
        return {name: msgs.serialize(one.latest) for name, one in sim.contents.sensors.items()}


@pytest.mark.parametrize("back", [False, True])
@pytest.mark.parametrize("change", [is_put_elsewhere, has_another_limit], ids=lambda change: change.__name__)
def test_a_reading_that_is_read_later_is_the_same(change: Callable[[Any], None], back: bool) -> None:
    assert read(change, False, back=back) == read(change, True, back=back)


def test_a_new_pose_shows_in_the_next_reading() -> None:
    with simkit.load(arm()) as sim:
        sim.run(0.1)
        first = sim.sensor("arm::l::lidar").latest.ranges[2]
        is_put_elsewhere(sim)
        assert sim.sensor("arm::l::lidar").latest.ranges[2] == first == pytest.approx(2.5)
        sim.run(0.1)
        assert sim.sensor("arm::l::lidar").latest.ranges[2] == pytest.approx(1.5)


class ReadsInHooks(simkit.WorldPlugin):
    """Reads all sensors in its hooks; at a tick, begins to listen to one of them."""

    before_step_rate, after_step_rate = 30.0, 70.0

    def __init__(self, listens_at: int) -> None:
        self.listens_at = listens_at
        self.seen: list[object] = []

    def load(self, parent: Any, params: simkit.Params) -> None:
        self.heard: list[object] = []

    def before_step(self) -> None:
        self.read()

    def after_step(self) -> None:
        self.read()
        if self.sim.tick == self.listens_at:
            self.sim.subscribe("/imu", lambda message: self.heard.append(msgs.serialize(message)))

    def read(self) -> None:
        for name, one in self.sim.contents.sensors.items():
            self.seen.append(
                (self.sim.tick, name, one.count, None if one.latest is None else msgs.serialize(one.latest))
            )


def spinning(rates: tuple[float, float, float]) -> str:
    noise = "<noise type='gaussian'><stddev>0.01</stddev></noise>"
    imu = f"<topic>/imu</topic><imu><angular_velocity><z>{noise}</z></angular_velocity></imu>"
    sensors = sensor("imu", imu, name="imu", rate=rates[0]) + sensor("altimeter", "", name="height", rate=rates[1])
    sensors += sensor("gpu_lidar", LIDAR, name="lidar", rate=rates[2])
    return f"""<sdf version="1.9"><world name="w">{box("wall", "3 0 1 0 0 0", "1 1 1")}
      <model name="m"><pose>0 0 1 0.1 0.2 0</pose><link name="l"><inertial><mass>1</mass></inertial>{sensors}</link>
      </model></world></sdf>"""


@pytest.mark.parametrize("rates", [(200.0, 50.0, 10.0), (130.0, 170.0, 7.0)])
@pytest.mark.parametrize("listens_at", [0, 60, 101])
def test_hooks_and_programs_read_unread_sensors_like_read_ones(
    rates: tuple[float, float, float], listens_at: int
) -> None:
    results = []
    for is_read in (False, True):
        plugin = ReadsInHooks(listens_at)
        with simkit.load(spinning(rates), plugins=[plugin]) as sim:
            for one in sim.contents.sensors.values() if is_read else ():
                for topic in one._topics.values():
                    sim.subscribe(topic)
            for steps in (1, 2, 61, 7, 40, 3, 200):
                sim.step(steps)
                plugin.read()
        results.append((plugin.seen, plugin.heard))
    assert results[0] == results[1]
