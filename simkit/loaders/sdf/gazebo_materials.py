"""The material scripts that come with Gazebo: their colours, by name."""

from __future__ import annotations

import csv
import functools
from collections.abc import Mapping
from pathlib import Path
from typing import Final

from simkit.scene.model import Colour

_COLUMNS: Final = ("ambient", "diffuse", "specular", "emissive")


@functools.cache
def gazebo_materials() -> Mapping[str, Mapping[str, Colour]]:
    """Ambient, diffuse, specular and emissive colour by the name behind `Gazebo/`, from `gazebo_materials.csv`.

    Colours are RGBA from 0 to 1; the diffuse one carries the opacity. One number in a column stands for three equal
    ones. Of a textured material the diffuse colour is the mean of its picture, which is not part of the table.
    """
    table: dict[str, Mapping[str, Colour]] = {}
    with Path(__file__).with_name("gazebo_materials.csv").open(encoding="utf-8", newline="") as file:
        for row in csv.DictReader(file):
            colours = {column: _opaque(row[column]) for column in _COLUMNS}
            colours["diffuse"] = (*colours["diffuse"][:3], float(row["opacity"] or 1.0))
            table.update(dict.fromkeys(row["names"].split(), colours))
    return table


def _opaque(column: str) -> Colour:
    numbers = [float(v) for v in column.split()] or [0.0]
    r, g, b = numbers if len(numbers) == 3 else numbers * 3
    return r, g, b, 1.0


def gazebo_colours(name: str) -> dict[str, Colour]:
    """The colours of a material that comes with Gazebo, by its full name; empty where there is none."""
    return dict(gazebo_materials().get(name.removeprefix("Gazebo/"), {}))
