"""Writes the worlds with a table in front of TIAGo or Baxter, and the box with the marker.

    python assets/office/make_tables.py

Lengths m, masses kg. Inertias are those of solid bodies.
"""

from __future__ import annotations

import math
from collections.abc import Iterable, Iterator
from dataclasses import dataclass
from pathlib import Path

HERE = Path(__file__).resolve().parent
WORLDS = HERE.parents[1] / "worlds"

MARKER_ID = 582
"""In OpenCV's DICT_ARUCO_ORIGINAL (5 x 5 bits), the one of the robot's own picking demo."""
MARKER = 0.12
"""[m] edge of the black square."""
CELLS, PIXELS = 9, 64  # across the plate with its white rim; of one cell
BOX = (0.06, 0.17, 0.17)
BOX_MASS = 0.3


@dataclass(frozen=True)
class Thing:
    """An object: a box (x, y, z), a cylinder (radius, length) or a sphere (radius), its middle at `at`."""

    name: str
    kind: str
    size: tuple[float, ...]
    mass: float
    at: tuple[float, float, float]
    colour: tuple[float, float, float]
    mu: float = 0.9
    yaw: float = 0.0


def number(value: float) -> str:
    text = f"{value:.8f}".rstrip("0").rstrip(".")
    return "0" if text in ("-0", "") else text


def numbers(values: Iterable[float]) -> str:
    return " ".join(number(v) for v in values)


def inertia(kind: str, size: tuple[float, ...], mass: float) -> tuple[float, float, float]:
    """Principal moments of a solid body [kg m2]."""
    if kind == "box":
        x, y, z = size
        return mass * (y * y + z * z) / 12, mass * (x * x + z * z) / 12, mass * (x * x + y * y) / 12
    if kind == "cylinder":
        r, h = size
        side = mass * (3 * r * r + h * h) / 12
        return side, side, mass * r * r / 2
    (r,) = size
    return (0.4 * mass * r * r,) * 3


def shape(kind: str, size: tuple[float, ...]) -> str:
    if kind == "box":
        return f"<box><size>{numbers(size)}</size></box>"
    if kind == "cylinder":
        return f"<cylinder><radius>{number(size[0])}</radius><length>{number(size[1])}</length></cylinder>"
    return f"<sphere><radius>{number(size[0])}</radius></sphere>"


def material(colour: tuple[float, float, float]) -> str:
    whole = numbers((*colour, 1.0))
    return (
        f"<material><ambient>{whole}</ambient><diffuse>{whole}</diffuse><specular>0.1 0.1 0.1 1</specular></material>"
    )


def inertial(kind: str, size: tuple[float, ...], mass: float) -> str:
    moments = zip(("ixx", "iyy", "izz"), inertia(kind, size, mass), strict=True)
    text = "".join(f"<{name}>{number(v)}</{name}>" for name, v in moments)
    return f"<inertial><mass>{number(mass)}</mass><inertia>{text}</inertia></inertial>"


def friction(mu: float) -> str:
    return f"<surface><friction><ode><mu>{number(mu)}</mu><mu2>{number(mu)}</mu2></ode></friction></surface>"


def thing_lines(thing: Thing) -> Iterator[str]:
    body = shape(thing.kind, thing.size)
    yield f'<model name="{thing.name}">'
    yield f"  <pose>{numbers((*thing.at, 0, 0, thing.yaw))}</pose>"
    yield '  <link name="link">'
    yield f"    {inertial(thing.kind, thing.size, thing.mass)}"
    yield f'    <collision name="collision"><geometry>{body}</geometry>{friction(thing.mu)}</collision>'
    yield f'    <visual name="visual"><geometry>{body}</geometry>{material(thing.colour)}</visual>'
    yield "  </link>"
    yield "</model>"


def table_lines(x: float, height: float, width: float, depth: float) -> Iterator[str]:
    """A table whose top's middle is at (x, 0)."""
    top, leg = 0.04, 0.06
    parts = [("top", (depth, width, top), (0.0, 0.0, height - top / 2))]
    for i, (sx, sy) in enumerate(((1, 1), (1, -1), (-1, 1), (-1, -1)), 1):
        at = (sx * (depth / 2 - leg), sy * (width / 2 - leg), (height - top) / 2)
        parts.append((f"leg_{i}", (leg, leg, height - top), at))
    yield '<model name="table">'
    yield "  <static>true</static>"
    yield f"  <pose>{numbers((x, 0, 0, 0, 0, 0))}</pose>"
    yield '  <link name="link">'
    for name, size, at in parts:
        pose, body = f"<pose>{numbers((*at, 0, 0, 0))}</pose>", shape("box", size)
        colour = (0.62, 0.46, 0.31) if name == "top" else (0.36, 0.37, 0.39)
        yield f'    <collision name="{name}">{pose}<geometry>{body}</geometry>{friction(0.9)}</collision>'
        yield f'    <visual name="{name}">{pose}<geometry>{body}</geometry>{material(colour)}</visual>'
    yield "  </link>"
    yield "</model>"


HEIGHT = 0.78
TABLE_X = 0.95


def on_table(name: str, kind: str, size: tuple[float, ...], mass: float, x: float, y: float,
             colour: tuple[float, float, float], mu: float = 0.9, yaw: float = 0.0) -> Thing:  # fmt: skip
    half = {"box": size[-1] / 2, "cylinder": size[-1] / 2, "sphere": size[0]}[kind]
    return Thing(name, kind, size, mass, (x, y, HEIGHT + half), colour, mu, yaw)


THINGS = (
    on_table("cube", "box", (0.05, 0.05, 0.05), 0.1, 0.76, 0.0, (0.85, 0.20, 0.18)),
    on_table("milk", "box", (0.065, 0.065, 0.20), 0.5, 0.82, -0.18, (0.93, 0.93, 0.95)),
    on_table("can", "cylinder", (0.033, 0.12), 0.35, 0.80, 0.20, (0.16, 0.52, 0.30)),
    on_table("bottle", "cylinder", (0.030, 0.24), 0.75, 0.98, -0.02, (0.22, 0.40, 0.66), 0.7),
    on_table("ball", "sphere", (0.035,), 0.06, 0.93, 0.30, (0.92, 0.55, 0.12)),
    on_table("weight", "box", (0.06, 0.06, 0.08), 1.0, 0.94, -0.32, (0.30, 0.31, 0.34)),
    on_table("book", "box", (0.15, 0.21, 0.03), 0.4, 1.10, 0.20, (0.46, 0.25, 0.48), 0.6, 0.3),
    on_table("pencil", "box", (0.012, 0.16, 0.012), 0.02, 0.72, -0.32, (0.95, 0.80, 0.20), 0.7),
)

BAXTER_THINGS = (
    on_table("cube", "box", (0.045, 0.045, 0.045), 0.1, 0.72, 0.26, (0.85, 0.20, 0.18)),
    on_table("post", "box", (0.04, 0.04, 0.12), 0.15, 0.72, -0.26, (0.20, 0.42, 0.72)),
    on_table("can", "cylinder", (0.024, 0.10), 0.2, 0.78, 0.10, (0.16, 0.52, 0.30)),
    on_table("ball", "sphere", (0.025,), 0.05, 0.76, -0.08, (0.92, 0.55, 0.12)),
    on_table("milk", "box", (0.065, 0.065, 0.20), 0.5, 0.95, 0.0, (0.93, 0.93, 0.95)),
    on_table("book", "box", (0.15, 0.21, 0.03), 0.4, 1.05, 0.32, (0.46, 0.25, 0.48), 0.6, 0.3),
)
"""The gripper of Baxter grasps what is 16 to 57 mm wide: the first four."""

HEAD = """<?xml version="1.0"?>
<!--
  {about}
  Written by assets/office/make_tables.py. Lengths m, masses kg, angles rad.
-->
<sdf version="1.12">
  <world name="{name}">

    <physics name="step_1ms" type="ignored">
      <max_step_size>0.001</max_step_size>
      <real_time_factor>1</real_time_factor>
    </physics>

    <scene>
      <ambient>0.55 0.55 0.55 1</ambient>
      <background>0.80 0.86 0.92 1</background>
      <shadows>true</shadows>
      <grid>false</grid>
    </scene>

    <light name="sun" type="directional">
      <pose>-20 15 40 0 0 0</pose>
      <direction>0.45 -0.30 -0.84</direction>
      <diffuse>0.6 0.6 0.58 1</diffuse>
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
          <geometry><plane><normal>0 0 1</normal><size>100 100</size></plane></geometry>
          <material><ambient>0.68 0.69 0.70 1</ambient><diffuse>0.68 0.69 0.70 1</diffuse></material>
        </visual>
      </link>
    </model>

    <include>
      <uri>model://{robot}</uri>
    </include>

"""

WHAT = "TIAGo at the origin looks along x at a table, 0.78 m high, "


def world(name: str, about: str, blocks: Iterable[Iterable[str]], robot: str = "tiago") -> None:
    lines = [f"    {line}" for block in blocks for line in (*block, "")]
    text = HEAD.format(name=name, about=about, robot=robot) + "\n".join([*lines, "  </world>", "</sdf>", ""])
    (WORLDS / f"{name}.sdf").write_text(text, encoding="utf-8")


def include_lines(x: float, y: float, z: float, yaw: float) -> Iterator[str]:
    yield "<include>"
    yield "  <uri>model://aruco_box</uri>"
    yield f"  <pose>{numbers((x, y, z, 0, 0, yaw))}</pose>"
    yield "</include>"


# ------------------------------------------------------------------ the box with the marker


def box_text() -> str:
    front = BOX[0] / 2 + 0.0004
    edge = MARKER * CELLS / (CELLS - 2)
    return f"""<?xml version="1.0"?>
<!--
  A box with an ArUco marker on its front (+x): number {MARKER_ID} of DICT_ARUCO_ORIGINAL, black square {MARKER} m wide.
  The link aruco_marker has the marker's frame as OpenCV counts it: in the middle, x right, y up, z out of the box.
  Written by assets/office/make_tables.py. The picture and its plate ({edge:.4f} m with the white rim) are our own.
-->
<sdf version="1.12">
  <model name="aruco_box" canonical_link="box">
    <link name="box">
      {inertial("box", BOX, BOX_MASS)}
      <collision name="collision"><geometry>{shape("box", BOX)}</geometry>{friction(0.9)}</collision>
      <visual name="visual"><geometry>{shape("box", BOX)}</geometry>{material((0.80, 0.66, 0.46))}</visual>
    </link>
    <link name="aruco_marker">
      <pose relative_to="box">{numbers((front, 0, 0, math.pi / 2, 0, math.pi / 2))}</pose>
      <inertial><mass>0.001</mass><inertia><ixx>1e-06</ixx><iyy>1e-06</iyy><izz>2e-06</izz></inertia></inertial>
      <visual name="plate">
        <geometry><mesh><uri>meshes/marker.obj</uri></mesh></geometry>
        <material>
          <ambient>1 1 1 1</ambient><diffuse>1 1 1 1</diffuse><specular>0 0 0 1</specular>
          <pbr><metal><albedo_map>materials/marker.png</albedo_map><metalness>0</metalness><roughness>1</roughness></metal></pbr>
        </material>
      </visual>
    </link>
    <joint name="aruco_marker_joint" type="fixed"><parent>box</parent><child>aruco_marker</child></joint>
  </model>
</sdf>
"""


def marker_mesh() -> str:
    half = MARKER * CELLS / (CELLS - 2) / 2
    corners = [(-half, -half), (half, -half), (half, half), (-half, half)]
    lines = ["# the marker's plate: x right, y up, seen from +z; written by make_tables.py", "o marker"]
    lines += [f"v {x:.6f} {y:.6f} 0" for x, y in corners]
    lines += ["vt 0 0", "vt 1 0", "vt 1 1", "vt 0 1", "vn 0 0 1", "f 1/1/1 2/2/1 3/3/1", "f 1/1/1 3/3/1 4/4/1", ""]
    return "\n".join(lines)


def marker_picture(path: Path) -> None:
    import cv2
    import numpy as np

    square = cv2.aruco.generateImageMarker(
        cv2.aruco.getPredefinedDictionary(cv2.aruco.DICT_ARUCO_ORIGINAL), MARKER_ID, PIXELS * (CELLS - 2)
    )
    cv2.imwrite(str(path), np.pad(square, PIXELS, constant_values=255))


CONFIG = """<?xml version="1.0"?>
<model>
  <name>Box with an ArUco marker</name>
  <version>1.0</version>
  <sdf version="1.12">model.sdf</sdf>
  <author><name>simkit</name></author>
  <description>A box with the marker 582 of DICT_ARUCO_ORIGINAL on its front.</description>
</model>
"""


if __name__ == "__main__":
    folder = HERE / "aruco_box"
    (folder / "model.sdf").write_text(box_text(), encoding="utf-8")
    (folder / "model.config").write_text(CONFIG, encoding="utf-8")
    (folder / "meshes" / "marker.obj").write_text(marker_mesh(), encoding="utf-8")
    marker_picture(folder / "materials" / "marker.png")
    table = tuple(table_lines(TABLE_X, HEIGHT, 1.1, 0.6))
    world("tiago_table", WHAT + "with objects of several shapes and weights.", [table, *map(thing_lines, THINGS)])
    about = WHAT + f"and on it at a box with an ArUco marker ({MARKER_ID}, {MARKER} m wide)."
    box = include_lines(0.86, 0.0, HEIGHT + BOX[2] / 2, math.pi - 0.55)
    world("tiago_aruco", about, [table, box])
    about = "Baxter at the origin looks along x at a table, 0.78 m high, with objects of several shapes and weights."
    world("baxter_table", about, [table, *map(thing_lines, BAXTER_THINGS)], "baxter")
