"""A small world for any kind of sensor, and its messages; run as a program, it prints the digests of the readings."""

from __future__ import annotations

import dataclasses
import hashlib
import json
import sys
from typing import Any

import numpy as np

import simkit
from simkit import msgs
from simkit.sensors import sensor_kinds
from simkit.sensors.cameras.rendered_camera import RenderedCamera

RATE = 40
DURATION = 0.26
_NOISE = (
    '<noise type="gaussian"><mean>0.01</mean><stddev>0.02</stddev><bias_mean>0.1</bias_mean><bias_stddev>0.05'
    "</bias_stddev><dynamic_bias_stddev>0.3</dynamic_bias_stddev><dynamic_bias_correlation_time>2"
    "</dynamic_bias_correlation_time></noise>"
)
_AXES = "<x>N</x><y>N</y><z>N</z>"
_LIDAR = (
    "<lidar><scan><horizontal><samples>12</samples><min_angle>-1</min_angle><max_angle>1</max_angle></horizontal></scan>"
    "<range><min>0.1</min><max>10</max></range>N</lidar>"
)
_CAMERA = (
    "<camera><image><width>32</width><height>24</height></image><clip><near>0.1</near><far>20</far></clip>"
    '<noise type="gaussian"><stddev>0.02</stddev></noise></camera>'
)
_RIGHT = '<camera name="right"><pose>0 -0.1 0 0 0 0</pose>'
NOISY = {
    "air_pressure": "<air_pressure><pressure>N</pressure></air_pressure>",
    "anemometer": "<anemometer>N</anemometer>",
    "dvl": "<dvl><arrangement degrees='true'><beam id='0'><aperture>4</aperture><tilt>30</tilt></beam><beam id='1'>"
    "<aperture>4</aperture><rotation>120</rotation><tilt>30</tilt></beam><beam id='2'><aperture>4</aperture>"
    "<rotation>-120</rotation><tilt>30</tilt></beam></arrangement><tracking><bottom_mode>N</bottom_mode></tracking></dvl>",
    "air_speed": "<air_speed><pressure>N</pressure></air_speed>",
    "altimeter": "<altimeter><vertical_position>N</vertical_position>"
    "<vertical_velocity>N</vertical_velocity></altimeter>",
    "encoder": "<encoder><position>N</position><velocity>N</velocity></encoder>",
    "force_torque": f"<force_torque><force>{_AXES}</force><torque>{_AXES}</torque></force_torque>",
    "imu": f"<imu><angular_velocity>{_AXES}</angular_velocity><linear_acceleration>{_AXES}</linear_acceleration></imu>",
    "magnetometer": f"<magnetometer>{_AXES}</magnetometer>",
    "navsat": "<navsat><position_sensing><horizontal>N</horizontal><vertical>N</vertical></position_sensing></navsat>",
    "gps": "<gps><position_sensing><horizontal>N</horizontal><vertical>N</vertical></position_sensing></gps>",
    "solar": "<solar>N</solar>",
    "sonar": "<sonar><min>0.02</min><max>4</max><radius>0.5</radius>N</sonar>",
    **dict.fromkeys(("lidar", "ray", "gpu_lidar", "gpu_ray"), _LIDAR),
    **dict.fromkeys(("thermal_camera", "thermal"), _CAMERA),
    "multicamera": f"{_CAMERA}{_CAMERA}".replace("<camera>", '<camera name="left">', 1).replace("<camera>", _RIGHT),
    **dict.fromkeys(("camera", "depth", "depth_camera", "rgbd_camera"), _CAMERA),
    **dict.fromkeys(("wide_angle_camera", "wideanglecamera"), _CAMERA),
}
"""Block of each kind, in which every N stands for a noise; a kind that is not listed has no noise."""

_PLAIN_CAMERA = "<camera><image><width>32</width><height>24</height></image></camera>"
NOISELESS = {
    **dict.fromkeys(("segmentation_camera", "segmentation", "boundingbox_camera", "boundingbox"), _PLAIN_CAMERA),
}
"""Block of each kind that ignores noise and needs little computation; a kind that is not listed has its example."""
_LABEL = '<plugin filename="gz-sim-label-system" name="gz::sim::systems::Label"><label>{}</label></plugin>'

_INERTIAL = "<inertial><mass>1</mass><inertia><ixx>0.01</ixx><iyy>0.02</iyy><izz>0.03</izz></inertia></inertial>"
_BALL = "<geometry><sphere><radius>0.1</radius></sphere></geometry>"
_WORLD = """<sdf version="1.9"><world name="w">
  <wind><linear_velocity>1 2 0</linear_velocity></wind>
  <spherical_coordinates><latitude_deg>46.5</latitude_deg><longitude_deg>6.6</longitude_deg><elevation>400</elevation>
  </spherical_coordinates>
  <light name="sun" type="directional"><direction>0.3 0.2 -1</direction></light>
  <model name="ground"><static>true</static><link name="l">
    <collision name="c"><geometry><box><size>20 20 0.2</size></box></geometry></collision>
    <visual name="v"><geometry><box><size>20 20 0.2</size></box></geometry></visual></link>{ground}</model>
  <model name="wall"><static>true</static><pose>3 0 1 0 0 0.2</pose><link name="l">
    <collision name="c"><geometry><box><size>0.2 9 9</size></box></geometry></collision>
    <visual name="v"><geometry><box><size>0.2 9 9</size></box></geometry></visual></link>{wall}</model>
  <model name="m"><pose>0 0 0.21 0.1 0.2 0.3</pose>
    <link name="l">{inertial}<collision name="c">{ball}</collision>{link}</link>
    <link name="k"><pose>0 0.4 0 0 0 0</pose>{inertial}<collision name="c">{ball}</collision></link>
    <joint name="j" type="revolute"><parent>l</parent><child>k</child><axis><xyz>1 0 0.3</xyz></axis>{joint}</joint>
  </model></world></sdf>"""


def is_rendered(kind: str) -> bool:
    """Check whether a kind draws images."""
    return issubclass(sensor_kinds()[kind], RenderedCamera)


def source(kind: str, *, noisy: bool = False, extra: str = "") -> str:
    """Return a two-link model with a sensor that falls, tumbles and hits the ground."""
    cls = sensor_kinds()[kind]
    block = NOISY.get(kind, NOISELESS.get(kind, cls.example)).replace("N</", f"{_NOISE if noisy else ''}</")
    if not noisy:
        block = block.replace('<noise type="gaussian"><stddev>0.02</stddev></noise>', "")
    text = (
        f'<sensor name="s" type="custom" gz:type="{kind}"><update_rate>{RATE}</update_rate>'
        f"<pose>0.02 0.01 0.15 0 0 0.4</pose><topic>t</topic>{extra}{block}</sensor>"
    )
    place = cls.belongs_to[0]
    parts = {"link": "", "joint": "", place: text}
    label = _LABEL if kind in NOISELESS else ""
    labels = {"ground": label.format(20), "wall": label.format(10)}
    return _WORLD.format(inertial=_INERTIAL, ball=_BALL, **labels, **parts)


def load(kind: str, **how: Any) -> Any:
    sim = simkit.load(source(kind, **how), seed=5)
    sim.model("m").set_velocity((0.5, 0.2, -1.0), (1.0, -0.5, 0.7))
    return sim


def sensor_of(sim: Any) -> Any:
    (found,) = sim.contents.sensors.values()
    return found


def digest(message: Any) -> str:
    """Return a digest of every bit of a message, stamp included."""
    return "" if message is None else hashlib.blake2b(msgs.serialize(message), digest_size=8).hexdigest()


def plain(message: Any) -> Any:
    """Return the measured fields of a message: without stamps, and without fields about the noise."""
    if dataclasses.is_dataclass(message):
        skip = ("header", "stamp", "variance")
        names = [f.name for f in dataclasses.fields(message) if f.name not in skip and "covariance" not in f.name]
        return [plain(getattr(message, name)) for name in names if not name.startswith("err")]
    if isinstance(message, np.ndarray):
        return message.tobytes()
    if isinstance(message, (list, tuple)):
        return [plain(m) for m in message]
    return message


def published_digests(sim: Any, duration: float = DURATION) -> list[tuple[int, str, str]]:
    """Return (tick of arrival, topic, digest) of every message that a sensor publishes."""
    out: list[tuple[int, str, str]] = []
    taps = [
        sim.communication.bus.tap(topic, lambda m, topic=topic: out.append((sim.tick, topic, digest(m))))
        for topic in sensor_of(sim)._topics.values()
    ]
    sim.run(duration)
    for tap in taps:
        tap.close()
    return out


if __name__ == "__main__":
    found = {}
    for kind in sys.argv[1:]:
        with load(kind, noisy=True) as sim:
            found[kind] = published_digests(sim)
    sys.stdout.write(json.dumps(found))
