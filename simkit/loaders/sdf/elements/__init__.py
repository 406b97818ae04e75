"""What each element and attribute of SDF becomes here: the one list behind the readers' report and `docs/elements.md`.

A table belongs to one element (`link`); a row's path goes on from there (`velocity_decay/linear`, `@name`), and a row
may say that its element is described by another table. A test loads a file that has everything and compares the names
that the readers asked for with these rows, so that neither the report nor the page can go stale.
"""

from __future__ import annotations

from simkit.loaders.sdf.elements.bodies import AXIS, COLLISION, INERTIAL, JOINT, LINK, MODEL, SURFACE
from simkit.loaders.sdf.elements.looks import GEOMETRY, LIGHT, MATERIAL, VISUAL
from simkit.loaders.sdf.elements.rows import Row, Schema, Table, Use
from simkit.loaders.sdf.elements.sensors_and_plugins import FRAME, INCLUDE, PLUGIN, POSE, SENSOR
from simkit.loaders.sdf.elements.worlds import ACTOR, PHYSICS, POPULATION, SAVED_LINK, SAVED_MODEL, SDF, STATE, WORLD

__all__ = ["ELEMENTS", "TABLES", "Row", "Schema", "Table", "Use"]

TABLES: tuple[Table, ...] = (
    SDF,
    WORLD,
    PHYSICS,
    POPULATION,
    ACTOR,
    STATE,
    SAVED_MODEL,
    SAVED_LINK,
    INCLUDE,
    MODEL,
    LINK,
    INERTIAL,
    COLLISION,
    SURFACE,
    VISUAL,
    GEOMETRY,
    MATERIAL,
    LIGHT,
    JOINT,
    AXIS,
    FRAME,
    POSE,
    SENSOR,
    PLUGIN,
)
ELEMENTS = Schema(TABLES)
