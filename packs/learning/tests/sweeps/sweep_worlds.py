"""Small worlds and functions for tests of sweeps."""

from __future__ import annotations

import os
import signal
import sys
from typing import Any

INERTIA = "<inertia><ixx>0.1</ixx><iyy>0.1</iyy><izz>0.1</izz></inertia>"
BOX = f"""<sdf version="1.9"><world name="w"><model name="box"><pose>0 0 0.5 0 0 0</pose><link name="l">
<inertial><mass>1</mass>{INERTIA}</inertial>
<collision name="c"><geometry><box><size>.2 .2 .2</size></box></geometry></collision></link></model></world></sdf>"""
"""One box that falls from 0.5 m in empty space."""

SLOPE = f"""<sdf version="1.9"><world name="w"><gravity>3 0 -9.8</gravity>
<model name="ground"><static>true</static><link name="l"><collision name="c"><geometry><plane><normal>0 0 1</normal>
</plane></geometry></collision></link></model>
<model name="post"><static>true</static><pose>0.5 0 0.1 0 0 0</pose><link name="l"><collision name="c"><geometry>
<cylinder><radius>0.05</radius><length>0.2</length></cylinder></geometry></collision></link></model>
<model name="box"><pose>0 0 0.1 0 0 0</pose><link name="l"><inertial><mass>1</mass>{INERTIA}</inertial>
<collision name="c"><geometry><box><size>.2 .2 .2</size></box></geometry></collision></link></model></world></sdf>"""
"""A box that slides along x against a post, because gravity is inclined."""


def height(sim: Any) -> float:
    """Return the height of the box."""
    return float(sim.model("box").pose.position[2])


def counted_height(sim: Any) -> float:
    """Return the height of the box, and note the run in a file."""
    with open(os.environ["SWEEP_TEST_LOG"], "ab") as file:
        file.write(b"%d\n" % sim.seed)
        if file.tell() >= int(os.environ.get("SWEEP_TEST_KILL_SIZE", sys.maxsize)):
            os.kill(os.getppid(), signal.SIGKILL)  # the process of the sweep, between any two of its instructions
    return height(sim)


def crashing(sim: Any) -> float:
    """End the process if the seed is 3."""
    if sim.seed == 3:
        os.abort()
    return 1.0


CART = """<sdf version="1.9"><world name="w"><physics type="ignored"><max_step_size>0.002</max_step_size></physics>
<model name="wall"><static>true</static><pose>3 0 0 0 0 0</pose><link name="l">
  <collision name="c"><geometry><box><size>0.2 4 2</size></box></geometry></collision></link></model>
<model name="cart"><pose>0 0 0.5 0 0 0</pose>
  <link name="rail"><inertial><mass>1</mass></inertial></link>
  <joint name="fix" type="fixed"><parent>world</parent><child>rail</child></joint>
  <link name="car"><inertial><mass>2</mass></inertial>
    <sensor name="eye" type="lidar"><update_rate>4</update_rate><topic>eye</topic><lidar><scan>
      <horizontal><samples>6</samples><min_angle>-0.2</min_angle><max_angle>0.2</max_angle></horizontal></scan>
      <range><min>0.1</min><max>5</max></range><noise><type>gaussian</type><stddev>0.01</stddev></noise></lidar></sensor>
  </link>
  <joint name="slide" type="prismatic"><parent>rail</parent><child>car</child>
    <axis><xyz>1 0 0</xyz><limit><lower>-2</lower><upper>2</upper><effort>8</effort></limit></axis></joint>
</model></world></sdf>"""
SLIDE = "cart::slide"
