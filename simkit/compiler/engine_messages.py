"""Translation of MuJoCo's error messages: names of the user's file replace the names of simkit's own elements."""

from __future__ import annotations

import re
from collections.abc import Sequence
from typing import Final

import mujoco

from simkit.compiler.name_map import GeomOwner, ModelRecord
from simkit.diagnostics import Where
from simkit.scene import SceneCollision, SceneVisual

_ASSET: Final = re.compile(r"\b(mesh|texture|material|heights)[#_][0-9a-f]{6,}(#textured)?(\.\w+)?")
_GEOM_NUMBER: Final = re.compile(r"#v?\d+(?=')")
_ENGINE_NUMBER: Final = re.compile(r",? (at )?id -?\d+")


def user_message(text: str, spec: mujoco.MjSpec, records: Sequence[ModelRecord], where: Where) -> tuple[str, Where]:
    """Return an engine's message with the names of the user's file, and the place of the element that it concerns.

    A mesh, material or height map has an internal name such as `mesh#f7af`. The message names its file and the
    collision or visual instead. Numbers of the engine's elements are removed.

    Args:
        text: message of the engine.
        spec: specification that the engine refused.
        records: elements of the models in the specification.
        where: place for a message that concerns no collision or visual.
    """
    found = where
    for match in dict.fromkeys(m.group() for m in _ASSET.finditer(text)):
        shape = _shape_with_asset(match, spec, records)
        name = "an asset of simkit"
        if shape is not None:
            name, found = f"{getattr(shape.geometry, 'uri', '') or 'the shape'} of {shape.scoped}", shape.where
        text = text.replace(f"'{match}'", name).replace(match, name)
    return _ENGINE_NUMBER.sub("", _GEOM_NUMBER.sub("", text)), found


def _shape_with_asset(
    name: str, spec: mujoco.MjSpec, records: Sequence[ModelRecord]
) -> SceneCollision | SceneVisual | None:
    """Return the first collision or visual whose geoms use an asset; None if there is none."""
    owners = {geom: owner for record in records for geom, owner in record.geoms.items()}
    links = {scoped: binding.scene for record in records for scoped, binding in record.links.items()}
    for geom in spec.geoms:
        owner: GeomOwner | None = owners.get(geom.name)
        names = (geom.meshname, geom.hfieldname, geom.material)
        if owner is None or not any(n and (n == name or name.startswith(n.replace("#", "_"))) for n in names):
            continue
        link = links.get(owner.link)
        shapes: Sequence[SceneCollision | SceneVisual] = () if link is None else (*link.collisions, *link.visuals)
        return next((shape for shape in shapes if shape.scoped == owner.scoped), None)
    return None
