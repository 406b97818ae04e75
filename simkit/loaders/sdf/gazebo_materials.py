"""The material scripts that come with Gazebo: their colours, by name."""

from __future__ import annotations

import csv
import functools
from collections.abc import Mapping
from dataclasses import dataclass
from pathlib import Path
from types import MappingProxyType
from typing import Final

from simkit.scene.model import Colour

_COLUMNS: Final = ("ambient", "diffuse", "specular", "emissive")


@dataclass(frozen=True, slots=True)
class ScriptColours:
    """Colours of one material script, RGBA from 0 to 1; `diffuse` carries the opacity."""

    ambient: Colour
    diffuse: Colour
    specular: Colour
    emissive: Colour


@functools.cache
def gazebo_materials() -> Mapping[str, ScriptColours]:
    """The colours by the name behind `Gazebo/`, from `gazebo_materials.csv`.

    One number in a column stands for three equal ones. Of a textured material the diffuse colour is the mean of its
    picture, which is not part of the table.
    """
    table = {}
    with Path(__file__).with_name("gazebo_materials.csv").open(encoding="utf-8", newline="") as file:
        for row in csv.DictReader(file):
            ambient, diffuse, specular, emissive = (_opaque(row[column]) for column in _COLUMNS)
            colours = ScriptColours(ambient, (*diffuse[:3], float(row["opacity"] or 1.0)), specular, emissive)
            table.update(dict.fromkeys(row["names"].split(), colours))
    return MappingProxyType(table)


def _opaque(column: str) -> Colour:
    numbers = [float(v) for v in column.split()] or [0.0]
    r, g, b = numbers if len(numbers) == 3 else numbers * 3
    return r, g, b, 1.0


def gazebo_material(name: str) -> ScriptColours | None:
    """The colours of a material that comes with Gazebo, by its full name; None where there is none."""
    return gazebo_materials().get(name.removeprefix("Gazebo/")) if name else None
