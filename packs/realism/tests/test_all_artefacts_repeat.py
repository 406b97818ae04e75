"""All artefacts of all sensors in one moving world repeat their bits, whatever happens between two messages."""

from __future__ import annotations

import hashlib
import os
import pickle
import subprocess
import sys
from functools import partial
from pathlib import Path

import pytest

import simkit
from simkit import msgs
from simkit.sensors.artefacts import artefact_kinds

SEED, LENGTH = 7, 0.4
LIDAR = """<lidar><scan><horizontal><samples>60</samples><min_angle>-3</min_angle><max_angle>3</max_angle></horizontal>
  </scan><range><min>0.1</min><max>20</max></range></lidar>"""
CAMERA = """<camera><image><width>32</width><height>24</height></image><clip><near>0.1</near><far>20</far></clip>
  </camera>"""
MESSAGES = {
    "latency_histogram": "<values>0.01 0.05 0.13</values><weights>3 1 1</weights>",
    "gaps": "<probability>0.1</probability><mean_length>2</mean_length>",
    "clock": "<offset>0.01</offset><drift>1e-5</drift>",
}
FAMILIES = {
    "imu": ("<imu/>", 100, {
        "calibration_error": "<angular_velocity><scale>0.01 0.01 0.01</scale></angular_velocity>",
        "bandwidth": "<angular_velocity>40</angular_velocity><order>2</order>",
        "saturation": "<angular_velocity>4</angular_velocity>",
    }),
    "navsat": ("<navsat/>", 20, {
        "outages": "<rate>0.5</rate>",
        "multipath": "<stddev>3</stddev>",
        "fix_types": "<fix><stddev>1</stddev></fix>",
    }),
    "lidar": (LIDAR, 10, {
        "no_return": "<value>zero</value>",
        "blind_zone": "<range>1</range><probability>0.5</probability>",
        "dropout": "<probability>0.2</probability><burst_length>3</burst_length>",
        "sun": "<azimuth>1</azimuth><probability>0.5</probability>",
        "range_error": "<stddev>0.01</stddev>",
        "signal": "<range>6</range>",
        "glass_and_mirrors": "",
        "intensity": "<stddev>0.1</stddev>",
        "beam": "<divergence>0.01</divergence>",
        "sweep": "<duration>0.08</duration>",
        "point_layout": "velodyne",
    }),
    "gpu_lidar": (LIDAR, 10, {
        "scan_pattern": "<samples>50</samples><spiral><azimuth_rate>20</azimuth_rate><elevation_rate>3</elevation_rate>"
        "<min_angle>-0.1</min_angle><max_angle>0.9</max_angle></spiral>",
    }),
    "depth_camera": (CAMERA, 10, {
        "depth_error": "<stddev>0.002</stddev><coefficient>0.0019</coefficient><exponent>2</exponent>",
        "depth_holes": "<probability>0.1</probability><correlation_length>5</correlation_length>"
        "<correlation_time>0.5</correlation_time>",
        "occlusion_shadow": "<baseline>0.05</baseline>",
        "flying_pixels": "",
        "multipath": "",
        "phase_wrap": "<range>3.75</range>",
        "lost_depth": "<value>nan</value>",
    }),
    "camera": (CAMERA, 10, {
        "shutter": "<type>rolling</type><line_time>0.001</line_time><exposure>0.01</exposure>",
        "vignetting": "",
        "exposure_control": "<mode>auto</mode>",
        "image_sensor": "<read_noise>5</read_noise>",
        "white_balance": "<gains>0.9 1 1.1</gains>",
        "tone_curve": "<gamma>2</gamma>",
    }),
}  # fmt: skip
"""Block, update rate, and content of each element."""


def sensor(kind: str) -> str:
    """Return a `<sensor>` with all elements, jitter and late messages."""
    block, rate, elements = FAMILIES[kind]
    parts = "".join(f"<simkit:{name}>{text}</simkit:{name}>" for name, text in {**elements, **MESSAGES}.items())
    return f"""<sensor name="{kind}" type="{kind}"><update_rate>{rate}</update_rate><topic>{kind}</topic>
      <simkit:jitter>0.003</simkit:jitter>{block}{parts}</sensor>"""


WORLD = f"""<sdf version="1.9" xmlns:simkit="simkit"><world name="w"><gravity>0 0 0</gravity>
  <spherical_coordinates><latitude_deg>48</latitude_deg><longitude_deg>11</longitude_deg></spherical_coordinates>
  <model name="m"><pose>0 0 0.5 0 0 0</pose><link name="l"><inertial><mass>1</mass></inertial>
  {"".join(map(sensor, FAMILIES))}</link></model>
  <model name="box"><pose>2 0.3 0.5 0 0 0</pose><link name="l"><inertial><mass>1</mass></inertial>
  <collision name="c"><geometry><box><size>0.5 0.5 1</size></box></geometry></collision>
  <visual name="v"><geometry><box><size>0.5 0.5 1</size></box></geometry></visual></link></model>
  <model name="wall"><static>true</static><pose>4 0 1 0 0 0</pose><link name="l">
  <collision name="c"><geometry><box><size>0.1 9 4</size></box></geometry></collision>
  <visual name="v"><geometry><box><size>0.1 9 4</size></box></geometry></visual></link></model></world></sdf>"""

Heard = list[tuple[str, float, str]]
"""Topic, time of arrival [s] and hash of each message."""


def start(sim: simkit.Simulation) -> None:
    """Move the sensors and the box."""
    sim.model("m").set_velocity(linear=(0.2, 0, 0), angular=(0, 0, 0.7))
    sim.model("box").set_velocity(linear=(0, 0.4, 0))


def listen(sim: simkit.Simulation) -> Heard:
    """Return the list to which all messages of the sensors are added."""
    heard: Heard = []

    def take(topic: str, message: msgs.Message) -> None:
        heard.append((topic, round(sim.time, 6), hashlib.sha256(bytes(msgs.serialize(message))).hexdigest()))

    for kind in FAMILIES:
        for topic in sim.sensor(f"m::l::{kind}").topics.values():
            sim.subscribe(topic, partial(take, topic))
    return heard


def after(heard: Heard, time: float) -> Heard:
    """Return the messages that arrived after a time [s]."""
    return [entry for entry in heard if entry[1] > time]


def messages(render_thread: bool | None = None) -> Heard:
    """Return all messages of a run."""
    with simkit.load(WORLD, seed=SEED, render_thread=render_thread) as sim:
        start(sim)
        heard = listen(sim)
        sim.run(LENGTH)
        return heard


@pytest.fixture(scope="module")
def expected() -> Heard:
    """All messages of a run that nothing disturbs."""
    return messages()


def test_each_artefact_takes_part(expected: Heard) -> None:
    known = {name.partition("/")[2] for name in artefact_kinds().written}
    assert known <= {*MESSAGES, *(name for _, _, elements in FAMILIES.values() for name in elements)}
    assert len({topic for topic, _, _ in expected}) >= len(FAMILIES)


def test_a_reset_repeats_all_messages(expected: Heard) -> None:
    with simkit.load(WORLD, seed=SEED) as sim:
        start(sim)
        heard = listen(sim)
        sim.run(0.233)
        sim.reset()
        heard.clear()
        start(sim)
        sim.run(LENGTH)
        assert heard == expected


@pytest.mark.parametrize("time", [0.053, 0.158, 0.236], ids=["in the first scan", "in a readout", "in a delay"])
def test_a_snapshot_continues_with_the_same_messages_here_and_in_another_simulation(
    expected: Heard, time: float
) -> None:
    with simkit.load(WORLD, seed=SEED) as sim:
        start(sim)
        sim.run(time)  # nobody listens
        state = sim.snapshot()
        data = pickle.dumps(state)
        heard = listen(sim)
        sim.run(LENGTH - time)
        assert after(heard, time) == after(expected, time)
        heard.clear()
        sim.restore(state)
        sim.run(LENGTH - time)
        assert after(heard, time) == after(expected, time)
    with simkit.load(WORLD, seed=SEED) as sim:
        heard = listen(sim)
        sim.run(0.1)
        sim.restore(pickle.loads(data))
        heard.clear()
        sim.run(LENGTH - time)
        assert after(heard, time) == after(expected, time)


@pytest.mark.slow
def test_listeners_that_come_and_go_and_the_render_thread_change_no_message(expected: Heard) -> None:
    assert messages(render_thread=True) == messages(render_thread=False) == expected
    with simkit.load(WORLD, seed=SEED) as sim:
        start(sim)
        heard = listen(sim)
        for k in range(round(LENGTH / 0.01)):
            subscription = sim.subscribe(sim.sensor("m::l::camera").topic) if k % 7 < 3 else None
            sim.run(0.01)
            if subscription is not None:
                subscription.close()
        assert heard == expected


PROGRAM = "from test_all_artefacts_repeat import messages; print(messages())"


@pytest.mark.slow
@pytest.mark.parametrize("hash_seed", ["0", "77"])
def test_another_process_with_other_hashes_of_texts_has_the_same_messages(expected: Heard, hash_seed: str) -> None:
    environment = {**os.environ, "PYTHONHASHSEED": hash_seed, "PYTHONPATH": str(Path(__file__).parent)}
    other = subprocess.run([sys.executable, "-c", PROGRAM], capture_output=True, text=True, check=True, env=environment)
    assert other.stdout.strip() == repr(expected)
