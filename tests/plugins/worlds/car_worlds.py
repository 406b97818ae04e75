"""A car of 12 kg with steered front wheels, and a tricycle, on a plane."""

from __future__ import annotations

RADIUS, BASE, TRACK = 0.1, 0.6, 0.4
_INERTIA = "<inertia><ixx>{0}</ixx><iyy>{0}</iyy><izz>{0}</izz></inertia>"
_FREE = "<axis><xyz>{}</xyz></axis>"


def _wheel(name: str, x: float, y: float, parent: str, pose: str | None = None) -> str:
    place = pose or f"{x} {y} 0 0 0 0"
    return f"""<link name="{name}"><pose>{place}</pose><inertial><mass>0.5</mass>{_INERTIA.format(0.0025)}</inertial>
  <collision name="c"><geometry><sphere><radius>{RADIUS}</radius></sphere></geometry></collision></link>
<joint name="{name}_joint" type="continuous"><parent>{parent}</parent><child>{name}</child>
  {_FREE.format("0 1 0")}</joint>"""


def _steered(name: str, x: float, y: float) -> str:
    return f"""<link name="{name}_kingpin"><pose>{x} {y} 0 0 0 0</pose>
  <inertial><mass>0.5</mass>{_INERTIA.format(0.01)}</inertial></link>
<joint name="{name}_steering" type="revolute"><parent>base</parent><child>{name}_kingpin</child>
  <axis><xyz>0 0 1</xyz><limit><lower>-0.8</lower><upper>0.8</upper></limit></axis></joint>
{_wheel(name, x, y, f"{name}_kingpin")}"""


def car(plugin: str, name: str = "car") -> str:
    """With wheels fl, fr, rl and rr; joints `<wheel>_joint`, `fl_steering`, `fr_steering`."""
    x, y = BASE / 2, TRACK / 2
    return f"""<model name="{name}"><pose>0 0 {RADIUS} 0 0 0</pose>
<link name="base"><inertial><mass>9</mass>{_INERTIA.format(0.3)}</inertial></link>
{_steered("fl", x, y)}{_steered("fr", x, -y)}{_wheel("rl", -x, y, "base")}{_wheel("rr", -x, -y, "base")}
{plugin}</model>"""


def tricycle(plugin: str) -> str:
    """With joints front_steering_joint, front_wheel_joint, left_wheel_joint and right_wheel_joint."""
    x, y = BASE / 2, TRACK / 2
    front = (
        _steered("front", x, 0.0)
        .replace("front_steering", "front_steering_joint")
        .replace("front_joint", "front_wheel_joint")
    )
    rear = _wheel("left", -x, y, "base") + _wheel("right", -x, -y, "base")
    for side in ("left", "right"):
        rear = rear.replace(f'"{side}_joint"', f'"{side}_wheel_joint"')
    return f"""<model name="trike"><pose>0 0 {RADIUS} 0 0 0</pose>
<link name="base"><inertial><mass>9</mass>{_INERTIA.format(0.3)}</inertial></link>
{front}{rear}{plugin}</model>"""


def world(*content: str, step: float = 0.002, gravity: str = "0 0 -9.8") -> str:
    """A plane, and what stands on it."""
    return f"""<sdf version="1.9"><world name="w"><gravity>{gravity}</gravity>
<physics type="ode"><max_step_size>{step}</max_step_size></physics>
<model name="ground"><static>true</static><link name="l"><collision name="c"><geometry><plane/></geometry></collision>
</link></model>{"".join(content)}</world></sdf>"""
