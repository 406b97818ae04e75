"""Compiled MJCF file: its elements by name and by body, and the pose and names of each model in the file."""

from __future__ import annotations

import re
from collections.abc import Sequence
from dataclasses import dataclass
from typing import TYPE_CHECKING, Final

from simkit.diagnostics import Where
from simkit.loaders.resources.loader import CompiledMjcf, MjcfText
from simkit.pose import IDENTITY, Pose
from simkit.scene import ScenePlugin

if TYPE_CHECKING:
    import numpy as np
    import numpy.typing as npt

WORLD_LINK: Final = "worldbody"
"""Name of the link that holds the content of the file's world body."""

_LINE: Final = re.compile(r"line (\d+)")


@dataclass(frozen=True)
class ModelPlacement:
    """Bodies of a file that form one model, and the poses and names of this model.

    Attributes:
        roots: ids of the model's top-level bodies.
        has_world: true if the content of the world body belongs to the model.
        frame: pose of the model frame in the file's world.
        pose_world: pose of the model frame in the world.
        prefix: prefix of the model's names in the compiled world.
        strip: prefix of the names in the file; the names in the scene do not have it.
    """

    name: str
    scoped: str
    roots: Sequence[int]
    has_world: bool
    frame: Pose = IDENTITY
    pose_world: Pose = IDENTITY
    prefix: str = ""
    strip: str = ""
    static: bool = False
    base: str = "auto"
    plugins: tuple[ScenePlugin, ...] = ()
    where: Where | None = None


class CompiledFile:
    """MJCF file with MuJoCo's compiled model, and the elements of each body.

    Args:
        source: the MJCF text with its files.
        compiled: MuJoCo's specification, model and initial state for this text.
    """

    def __init__(self, source: MjcfText, compiled: CompiledMjcf) -> None:
        self.source, self.compiled = source, compiled
        self.spec, self.model, self.data = compiled.spec, compiled.model, compiled.data
        model = self.model
        pairs = {int(g) for ids in (model.pair_geom1, model.pair_geom2) for g in ids}
        self.colliding = {
            g for g in range(model.ngeom) if model.geom_contype[g] or model.geom_conaffinity[g] or g in pairs
        }
        self.settings = _engine_settings(source)
        self.sites_of = _ids_by_owner(model.site_bodyid)
        self.lights_of = _ids_by_owner(model.light_bodyid)
        self.equalities_of = _ids_by_owner(model.eq_obj1id)
        self.bodies_of = _ids_by_owner(model.body_rootid)

    def name(self, kind: str, number: int) -> str:
        """Return the name of an element, by MuJoCo's object type (`BODY`, `GEOM`, ...) and the element's id."""
        return self.compiled.name(kind, number)

    @property
    def roots(self) -> list[int]:
        """Ids of the top-level bodies."""
        return [b for b in range(1, self.model.nbody) if self.model.body_parentid[b] == 0]

    @property
    def has_world(self) -> bool:
        """True if the world body itself has geoms."""
        return bool(self.model.body_geomnum[0])

    def pose(self, body: int) -> Pose:
        """Return the pose of a body in the file's world, in the initial state."""
        return Pose(self.data.xpos[body], self.data.xquat[body])

    def where(self, kind: str, name: str) -> Where:
        """Return file and line of a named element; `kind` is MuJoCo's element type (`body`, `geom`, ...)."""
        element = getattr(self.spec, kind)(name)
        match = _LINE.search(element.info) if element is not None else None
        return self.source.where(int(match[1])) if match is not None else self.source.root.where

    def link_name(self, body: int, placed: ModelPlacement) -> str:
        """Return the name of a body's link within its model."""
        return WORLD_LINK if body == 0 else self.name("BODY", body).removeprefix(placed.strip)

    def scoped_link(self, body: int, placed: ModelPlacement) -> str:
        """Return the scoped name of a body's link, from the world down."""
        return f"{placed.scoped}::{self.link_name(body, placed)}"


def _ids_by_owner(owners: npt.NDArray[np.int32]) -> dict[int, list[int]]:
    """Group element ids by the id of the body or joint that each element belongs to."""
    ids: dict[int, list[int]] = {}
    for number, owner in enumerate(owners.tolist()):
        ids.setdefault(owner, []).append(number)
    return ids


def _engine_settings(source: MjcfText) -> dict[str, Where]:
    """Return file and line of each engine setting, by its name: options, flags and other global elements."""
    settings: dict[str, Where] = {}
    for element in source.root.children:
        if element.name == "option":
            settings.update(dict.fromkeys(element.attributes, element.where))
            for flag in element.children:
                settings.update({f"flag {name}": flag.where for name in flag.attributes})
        elif element.name in ("size", "visual", "statistic", "keyframe"):
            settings.setdefault(f"<{element.name}>", element.where)
    return settings
