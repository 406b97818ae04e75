"""Colours of the material scripts that Gazebo provides, by name."""

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
    """Return ambient, diffuse, specular and emissive colours by the name after `Gazebo/`, from `gazebo_materials.csv`.

    Colours are RGBA from 0 to 1; the diffuse colour contains the opacity. One number in a column means three equal
    numbers. The diffuse colour of a textured material is the mean of its image, which the table does not contain.
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
    """Return the colours of one of Gazebo's materials by its full name; empty if the name is unknown."""
    return dict(gazebo_materials().get(name.removeprefix("Gazebo/"), {}))
