"""The world that the tests of services talk to."""

from __future__ import annotations

from typing import Any

import simkit

BOX_LINK = """<link name="body"><inertial><mass>2</mass><inertia><ixx>0.5</ixx><iyy>0.5</iyy><izz>0.5</izz></inertia>
</inertial><collision name="hull"><geometry><box><size>1 1 1</size></box></geometry></collision>
<visual name="skin"><geometry><box><size>1 1 1</size></box></geometry></visual></link>"""
BOX = f'<model name="box"><pose>0 0 0.5 0 0 0</pose>{BOX_LINK}</model>'
GROUND = """<model name="ground"><static>1</static><link name="plane"><collision name="c"><geometry><plane/></geometry>
</collision></link></model>"""
ARM = """<model name="arm"><pose>0 5 1 0 0 0</pose><link name="base"/><link name="tip"><pose>1 0 0 0 0 0</pose></link>
<joint name="fix" type="fixed"><parent>world</parent><child>base</child></joint>
<joint name="hinge" type="revolute"><parent>base</parent><child>tip</child><axis><xyz>0 0 1</xyz>
<limit><lower>-1</lower><upper>1</upper></limit><dynamics><damping>0.25</damping></dynamics></axis></joint></model>"""
SUN = """<light name="sun" type="directional"><pose>0 0 10 0 0 0</pose><diffuse>0.5 0.5 0.5 1</diffuse>
<direction>0 0 -1</direction></light>"""
LAMP = """<light name="lamp" type="spot"><pose>2 0 3 0 0 0</pose><diffuse>1 1 1 1</diffuse><attenuation>
<range>20</range><constant>0.5</constant><linear>0.01</linear><quadratic>0.001</quadratic></attenuation>
<spot><inner_angle>0.5</inner_angle><outer_angle>0.8</outer_angle><falloff>1</falloff></spot>
<direction>0 0 -1</direction></light>"""


def load(more: str = "", **options: Any) -> simkit.Simulation:
    """A box on the ground, an arm that is fixed to the world, a sun and a lamp."""
    world = f'<world name="w"><gravity>0 0 -10</gravity>{SUN}{LAMP}{GROUND}{BOX}{ARM}{more}</world>'
    return simkit.load(f'<sdf version="1.9">{world}</sdf>', **options)


def model(name: str, pose: str = "0 0 0 0 0 0") -> str:
    """A file with one box of that name."""
    return f'<sdf version="1.9"><model name="{name}"><pose>{pose}</pose>{BOX_LINK}</model></sdf>'
