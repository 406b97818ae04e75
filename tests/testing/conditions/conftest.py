"""A small test world: ground, wall at 2 m, ball with sensors, lidar on a post, arm."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from typing import Any

import pytest

import simkit

YARD = """<sdf version="1.9"><world name="yard"><physics type="ode"><max_step_size>0.002</max_step_size></physics>
<model name="ground"><static>true</static><link name="l"><collision name="c"><geometry><plane/></geometry></collision>
</link></model>
<model name="wall"><static>true</static><pose>2 0 0.5 0 0 0</pose><link name="l"><collision name="c">
  <geometry><box><size>0.2 4 1</size></box></geometry></collision>
  <visual name="v"><geometry><box><size>0.2 4 1</size></box></geometry></visual></link></model>
<model name="ball"><pose>0 0 0.25 0 0 0</pose><link name="base">
  <inertial><mass>1</mass><inertia><ixx>.025</ixx><iyy>.025</iyy><izz>.025</izz></inertia></inertial>
  <collision name="c"><geometry><sphere><radius>0.25</radius></sphere></geometry></collision>
  <sensor name="imu" type="imu"><update_rate>50</update_rate><topic>/imu</topic></sensor></link></model>
<model name="post"><static>true</static><pose>0 -3 0.4 0 0 0</pose><link name="l">
  <sensor name="lds" type="gpu_lidar"><update_rate>5</update_rate><topic>/scan</topic><lidar><scan><horizontal>
    <samples>90</samples><min_angle>-3</min_angle><max_angle>3</max_angle></horizontal></scan>
    <range><min>0.1</min><max>8</max></range></lidar></sensor></link></model>
<model name="arm"><pose>0 3 0 0 0 0</pose><link name="foot"/>
  <link name="beam"><pose>0 0 1 0 0 0</pose><inertial><mass>1</mass></inertial></link>
  <joint name="fix" type="fixed"><parent>world</parent><child>foot</child></joint>
  <joint name="hinge" type="revolute"><parent>foot</parent><child>beam</child><axis><xyz>0 0 1</xyz></axis></joint>
</model>%s</world></sdf>"""


@pytest.fixture
def yard() -> Callable[..., Any]:
    """Load the world with additional models; the ball rolls [m/s] and touches the wall after 1.65 m."""

    def opened(speed: float = 0.0, more: str = "", **options: Any) -> Any:
        sim = simkit.load(YARD % more, **options)
        sim.model("ball").set_velocity((speed, 0.0, 0.0), (0.0, speed / 0.25, 0.0))
        return sim

    return opened


@pytest.fixture(scope="session")
def still() -> Iterator[Any]:
    """Return a view of the world at t = 1 s, with messages of one second."""
    from simkit.testing.conditions.world_view import WorldView

    with simkit.load(YARD % "") as sim:
        view = WorldView(sim)
        view.open()
        for topic in ("/imu", "/scan"):
            view.latest_message(topic)
            view.message_counter(topic)
        sim.run(1.0)
        yield view
