"""`worlds/sensor_bench.sdf` has one of every kind of sensor, and each says what it should, as often as it should."""

from __future__ import annotations

import hashlib
import json
import os
import subprocess
import sys
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from lxml import etree

import simkit
from simkit import msgs
from simkit.sensors import sensor_kinds

ROOT = Path(__file__).resolve().parents[2]
WORLD = ROOT / "worlds" / "sensor_bench.sdf"
DURATION = 1.0  # [s]


@pytest.fixture(scope="module")
def heard() -> Any:
    """Sensor -> its topics -> (time of arrival [s], message), of one second."""
    found: dict[str, dict[str, list[tuple[float, Any]]]] = {}
    with simkit.load("sensor_bench", seed=7) as sim:
        for name, sensor in sim.contents.sensors.items():
            found[name] = {}
            for topic in sensor._topics.values():
                kept = found[name][topic] = []
                sim.communication.bus.tap(topic, lambda message, kept=kept: kept.append((sim.time, message)))
        sim.run(DURATION)
        yield sim, found


# ------------------------------------------------------------------ what is there


def test_every_kind_is_in_it() -> None:
    """By one of its names, or of a kind that it extends; of one class, kinds that look at different things both."""
    with simkit.load("sensor_bench") as sim:
        here = {sensor.kind for sensor in sim.contents.sensors.values()}
        lidars = {s.kind: s.options for s in sim.contents.sensors.values() if s.kind in ("lidar", "gpu_lidar")}
    names: dict[type, set[str]] = {}
    for kind, cls in sensor_kinds().items():
        names.setdefault(cls, set()).add(kind)
    classes = {cls for cls, kinds in names.items() if kinds & here}
    missing = [sorted(kinds) for cls, kinds in names.items() if not kinds & here and cls.__base__ not in classes]
    assert not missing
    assert set(lidars) == {"lidar", "gpu_lidar"}


def test_it_is_clean_under_strict() -> None:
    with simkit.load(WORLD, strict=True) as sim:
        assert [str(d) for d in sim.diagnostics if d.severity != "note"] == []


def test_no_two_sensors_share_a_topic() -> None:
    with simkit.load("sensor_bench") as sim:
        topics = [topic for sensor in sim.contents.sensors.values() for topic in sensor._topics.values()]
    assert len(topics) == len(set(topics))


def test_what_is_simkits_own_has_a_prefix() -> None:
    """So Gazebo, which knows none of it, passes over it without a word."""
    own = {"preset", "encoder", "solar", "axis_of_cone", "quality", "irradiance"}
    for element in etree.parse(WORLD).iter(etree.Element):
        if not element.tag.startswith("{simkit}"):
            assert element.tag not in own, element.sourceline


# ------------------------------------------------------------------ what they say


def test_each_publishes_at_its_rate(heard: Any) -> None:
    """The first at the first step, then on the grid of its rate."""
    sim, found = heard
    for name, topics in found.items():
        rate = sim.sensor(name).update_rate
        assert rate > 0
        for topic, messages in topics.items():
            assert len(messages) == round(rate * DURATION) + 1, topic
            times = [time for time, _ in messages]
            np.testing.assert_allclose(times[1:], np.arange(1, len(times)) / rate, atol=1e-9, err_msg=topic)


def test_each_picture_has_something_in_it(heard: Any) -> None:
    _, found = heard
    pictures = [
        (topic, message)
        for topics in found.values()
        for topic, messages in topics.items()
        for _, message in messages
        if type(message).__name__.endswith("msg__Image")
    ]
    assert len(pictures) > 20
    for topic, picture in pictures:
        assert (picture.width, picture.height) == (320, 240), topic
        assert len(np.unique(np.asarray(picture.data)[::97])) > 4, topic


def test_things_move_in_view(heard: Any) -> None:
    """The carousel turns 0.5236 rad in a second, the pendulum swings, and cameras see it."""
    sim, found = heard
    assert sim.joint("carousel::axle").velocity == pytest.approx(0.5236, rel=0.01)
    assert abs(sim.joint("pendulum::hinge").position) > 0.3
    ((_, first), *_, (_, last)) = found["rover::chassis::camera"]["/rover/camera/image"]
    moved = np.abs(np.asarray(first.data, dtype=int) - np.asarray(last.data, dtype=int)) > 60
    assert moved.mean() > 0.02


def test_the_pad_carries_the_crate_and_the_load_cell_the_pendulum(heard: Any) -> None:
    sim, _ = heard
    contacts = sim.sensor("pad::plate::skin").latest.contacts
    load = {c.collision2.name: sum(w.body_1_wrench.force.z for w in c.wrenches) for c in contacts}
    assert load["crate::link::box"] == pytest.approx(-3 * 9.81, rel=0.01)
    pull = sim.sensor("pendulum::load_cell::wrench").truth.wrench.force
    assert 8 < np.linalg.norm((pull.x, pull.y, pull.z)) < 30  # 1.7 kg that swings


def test_the_rover_drives(heard: Any) -> None:
    with simkit.load("sensor_bench") as sim:
        sim.run(0.2)
        before = sim.model("rover").pose.position
        sim.publish("/cmd_vel", {"linear": {"x": 0.3}})
        sim.run(1.5)
        assert sim.model("rover").pose.position[0] - before[0] == pytest.approx(0.3 * 1.5 - 0.045, abs=0.02)
        assert abs(sim.model("rover").pose.rpy[1]) < 0.02


# ------------------------------------------------------------------ the same bits


def digests(duration: float) -> dict[str, str]:
    """Topic -> a digest of every bit that sensors said on it."""
    sums: dict[str, Any] = {}
    with simkit.load("sensor_bench", seed=7) as sim:
        for sensor in sim.contents.sensors.values():
            for topic in sensor._topics.values():
                kept = sums[topic] = hashlib.blake2b(digest_size=8)
                sim.communication.bus.tap(topic, lambda message, kept=kept: kept.update(msgs.serialize(message)))
        sim.run(duration)
    return {topic: kept.hexdigest() for topic, kept in sums.items()}


@pytest.mark.slow
def test_another_process_hears_the_same_bits() -> None:
    environment = {**os.environ, "PYTHONHASHSEED": "4711", "PYTHONPATH": str(ROOT)}
    done = subprocess.run([sys.executable, __file__], env=environment, capture_output=True, check=True)
    there, here = json.loads(done.stdout), digests(DURATION)
    assert here.keys() == there.keys()
    assert [topic for topic in here if here[topic] != there[topic]] == []


if __name__ == "__main__":
    sys.stdout.write(json.dumps(digests(DURATION)))
