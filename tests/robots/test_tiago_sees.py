"""What TIAGo's head camera sees, and how TIAGo looks to a camera before it."""

from __future__ import annotations

import math

import numpy as np
import pytest

import simkit
from simkit.sensors.cameras.image_messages import pixels_of

WORLD = """<sdf version="1.12"><world name="w"><include><uri>model://ground_plane</uri></include>
<include><uri>model://sun</uri></include>{}</world></sdf>"""
WALL = """<model name="wall"><static>true</static><pose>2.05 0 1.5 0 0 0</pose><link name="l"><visual name="v">
<geometry><box><size>0.1 8 3</size></box></geometry>
<material><ambient>0.1 0.6 0.2 1</ambient><diffuse>0.1 0.6 0.2 1</diffuse></material></visual></link></model>"""
EYE = """<model name="eye"><static>true</static><pose>2.6 0 0.75 0 0 3.14159265</pose><link name="l">
<sensor name="c" type="camera"><topic>portrait</topic><update_rate>10</update_rate><camera>
<horizontal_fov>0.6</horizontal_fov><image><width>480</width><height>480</height></image></camera></sensor>
</link></model>"""
CAMERA = "/head_front_camera"


def test_the_head_camera_looks_past_its_own_head_at_the_wall() -> None:
    with simkit.load(WORLD.format(WALL)) as sim:
        sim.spawn("tiago")
        topics = [f"{CAMERA}/{name}" for name in ("rgb/image_raw", "rgb/camera_info", "depth_registered/image_raw")]
        heard = [sim.subscribe(topic, keep=1) for topic in topics]
        sim.run(0.1)
        picture, info, depth = (readings.latest for readings in heard)
        eye = sim.link("tiago::head_front_camera_rgb_frame").pose
    colours = pixels_of(picture).astype(int)
    assert {m.header.frame_id for m in (picture, info, depth)} == {"head_front_camera_rgb_optical_frame"}
    assert info.k[0] == pytest.approx(320 / math.tan(math.radians(63) / 2))
    upper = colours[:240]
    assert (upper[..., 1] > 1.5 * upper[..., 0]).all()  # nothing but the green wall
    metres = pixels_of(depth)
    assert abs(metres[240, 320] - (2.0 - eye.position[0])) < 0.005
    assert np.isfinite(metres).all() and metres.min() > 1.5


def test_tiago_can_be_told_by_its_white_body_dark_arm_and_orange_ring() -> None:
    with simkit.load(WORLD.format(EYE)) as sim:
        sim.spawn("tiago")
        heard = sim.subscribe("/portrait", keep=1)
        sim.run(0.2)
        picture = pixels_of(heard.latest).astype(int)
    red, green, blue = (picture[..., k] for k in range(3))
    orange = (red > 1.6 * green) & (green > 1.5 * blue) & (red > 60)
    rows = np.nonzero(orange.any(axis=1))[0]
    assert 0.002 < orange.mean() < 0.05
    assert rows.min() > 300  # the ring is at the base
    visor = picture[90:180, 200:280]
    assert (visor.max(axis=-1) < 45).mean() > 0.1  # the dark window of the head
    body = picture[230:300, 215:265]
    assert (body.min(axis=-1) > 90).mean() > 0.7  # the white torso
