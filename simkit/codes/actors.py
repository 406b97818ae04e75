"""Actors, and models that come into a world as it is loaded."""

from __future__ import annotations

from simkit.codes import Code
from simkit.codes.sketch import command, world

_WAY = """
<script>
  <trajectory id="0" type="{kind}">
    <waypoint><time>0</time><pose>0 0 0 0 0 0</pose></waypoint>
    <waypoint><time>4</time><pose>4 0 0 0 0 0</pose></waypoint>
  </trajectory>
</script>
"""

CODES: tuple[Code, ...] = (
    Code(
        "SK-ACTOR-001",
        "warning",
        "the skin or an animation of an actor that is not there, or that is not a COLLADA file with a skeleton; a "
        "person of our own stands in for the skin, the skin's own animation for another. Or a "
        "part of one is left out, such as the motion of a bone by other than matrices",
        "name the folder that holds it, or leave the skin out",
        world('<actor name="anna"><skin><filename>model://nobody/walk.dae</filename></skin></actor>'),
    ),
    Code(
        "SK-ACTOR-002",
        "warning",
        "an actor of the name of a model; the actor is left out",
        "another name",
        world(
            '<model name="anna"><static>true</static><link name="base"/></model>\n'
            '<actor name="anna"><pose>2 0 0 0 0 0</pose></actor>'
        ),
    ),
    Code(
        "SK-ACTOR-003",
        "warning",
        "a trajectory that asks for an animation that its actor does not have; the first one plays",
        "the closest name is given",
        world(
            '<actor name="anna">\n  <animation name="walking"><filename>walk.dae</filename></animation>'
            f"{_WAY.format(kind='wlaking')}</actor>"
        ),
    ),
    Code(
        "SK-ACTOR-004",
        "note",
        "an actor that waits for its start",
        "call its service `/<actor>/play`, or set `<auto_start>`",
        world(
            '<actor name="anna">'
            f"{_WAY.format(kind='walking').replace('<script>', '<script><auto_start>false</auto_start>')}</actor>"
        ),
    ),
    Code(
        "SK-SPAWN-001",
        "error",
        "a text of `--spawn` that is not `MODEL:x,y,yaw[:name]`",
        "what is allowed is said",
        command("simkit run empty --spawn turtlebot3_burger:1,0"),
    ),
    Code(
        "SK-SPAWN-002",
        "error",
        "a model of `--spawn` has the name of something that is there already",
        "another name: `MODEL:x,y,yaw:NAME`",
        command("simkit run turtlebot3_empty --spawn turtlebot3_waffle:1,0,0:turtlebot3"),
    ),
)
