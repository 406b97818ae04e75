"""A base with four mecanum wheels, 10 kg, on a plane."""

from __future__ import annotations

RADIUS, BASE, TRACK = 0.1, 0.5, 0.4
_DRIVE = """<plugin filename="gz-sim-mecanum-drive-system" name="gz::sim::systems::MecanumDrive">
  <front_left_joint>fl_joint</front_left_joint><front_right_joint>fr_joint</front_right_joint>
  <back_left_joint>bl_joint</back_left_joint><back_right_joint>br_joint</back_right_joint>
  <wheel_separation>0.4</wheel_separation><wheelbase>0.5</wheelbase><wheel_radius>0.1</wheel_radius>
  {settings}
</plugin>"""
_PLACES = {"fl": (1, 1, "1 -1 0"), "fr": (1, -1, "1 1 0"), "bl": (-1, 1, "1 1 0"), "br": (-1, -1, "1 -1 0")}


def wheel(name: str, friction: str = "") -> str:
    """A wheel of 0.5 kg and its joint."""
    x, y, direction = _PLACES[name]
    rolling = f'<mu>1</mu><mu2>0</mu2><fdir1 gz:expressed_in="base">{direction}</fdir1>'
    return f"""<link name="{name}"><pose>{x * BASE / 2} {y * TRACK / 2} 0 -1.5707963267948966 0 0</pose>
  <inertial><mass>0.5</mass><inertia><ixx>0.0014</ixx><iyy>0.0014</iyy><izz>0.0025</izz></inertia></inertial>
  <collision name="tyre"><geometry><sphere><radius>{RADIUS}</radius></sphere></geometry>
    <surface><friction><ode>{friction or rolling}</ode></friction></surface></collision></link>
<joint name="{name}_joint" type="revolute"><parent>base</parent><child>{name}</child>
  <axis><xyz>0 0 1</xyz></axis></joint>"""


def mecanum(pose: str = "0 0 0.1 0 0 0", settings: str = "", friction: str = "", name: str = "robot") -> str:
    """The model."""
    wheels = "\n".join(wheel(place, friction) for place in _PLACES)
    return f"""<model name="{name}" xmlns:gz="http://gazebosim.org/schema"><pose>{pose}</pose>
<link name="base"><inertial><mass>8</mass><inertia><ixx>0.1</ixx><iyy>0.2</iyy><izz>0.25</izz></inertia></inertial>
  <collision name="hull"><pose>0 0 0.08 0 0 0</pose><geometry><box><size>0.5 0.25 0.1</size></box></geometry>
  </collision>
</link>
{wheels}
{_DRIVE.format(settings=settings)}
</model>"""


def world(*content: str, step: float = 0.002, gravity: str = "0 0 -9.8") -> str:
    """A plane with high friction, and what stands on it."""
    mu = "<surface><friction><ode><mu>2</mu><mu2>2</mu2></ode></friction></surface>"
    return f"""<sdf version="1.9"><world name="w"><gravity>{gravity}</gravity>
<physics type="ode"><max_step_size>{step}</max_step_size></physics>
<model name="ground"><static>true</static><link name="l"><collision name="c"><geometry><plane><normal>0 0 1</normal>
<size>100 100</size></plane></geometry>{mu}</collision></link></model>
{"".join(content)}
</world></sdf>"""
