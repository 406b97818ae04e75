"""SDF text of a test world with a car, and with plugins at any element."""

from __future__ import annotations

import contract_worlds

NOISY = contract_worlds._NOISE
BODY = "<inertial><mass>{m}</mass><inertia><ixx>{i}</ixx><iyy>{i}</iyy><izz>{i}</izz></inertia></inertial>"
HEAVY, WHEEL, LIGHT = BODY.format(m=9, i=0.3), BODY.format(m=0.5, i=0.0025), BODY.format(m=0.5, i=0.01)
BOX = "<geometry><box><size>{}</size></box></geometry>"


def _wheel(name: str, x: float, y: float, parent: str) -> str:
    pose = f"<pose>{x} {y} 0 0 0 0</pose>"
    shape = '<collision name="c"><geometry><sphere><radius>0.1</radius></sphere></geometry></collision>'
    return f"""<link name="{name}">{pose}{WHEEL}{shape}</link><joint name="{name}_joint" type="continuous">
      <parent>{parent}</parent><child>{name}</child><axis><xyz>0 1 0</xyz></axis></joint>"""


def _joint(name: str, link: str, at: str, kind: str, axis: str, lower: float, upper: float) -> str:
    return f"""<link name="{link}"><pose>{at} 0 0 0</pose>{LIGHT}</link><joint name="{name}" type="{kind}">
      <parent>base</parent><child>{link}</child><axis><xyz>{axis}</xyz><limit><lower>{lower}</lower><upper>{upper}</upper>
      </limit><dynamics><damping>0.1</damping></dynamics></axis></joint>"""


_CAR = (
    _joint("fl_steering", "fl_kingpin", "0.3 0.2 0", "revolute", "0 0 1", -0.8, 0.8)
    + _joint("fr_steering", "fr_kingpin", "0.3 -0.2 0", "revolute", "0 0 1", -0.8, 0.8)
    + _wheel("fl", 0.3, 0.2, "fl_kingpin")
    + _wheel("fr", 0.3, -0.2, "fr_kingpin")
    + _wheel("rl", -0.3, 0.2, "base")
    + _wheel("rr", -0.3, -0.2, "base")
    + _joint("lift", "cabin", "0 0 0.3", "prismatic", "0 0 1", -0.1, 4)
    + _joint("door", "leaf", "0 0.1 0.3", "prismatic", "0 1 0", -0.1, 0.8)
    + _joint("door_0", "leaf_0", "0 0.2 0.3", "prismatic", "0 1 0", -0.1, 0.8)
    + _joint("arm", "rod", "0.1 0 0.3", "revolute", "0 1 0.2", -2, 2)
    + '<link name="floor_0"/><joint name="mark" type="fixed"><parent>base</parent><child>floor_0</child></joint>'
)
_LAB = """<sdf version="1.9"><world name="w"><physics type="ode"><max_step_size>0.002</max_step_size></physics>
  <wind><linear_velocity>1 2 0</linear_velocity></wind><spherical_coordinates><latitude_deg>46.5</latitude_deg>
  <longitude_deg>6.6</longitude_deg><elevation>400</elevation></spherical_coordinates>
  <light name="sun" type="directional"><direction>0.3 0.2 -1</direction></light>{world}
  <model name="ground"><static>true</static><link name="l"><collision name="c"><geometry><plane/></geometry></collision>
    <visual name="v"><geometry><plane><size>20 20</size></plane></geometry></visual></link></model>
  <model name="wall"><static>true</static><pose>2 0 0.5 0 0 0.1</pose><link name="l">
    <collision name="c">{slab}</collision>
    <visual name="v">{slab}{visual}</visual></link></model>
  <model name="crate"><pose>-1.2 0 0.3 0.3 0.2 0</pose><link name="l"><enable_wind>true</enable_wind>{heavy}
    <collision name="c">{cube}</collision><visual name="v">{cube}</visual></link></model>
  <actor name="anna"><pose>0 3 0 0 0 0.3</pose>{actor}</actor>
  <model name="car"><pose>0 0 0.1 0 0 0</pose><link name="base"><enable_wind>true</enable_wind>{heavy}
    <collision name="c"><pose>0 0 0.1 0 0 0</pose>{hull}</collision><visual name="v">{hull}</visual>{sensor}</link>
    {car}{model}</model></world></sdf>"""


def lab(*, world: str = "", model: str = "", sensor: str = "", visual: str = "", actor: str = "") -> str:
    """Return a world with a car, a wall, a crate and an actor, and with plugins at the given elements."""
    shapes = {"slab": BOX.format("0.2 4 2"), "cube": BOX.format("0.3 0.3 0.3"), "hull": BOX.format("0.5 0.2 0.1")}
    parts = {"world": world, "model": model, "sensor": sensor, "visual": visual, "actor": actor}
    return _LAB.format(heavy=HEAVY, car=_CAR, **shapes, **parts)


def plugin(filename: str, content: str = "", name: str = "p") -> str:
    return f'<plugin filename="{filename}" name="{name}">{content}</plugin>'


def gz(name: str, content: str = "", kind: str = "") -> str:
    """Return the element of a Gazebo system, by the name of its library."""
    return plugin(f"gz-sim-{name}-system", content, f"gz::sim::systems::{kind}" if kind else "p")


def ros(name: str, content: str = "") -> str:
    """Return the element of a Gazebo Classic plugin for ROS."""
    return plugin(f"libgazebo_ros_{name}.so", content)


def tags(**values: object) -> str:
    return "".join(f"<{name}>{value}</{name}>" for name, value in values.items())


def sensed(kind: str, inner: str = "", **places: str) -> str:
    """Return the test world with a noisy sensor that has a plugin, and with further plugins."""
    block = contract_worlds.NOISY.get(kind, contract_worlds.NOISELESS.get(kind, ""))
    block = "<pose>0.3 0 0.2 0 0 0</pose><update_rate>50</update_rate>" + block.replace("N</", f"{NOISY}</")
    return lab(sensor=f'<sensor name="s" type="{kind}">{block}{inner}</sensor>', **places)
