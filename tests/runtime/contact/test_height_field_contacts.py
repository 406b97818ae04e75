"""A heightmap supports bodies and is detected by rays at the heights of its image."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest

import simkit

SIDE, HEIGHT = 8.0, 2.0


def ramp(folder: Path) -> Path:
    """Save a square image of 33 pixels whose grey values rise along x from black to white."""
    from PIL import Image

    path = folder / "ramp.png"
    row = np.linspace(0, 255, 33).round().astype(np.uint8)
    Image.fromarray(np.tile(row, (33, 1))).save(path)
    return path


def world(folder: Path) -> str:
    shape = f"<heightmap><uri>{ramp(folder).name}</uri><size>{SIDE} {SIDE} {HEIGHT}</size><pos>0 0 0</pos></heightmap>"
    text = f"""<sdf version="1.9"><world name="w">
    <model name="ground"><static>true</static><link name="l">
      <collision name="c"><geometry>{shape}</geometry></collision>
      <visual name="v"><geometry>{shape}</geometry></visual></link></model>
    <model name="ball"><pose>1 0.5 1.8 0 0 0</pose><link name="l"><inertial><mass>1</mass><inertia><ixx>0.004</ixx>
      <iyy>0.004</iyy><izz>0.004</izz></inertia></inertial><collision name="c"><geometry><sphere><radius>0.1</radius>
      </sphere></geometry></collision></link></model>
    <model name="eye"><static>true</static><pose>2 -1 3 0 1.5707963267948966 0</pose><link name="l">
      <sensor name="s" type="lidar"><update_rate>10</update_rate><topic>/scan</topic><lidar><scan><horizontal>
      <samples>1</samples><min_angle>0</min_angle><max_angle>0</max_angle></horizontal></scan>
      <range><min>0.05</min><max>10</max></range></lidar></sensor></link></model>
    </world></sdf>"""
    path = folder / "world.sdf"
    path.write_text(text)
    return str(path)


def test_a_ball_rests_against_the_slope_and_a_ray_measures_it(tmp_path: Path) -> None:
    sim = simkit.load(world(tmp_path))
    slope = HEIGHT / SIDE
    ball = sim.model("ball")
    sim.run(0.35)
    x, y, z = ball.pose.position
    # the centre of the ball is one radius from the slope, along the normal
    off = (z - (x + SIDE / 2) * slope) / np.hypot(1.0, slope)
    assert off == pytest.approx(0.1, abs=0.02)
    sim.run(1.0)
    assert ball.pose.position[0] < x - 0.2  # the ball rolls down
    assert ball.pose.position[1] == pytest.approx(y, abs=0.02)
    distance = float(sim.sensor("eye::l::s").latest.ranges[0])
    assert distance == pytest.approx(3.0 - (2.0 + SIDE / 2) * slope, abs=0.02)
