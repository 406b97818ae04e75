"""Writes the office, `simple_office/model.sdf`, and the world with people in it, from the numbers in the modules here.

    python assets/office/make_office.py

A corridor along x with two offices and a meeting room to the north, an open office and a kitchen to the south. Lengths
m, angles degrees in this file and radians in what is written.
"""

from __future__ import annotations

from pathlib import Path

from office_building import building
from office_furniture import board, chair, counter, desk, fridge, meeting_table, plant, round_table, shelf, sofa
from office_meshes import mesh_text
from office_parts import LOOKS, Part, looks_of, number, numbers, piece
from office_people import DESKS, SITTING, STANDING, WALKERS, actor_lines, seat_of

HERE = Path(__file__).resolve().parent
WORLD = HERE.parents[1] / "worlds" / "simple_office_with_people.sdf"


def office() -> list[Part]:
    found = building()
    for key, (x, y, looks) in DESKS.items():
        found += piece(f"desk_{key}", desk(), x, y, looks + 180.0)
        sx, sy, _ = seat_of(key)
        found += piece(f"chair_{key}", chair(), sx, sy, looks)
    found += piece("shelf_a", shelf(), -4.0, 4.54, -90)
    found += piece("shelf_b", shelf(("white", "blue")), -0.92, 3.2, 0)
    found += piece("shelf_c", shelf(("yellow", "red", "white")), 1.74, -2.6, 180)
    found += piece("table", meeting_table(), 4.6, 3.1, 0)
    for i, (x, y, turn) in enumerate(((4.1, 3.86, -90), (5.1, 3.86, -90), (4.1, 2.34, 90), (5.1, 2.34, 90)), 1):
        found += piece(f"meeting_chair_{i}", chair(), x, y, turn)
    found += piece("board", board(), 6.41, 3.1, 180)
    found += piece("sofa", sofa(), -4.9, 1.72, 90)
    found += piece("counter", counter(), 4.6, -4.42, 90)
    found += piece("fridge", fridge(), 2.45, -4.4, 90)
    found += piece("bar", round_table(), 4.9, -2.6)
    for i, (x, y) in enumerate(((-6.1, -0.85), (6.1, 0.85), (-6.1, 1.6), (-0.85, 4.4), (-2.9, -4.4), (6.1, -1.6)), 1):
        found += piece(f"plant_{i}", plant(), x, y)
    return found


def shape(part: Part) -> str:
    if part.kind == "box":
        return f"<box><size>{numbers(part.size)}</size></box>"
    if part.kind == "cylinder":
        return f"<cylinder><radius>{number(part.size[0])}</radius><length>{number(part.size[1])}</length></cylinder>"
    return f"<ellipsoid><radii>{numbers(part.size)}</radii></ellipsoid>"


def collision_line(part: Part) -> str:
    pose = f"<pose>{numbers((*part.at, 0, 0, part.yaw))}</pose>"
    return f'<collision name="{part.name}">{pose}<geometry>{shape(part)}</geometry></collision>'


def visual_line(look: str) -> str:
    red, green, blue = LOOKS[look]
    colour = numbers((red, green, blue, 1))
    shine = "0.4 0.4 0.4 1" if look in ("metal", "glass", "screen") else "0.05 0.05 0.05 1"
    material = f"<ambient>{colour}</ambient><diffuse>{colour}</diffuse><specular>{shine}</specular>"
    return (
        f'<visual name="{look}"><geometry><mesh><uri>meshes/{look}.obj</uri></mesh></geometry>'
        f"<material>{material}</material></visual>"
    )


def model_text() -> str:
    parts = office()
    felt = [collision_line(part) for part in parts if part.felt]
    lines = "\n".join(f"      {line}" for line in (*felt, *map(visual_line, looks_of(parts))))
    return (
        '<?xml version="1.0"?>\n'
        "<!-- An office of 13 x 9.6 m without a ceiling. Written by make_office.py beside this folder. Lengths m. -->\n"
        '<sdf version="1.12">\n  <model name="simple_office">\n    <static>true</static>\n    <link name="link">\n'
        f"{lines}\n    </link>\n  </model>\n</sdf>\n"
    )


CONFIG = """<?xml version="1.0"?>
<model>
  <name>Simple office</name>
  <version>1.0</version>
  <sdf version="1.12">model.sdf</sdf>
  <author><name>simkit</name></author>
  <description>Two offices, a meeting room, an open office and a kitchen along a corridor.</description>
</model>
"""

HEAD = """<?xml version="1.0"?>
<!--
  An office with people who stand, sit and walk. Written by assets/office/make_office.py. Lengths m, angles rad.

  The corridor is free along y = 0: a robot goes to the origin (option spawn, tiago:0,0,0). The people are actors:
  cameras and lidars see them, nothing pushes them and they push nothing.
-->
<sdf version="1.12" xmlns:simkit="https://simkit">
  <world name="simple_office_with_people">

    <physics name="step_2ms" type="ignored">
      <max_step_size>0.002</max_step_size>
      <real_time_factor>1</real_time_factor>
    </physics>

    <scene>
      <ambient>0.62 0.62 0.62 1</ambient>
      <background>0.80 0.87 0.94 1</background>
      <shadows>true</shadows>
      <grid>false</grid>
    </scene>

    <light name="sun" type="directional">
      <pose>-30 -40 70 0 0 0</pose>
      <direction>0.32 0.44 -0.84</direction>
      <diffuse>0.5 0.5 0.48 1</diffuse>
      <specular>0.1 0.1 0.1 1</specular>
      <cast_shadows>true</cast_shadows>
    </light>

    <model name="ground_plane">
      <static>true</static>
      <link name="link">
        <collision name="collision">
          <geometry><plane><normal>0 0 1</normal><size>100 100</size></plane></geometry>
        </collision>
        <visual name="visual">
          <pose>0 0 -0.006 0 0 0</pose>
          <geometry><plane><normal>0 0 1</normal><size>100 100</size></plane></geometry>
          <material><ambient>0.55 0.62 0.50 1</ambient><diffuse>0.55 0.62 0.50 1</diffuse></material>
        </visual>
      </link>
    </model>

    <include>
      <uri>model://simple_office</uri>
      <name>office</name>
    </include>
"""


def world_text() -> str:
    lines = [HEAD]
    for name in (*WALKERS, *STANDING, *SITTING):
        lines += [*actor_lines(name), ""]
    return "\n".join([*lines, "  </world>", "</sdf>", ""])


if __name__ == "__main__":
    (HERE / "simple_office" / "model.sdf").write_text(model_text(), encoding="utf-8")
    for look, alike in looks_of(office()).items():
        (HERE / "simple_office" / "meshes" / f"{look}.obj").write_text(mesh_text(look, alike), encoding="utf-8")
    (HERE / "simple_office" / "model.config").write_text(CONFIG, encoding="utf-8")
    WORLD.write_text(world_text(), encoding="utf-8")
