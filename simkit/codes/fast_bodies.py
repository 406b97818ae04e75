"""Codes of bodies that move far within one step."""

from __future__ import annotations

from simkit.codes import Code
from simkit.codes.sketch import python, world

_ROD = """<model name="wall"><static>true</static><link name="l">
  <collision name="c"><geometry><box><size>0.01 2 2</size></box></geometry></collision>
</link></model>
<model name="rod"><pose>-0.5 0 0 0 0.4 0</pose><link name="l">
  <inertial><mass>0.1</mass><inertia><ixx>1e-4</ixx><iyy>1e-4</iyy><izz>1e-4</izz></inertia></inertial>
  <collision name="c"><geometry><box><size>0.04 0.04 0.1</size></box></geometry></collision>
</link></model>"""
_SHOT = """import simkit
sim = simkit.load("wall.sdf")
sim.model("rod").set_velocity((300, 0, 0), (0, 0, 0))
sim.step()
"""

CODES: tuple[Code, ...] = (
    Code(
        "SK-PHYS-031",
        "warning",
        "a body comes towards another so fast that it may pass through it within one step, and contacts that look "
        "ahead do not help for sure: the other is a height map, or the body has edges and is many times as fast as its "
        "thickness in a step",
        "the longest `<max_step_size>` that would do is given",
        python(_SHOT, {"wall.sdf": world(_ROD).text}),
    ),
)
