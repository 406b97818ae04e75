"""Samples that are serialised together have the bytes of their messages, whatever happens during the run."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from pathlib import Path

import pytest
from mcap.reader import make_reader

import simkit
from simkit import msgs
from simkit.recording.bags.recorder import Recorder
from simkit.runtime import Simulation
from simkit.sensors.sample_packing import MOST_SAMPLES, PackedMessage

WORLD = """
<sdf version="1.9"><world name="w">
  <model name="ball"><pose>0 0 50 0.1 0.2 0.3</pose>
    <link name="body">
      <inertial><mass>1</mass><inertia><ixx>0.1</ixx><iyy>0.2</iyy><izz>0.3</izz></inertia></inertial>
      <sensor name="imu" type="imu"><pose>0.1 0 0 {roll} 0 0</pose><update_rate>{rate}</update_rate><topic>imu</topic>
        <imu>{extra}<angular_velocity><x><noise type="gaussian"><mean>0.01</mean><stddev>0.1</stddev></noise></x>
        </angular_velocity></imu>
      </sensor>
    </link>
  </model>
</world></sdf>
"""
PLAIN = {"roll": "0", "rate": "500", "extra": ""}
Action = Callable[[Simulation], object]


def nothing(_: Simulation) -> None:
    pass


def spin(sim: Simulation) -> None:
    sim.link("ball::body").set_velocity((0.0, 0.0, 0.0), (1.0, 2.0, 3.0))


def restore(sim: Simulation) -> None:
    snapshot = sim.snapshot()
    sim.run(0.1)
    sim.restore(snapshot)


def turn_reference(sim: Simulation) -> None:
    sim.sensor("ball::body::imu").rotate_orientation((0.0, 0.0, 1.0))


ACTIONS: dict[str, Action] = {
    "nothing": nothing,
    "spin": spin,
    "reset": lambda sim: sim.reset(seed=5),
    "restore": restore,
    "rate": lambda sim: sim.sensor("ball::body::imu").set_rate(100.0),
    "latest": lambda sim: sim.sensor("ball::body::imu").latest,
    "frame": lambda sim: sim.sensor("ball::body::imu").set_frame_id("other"),
    "reference": turn_reference,
    "other noise": lambda sim: setattr(sim.sensor("ball::body::imu"), "noise", 0.2),
    "more noise": lambda sim: sim.sensor("ball::body::imu").add_white_noise(0.1),
    "spawn": lambda sim: sim.spawn('<sdf version="1.9"><model name="rock"><link name="a"/></model></sdf>'),
    "listen": lambda sim: sim.subscribe("/imu", lambda _: None),
}


def run(sim: Simulation, action: Action) -> None:
    sim.run(0.31)
    action(sim)
    sim.run(1.2)


def recorded(path: Path) -> Iterator[bytes]:
    with path.open("rb") as file:
        for _, channel, message in make_reader(file).iter_messages(log_time_order=False):
            assert channel.topic == "/imu"
            yield message.data


@pytest.mark.parametrize("action", ACTIONS)
def test_a_recording_has_the_bytes_of_messages_that_are_made_at_once(tmp_path: Path, action: str) -> None:
    made: list[bytes] = []
    with simkit.load(WORLD.format(**PLAIN)) as sim:
        sim.communication.bus.tap("/imu", lambda message: made.append(msgs.serialize(message)))
        run(sim, ACTIONS[action])
    with simkit.load(WORLD.format(**PLAIN)) as sim, Recorder(sim, tmp_path / "a.mcap", topics=("/imu",)):
        run(sim, ACTIONS[action])
    assert list(recorded(tmp_path / "a.mcap")) == made
    assert len(made) > 250


@pytest.mark.parametrize("keep", [None, 30])
@pytest.mark.parametrize("action", ACTIONS)
def test_a_subscription_keeps_the_messages_that_a_callback_receives(action: str, keep: int | None) -> None:
    made: list[bytes] = []
    with simkit.load(WORLD.format(**PLAIN)) as sim:
        sim.communication.bus.tap("/imu", lambda message: made.append(msgs.serialize(message)))
        run(sim, ACTIONS[action])
    with simkit.load(WORLD.format(**PLAIN)) as sim:
        kept = sim.subscribe("/imu", keep=keep)
        run(sim, ACTIONS[action])
        assert list(map(msgs.serialize, kept.messages)) == made[-keep if keep else 0 :]


@pytest.mark.parametrize(
    "changed",
    [
        {"roll": "0.5"},
        {"extra": "<enable_orientation>false</enable_orientation>"},
        {"extra": "<orientation_reference_frame><localization>ENU</localization></orientation_reference_frame>"},
        {"rate": "0"},
    ],
)
def test_the_bytes_are_those_of_the_messages_for_any_options_of_the_sensor(
    tmp_path: Path, changed: dict[str, str]
) -> None:
    world, path = WORLD.format(**{**PLAIN, **changed}), tmp_path / "a.mcap"
    with simkit.load(world) as sim, Recorder(sim, path, topics=("/imu",)):
        spin(sim)
        kept = sim.subscribe("/imu")
        sim.run(0.5)
        assert list(map(msgs.serialize, kept.messages))[-1] == msgs.serialize(sim.sensor("ball::body::imu").latest)
    assert list(recorded(path)) == [msgs.serialize(message) for message in kept.messages]


LIDAR = """
<sdf version="1.9"><world name="w">
  <model name="wall"><static>true</static><pose>2 0 0 0 0 0</pose>
    <link name="a"><collision name="c"><geometry><box><size>1 4 200</size></box></geometry></collision></link></model>
  <model name="ball"><pose>0 0 50 0 0 0.3</pose>
    <link name="body">
      <inertial><mass>1</mass><inertia><ixx>0.1</ixx><iyy>0.2</iyy><izz>0.3</izz></inertia></inertial>
      <sensor name="lidar" type="lidar"><update_rate>100</update_rate><topic>scan</topic>
        <lidar><scan><horizontal><samples>37</samples><min_angle>-2</min_angle><max_angle>2</max_angle></horizontal>
        <vertical><samples>3</samples><min_angle>-0.1</min_angle><max_angle>0.1</max_angle></vertical></scan>
        <range><min>0.2</min><max>3</max></range>
        <noise><type>gaussian</type><mean>0.001</mean><stddev>0.5</stddev></noise></lidar>
      </sensor>
    </link>
  </model>
</world></sdf>
"""


def change_frame(sim: Simulation) -> None:
    sim.sensor("ball::body::lidar").set_frame_id("other")


def add_ray_noise(sim: Simulation) -> None:
    sim.sensor("ball::body::lidar").add_ray_noise(0.1)


LIDAR_ACTIONS: dict[str, Action] = {
    "nothing": nothing,
    "reset": lambda sim: sim.reset(seed=5),
    "restore": restore,
    "rate": lambda sim: sim.sensor("ball::body::lidar").set_rate(50.0),
    "frame": change_frame,
    "noise": lambda sim: setattr(sim.sensor("ball::body::lidar"), "noise", 0.2),
    "more noise": add_ray_noise,
    "spawn": lambda sim: sim.spawn('<sdf version="1.9"><model name="rock"><link name="a"/></model></sdf>'),
    "listen": lambda sim: sim.subscribe("/scan", lambda _: None),
    "keep": lambda sim: sim.subscribe("/scan"),
    "clouds": lambda sim: sim.communication.bus.tap("/scan/points", lambda _: None, takes_later=True),
}


@pytest.mark.parametrize("action", LIDAR_ACTIONS)
def test_a_recording_of_a_lidar_has_the_bytes_of_scans_that_are_made_at_once(tmp_path: Path, action: str) -> None:
    made: list[bytes] = []
    with simkit.load(LIDAR) as sim:
        sim.communication.bus.tap("/scan", lambda message: made.append(msgs.serialize(message)))
        run(sim, LIDAR_ACTIONS[action])
    with simkit.load(LIDAR) as sim, Recorder(sim, tmp_path / "a.mcap", topics=("/scan",)):
        run(sim, LIDAR_ACTIONS[action])
        assert (sim.sensor("ball::body::lidar")._group is not None) == (action not in ("listen", "keep", "clouds"))
    with (tmp_path / "a.mcap").open("rb") as file:
        found = [message.data for _, _, message in make_reader(file).iter_messages(log_time_order=False)]
    assert found == made
    assert len(made) > 90


def test_a_recorded_sensor_makes_no_message_and_counts_its_samples(tmp_path: Path) -> None:
    with simkit.load(WORLD.format(**PLAIN)) as sim:
        received: list[object] = []
        sim.communication.bus.tap("/imu", received.append, takes_later=True)
        sim.run(0.02)
        assert [type(message) for message in received] == [PackedMessage] * 11
        assert sim.sensor("ball::body::imu").count == 11
        assert received[3].serialised() == ("sensor_msgs/msg/Imu", msgs.serialize(received[3].get()))  # type: ignore[attr-defined]


def test_a_group_of_samples_that_nobody_serialises_stays_bounded() -> None:
    with simkit.load(WORLD.format(**{**PLAIN, "rate": "0"})) as sim:
        sim.communication.bus.tap("/imu", lambda _: None, takes_later=True)
        sim.run(5.0)
        group = sim.sensor("ball::body::imu")._group
        assert group is not None
        assert len(group.ticks) == 5000 - MOST_SAMPLES
        assert sim.sensor("ball::body::imu").count == 5000
