"""Writes the house, `turtlebot3_house/model.sdf`: five rooms and a hall, with their furniture, all of it static.

    python assets/turtlebot3/make_house.py

The plan is our own. x points east, y north; the floor's upper side is z = 0. Lengths m.

        +------------------+-----------+------------------+  y 4.4
        |     bedroom      |  bathroom |      study       |
        |                  |           |                  |
        +-----------/ /----+----/ /----+--/ /-------------+  y 1.6
        |                      hall                       |
        +---------------/ /----+----------/ /-------------+  y 0.4
        |                      |                          |
        |        living       / /        kitchen          |
        |                      |                          |
        +----------------------+--------------------------+  y -3.6
      x -6                    0.5                         6
"""

from __future__ import annotations

import math
from collections.abc import Iterator
from dataclasses import dataclass
from pathlib import Path

from furniture import (
    LOOKS,
    Part,
    Piece,
    bookshelf,
    box,
    chair,
    coffee_table,
    counter,
    dining_table,
    floor_lamp,
    fridge,
    piece,
    plant,
    rug,
    sofa,
    tv_bench,
)
from furniture_private import (
    bathtub,
    bed,
    coat_stand,
    desk,
    night_stand,
    office_chair,
    picture,
    shoe_bench,
    toilet,
    wardrobe,
    wash_stand,
    washing_machine,
)
from robots_text import indented, number, numbers, pose_lines, shape_text

HEIGHT = 2.4
OUTER, INNER = 0.20, 0.12
DOOR_TOP, SILL, WINDOW_TOP = 2.05, 0.90, 2.05

HEADER = """<?xml version="1.0"?>
<!--
  A house of five rooms and a hall, with furniture. Written by make_house.py, where its plan is drawn.
  The origin lies on the floor of the living room; x points east, y north. Everything is static.
  Lengths m, angles rad.
-->"""


@dataclass(frozen=True, slots=True)
class Opening:
    """A hole in a wall: its middle along the wall, its width, and whether it is a window (else a doorway)."""

    middle: float
    width: float
    window: bool = False


@dataclass(frozen=True, slots=True)
class Wall:
    """A wall along x (`level` is its y) or along y (`level` is its x), from `start` to `end`."""

    name: str
    along: str
    level: float
    start: float
    end: float
    thick: float = INNER
    openings: tuple[Opening, ...] = ()


WALLS = (
    Wall("south", "x", -3.6, -6.1, 6.1, OUTER, (Opening(-3.6, 2.0, True), Opening(3.6, 1.6, True))),
    Wall("north", "x", 4.4, -6.1, 6.1, OUTER, (Opening(-0.1, 0.7, True), Opening(3.4, 1.8, True))),
    Wall("west", "y", -6.0, -3.5, 4.3, OUTER, (Opening(-1.4, 1.4, True), Opening(3.0, 1.4, True))),
    Wall("east", "y", 6.0, -3.5, 4.3, OUTER, (Opening(-1.9, 1.4, True), Opening(1.0, 0.6, True))),
    Wall("hall_south", "x", 0.4, -5.9, 5.9, INNER, (Opening(-1.1, 1.4), Opening(2.6, 1.0))),
    Wall("hall_north", "x", 1.6, -5.9, 5.9, INNER, (Opening(-2.5, 0.9), Opening(0.5, 0.9), Opening(2.3, 0.9))),
    Wall("living_kitchen", "y", 0.5, -3.5, 0.34, INNER, (Opening(-0.55, 1.1),)),
    Wall("bedroom_bathroom", "y", -1.6, 1.66, 4.3),
    Wall("bathroom_study", "y", 1.4, 1.66, 4.3),
)

FLOORS = (  # name, look, look of the joints, distance of the joints, x from, x to, y from, y to
    ("living_floor", "oak_floor", "oak_joint", 0.25, -5.9, 0.5, -3.5, 0.4),
    ("kitchen_floor", "tiles", "tile_joint", 0.60, 0.5, 5.9, -3.5, 0.4),
    ("hall_floor", "oak_floor", "oak_joint", 0.25, -5.9, 5.9, 0.4, 1.6),
    ("bedroom_floor", "carpet", "", 0.0, -5.9, -1.6, 1.6, 4.3),
    ("bathroom_floor", "bath_tiles", "tile_joint", 0.40, -1.6, 1.4, 1.6, 4.3),
    ("study_floor", "oak_floor", "oak_joint", 0.25, 1.4, 5.9, 1.6, 4.3),
)


def furniture() -> tuple[Piece, ...]:
    return (
        # living
        sofa(3).at("sofa", -3.6, -2.95),
        sofa(1).at("armchair", -5.25, -1.55, -90),
        rug(2.6, 1.9).at("rug", -3.6, -1.75),
        coffee_table().at("coffee_table", -3.6, -1.85),
        tv_bench().at("tv_bench", -3.9, 0.06, 180),
        bookshelf(1.2).at("bookshelf", -0.6, -3.32),
        floor_lamp().at("floor_lamp", -5.45, -3.1),
        plant().at("plant_living", 0.10, -3.15),
        # kitchen
        counter(4.2, sink=0.6, hob=-1.2).at("counter", 3.75, -3.19),
        fridge().at("fridge", 1.05, -3.16),
        counter(1.8).at("sideboard", 5.58, -1.95, 90),
        dining_table().at("dining_table", 2.7, -1.75),
        chair().at("chair_1", 2.25, -1.12, 180),
        chair().at("chair_2", 3.15, -1.10, 184),
        chair().at("chair_3", 2.25, -2.40, 0),
        chair().at("chair_4", 3.15, -2.36, -8),
        plant(0.5).at("plant_kitchen", 5.55, -0.25),
        # hall
        shoe_bench().at("shoe_bench", -4.6, 0.66),
        coat_stand().at("coat_stand", -5.55, 1.35),
        plant().at("plant_hall", 5.60, 1.30),
        front_door().at("front_door", -5.89, 1.0, -90),
        picture("terracotta").at("picture_hall_1", -0.9, 1.54, 180),
        picture("book_blue", 0.5, 0.7).at("picture_hall_2", 3.6, 1.54, 180),
        picture("sofa", 1.0, 0.6).at("picture_living", -1.7, -3.5),
        # bedroom
        bed().at("bed", -4.80, 3.0, -90),
        night_stand().at("night_stand_1", -5.62, 1.92, -90),
        night_stand().at("night_stand_2", -5.62, 4.02, -90),
        wardrobe().at("wardrobe", -2.5, 3.98, 180),
        rug(1.4, 0.9).at("bedroom_rug", -3.0, 2.75, 90),
        # bathroom
        bathtub().at("bathtub", -0.62, 3.90),
        toilet().at("toilet", 0.95, 3.90, 180),
        wash_stand().at("wash_stand", -1.28, 2.55, -90),
        washing_machine().at("washing_machine", 1.02, 2.75, 90),
        # study
        desk().at("desk", 3.4, 3.90, 180),
        office_chair().at("office_chair", 3.50, 3.15, 160),
        bookshelf(1.4, 2.0).at("study_shelf", 5.72, 2.85, 90),
        sofa(1).at("reading_chair", 2.05, 3.75, 225),
        plant(0.5).at("plant_study", 5.60, 4.0),
    )


def front_door() -> Piece:
    """Closed, in the west wall; for the eye."""
    return piece(
        box("leaf", (0.95, 0.05, 2.05), (0, 0.02, 1.025), "door", felt=False),
        box("handle", (0.14, 0.03, 0.03), (0.36, 0.06, 1.02), "steel", felt=False),
    )


def wall_parts(wall: Wall) -> Iterator[Part]:
    """The wall's blocks around its openings, window panes and frames."""
    reached = wall.start
    for i, opening in enumerate(sorted(wall.openings, key=lambda o: o.middle), 1):
        left, right = opening.middle - opening.width / 2, opening.middle + opening.width / 2
        yield _block(wall, f"{wall.name}_{i}", reached, left, 0, HEIGHT)
        top = WINDOW_TOP if opening.window else DOOR_TOP
        yield _block(wall, f"{wall.name}_{i}_lintel", left, right, top, HEIGHT)
        if opening.window:
            yield _block(wall, f"{wall.name}_{i}_sill", left, right, 0, SILL)
            yield _block(wall, f"{wall.name}_{i}_pane", left, right, SILL, top, "glass", 0.02)
            for name, at in (("left", left), ("right", right), ("middle", opening.middle)):
                yield _block(
                    wall, f"{wall.name}_{i}_{name}", at - 0.025, at + 0.025, SILL, top, "white", 0.08, felt=False
                )
            yield _block(
                wall, f"{wall.name}_{i}_board", left, right, SILL, SILL + 0.03, "white", wall.thick + 0.10, felt=False
            )
        else:
            for name, at in (("left", left + 0.015), ("right", right - 0.015)):
                yield _block(
                    wall, f"{wall.name}_{i}_{name}", at - 0.015, at + 0.015, 0, top, "white", wall.thick + 0.04
                )
            yield _block(
                wall, f"{wall.name}_{i}_head", left, right, top - 0.03, top, "white", wall.thick + 0.04, felt=False
            )
        reached = right
    yield _block(wall, f"{wall.name}_end", reached, wall.end, 0, HEIGHT)


def _block(
    wall: Wall,
    name: str,
    start: float,
    end: float,
    low: float,
    high: float,
    look: str = "",
    thick: float = 0.0,
    *,
    felt: bool = True,
) -> Part:
    long, middle = end - start, (start + end) / 2
    thick = thick or wall.thick
    look = look or ("facade" if wall.thick == OUTER else "plaster")
    z, tall = (low + high) / 2, high - low
    if wall.along == "x":
        return box(name, (long, thick, tall), (middle, wall.level, z), look, felt=felt)
    return box(name, (thick, long, tall), (wall.level, middle, z), look, felt=felt)


def floors() -> Iterator[Part]:
    """Boards, tiles and carpet: for the eye, a few millimetres above the ground that carries everything."""
    for name, look, joint, pitch, x0, x1, y0, y1 in FLOORS:
        middle_x, middle_y = (x0 + x1) / 2, (y0 + y1) / 2
        yield box(name, (x1 - x0, y1 - y0, 0.004), (middle_x, middle_y, 0), look, felt=False)
        if not joint:
            continue
        rows = math.floor((y1 - y0) / pitch)
        for i in range(1, rows + 1):
            yield box(f"{name}_row_{i}", (x1 - x0, 0.010, 0.008), (middle_x, y0 + i * pitch, 0), joint, felt=False)
        if joint == "tile_joint":
            for i in range(1, math.floor((x1 - x0) / pitch) + 1):
                yield box(f"{name}_line_{i}", (0.010, y1 - y0, 0.008), (x0 + i * pitch, middle_y, 0), joint, felt=False)


def model_text() -> str:
    shell = piece(*(wall_parts(wall) for wall in WALLS)).at("walls", 0, 0)
    ground = piece(floors()).at("floors", 0, 0)
    lines = [HEADER, '<sdf version="1.12">', '  <model name="turtlebot3_house">', "    <static>true</static>"]
    for item in (ground, shell, *furniture()):
        lines += ["", *indented(_link(item), 2)]
    return "\n".join([*lines, "", "  </model>", "</sdf>"]) + "\n"


def _link(item: Piece) -> Iterator[str]:
    yield f'<link name="{item.name}">'
    yield from indented(pose_lines((rounded(item.x), rounded(item.y), 0), (0, 0, rounded(item.yaw))), 1)
    for part in item.parts:
        place = pose_lines(tuple(rounded(v) for v in part.xyz), part.rpy)
        shape = f"<geometry>{shape_text(part.shape)}</geometry>"
        if part.felt:
            yield f'  <collision name="{part.name}">'
            yield from indented([*place, shape], 2)
            yield "  </collision>"
        if part.seen:
            yield f'  <visual name="{part.name}">'
            yield from indented([*place, shape, *_material(part.look)], 2)
            if part.look == "glass":
                yield "    <cast_shadows>false</cast_shadows>"
            yield "  </visual>"
    yield "</link>"


def _material(look: str) -> Iterator[str]:
    red, green, blue, opacity, shine = LOOKS[look]
    colour = f"{numbers((red, green, blue))} {number(opacity)}"
    glow = "<emissive>0.6 0.55 0.4 1</emissive>" if look == "lamp" else ""
    specular = f"<specular>{numbers((shine,) * 3)} 1</specular>"
    yield f"<material><ambient>{colour}</ambient><diffuse>{colour}</diffuse>{specular}{glow}</material>"


def rounded(value: float) -> float:
    return round(value, 6) + 0.0


CONFIG = """<?xml version="1.0"?>
<model>
  <name>TurtleBot3 House</name>
  <version>1.0</version>
  <sdf version="1.12">model.sdf</sdf>
  <author>
    <name>simkit</name>
  </author>
  <description>
    Living room, kitchen, bedroom, bathroom, study and hall with their furniture, of our own design. Static.
  </description>
</model>
"""


def files() -> dict[Path, str]:
    """Every file that is written, with its text; paths relative to this folder."""
    folder = Path("turtlebot3_house")
    return {folder / "model.sdf": model_text(), folder / "model.config": CONFIG}


def main() -> None:
    for path, text in files().items():
        (Path(__file__).parent / path).parent.mkdir(exist_ok=True)
        (Path(__file__).parent / path).write_text(text, encoding="utf-8")
        print(path)


if __name__ == "__main__":
    main()
