"""What a compiled MJCF file says of its bodies, joints, geoms and lights, as a scene."""

from __future__ import annotations

import re
from collections.abc import Iterable
from pathlib import Path
from typing import Any, Final

from simkit.diagnostics import Where
from simkit.loaders.mjcf.element_ids import ElementIds, ModelPlacement
from simkit.loaders.mjcf.engine import first_state, name_of
from simkit.loaders.mjcf.gathered_file import GatheredFile
from simkit.loaders.mjcf.joints import read_joints
from simkit.loaders.mjcf.lights import read_lights
from simkit.pose import Pose
from simkit.scene import (
    Box,
    Capsule,
    Cylinder,
    Ellipsoid,
    Empty,
    Geometry,
    Heightmap,
    Inertial,
    Material,
    Mesh,
    Plane,
    SceneCollision,
    SceneFrame,
    SceneLink,
    SceneModel,
    SceneVisual,
    Sphere,
    Surface,
)
from simkit.scene.mjcf_source import MjcfGeom, MjcfSource

WORLD_LINK: Final = "worldbody"
"""Name of the link that holds what a file puts into its world body."""

_PLANE, _HFIELD, _SPHERE, _CAPSULE, _ELLIPSOID, _CYLINDER, _BOX, _MESH, _SDF = range(9)
_SHOWN_GROUPS: Final = 3
"""Geoms of the groups below this are drawn: MuJoCo's own viewers show those from the start."""

_LINE: Final = re.compile(r"line (\d+)")


class ModelReader:
    """Reads models out of one compiled file.

    Args:
        bundle: the file.
        spec, model: MuJoCo's specification of it and what that compiles to.
        document: makes a fresh specification of the same content.
    """

    def __init__(self, bundle: GatheredFile, spec: Any, model: Any, document: Any) -> None:
        self.bundle, self.spec, self.model, self.document = bundle, spec, model, document
        self.data = first_state(model)
        pairs = {int(g) for ids in (model.pair_geom1, model.pair_geom2) for g in ids}
        self.colliding = {
            g for g in range(model.ngeom) if model.geom_contype[g] or model.geom_conaffinity[g] or g in pairs
        }
        self.settings = _engine_settings(bundle)
        self.sites_of = _ids_by_owner(model.site_bodyid)
        self.lights_of = _ids_by_owner(model.light_bodyid)
        self.equalities_of = _ids_by_owner(model.eq_obj1id)
        self.bodies_of = _ids_by_owner(model.body_rootid)

    def name(self, kind: str, number: int) -> str:
        """The name of an element of the compiled model."""
        return name_of(self.model, kind, number)

    @property
    def roots(self) -> list[int]:
        """Ids of the top-level bodies."""
        return [b for b in range(1, self.model.nbody) if self.model.body_parentid[b] == 0]

    @property
    def has_world(self) -> bool:
        """Whether anything solid stands in the world body itself."""
        return bool(self.model.body_geomnum[0])

    def pose(self, body: int) -> Pose:
        """Pose of a body in the file's world, as the file stands."""
        return Pose(self.data.xpos[body], self.data.xquat[body])

    def where(self, kind: str, name: str) -> Where:
        """The line of a named element."""
        element = getattr(self.spec, kind)(name)
        found = _LINE.search(element.info) if element is not None else None
        return self.bundle.where(int(found[1])) if found is not None else self.bundle.root.where

    # ------------------------------------------------------------------ models

    def read(self, placed: ModelPlacement) -> SceneModel:
        """One model with its links, joints and frames."""
        found = ElementIds()
        place = placed.pose_world @ placed.frame.inverse()
        bodies = sorted(b for root in placed.roots for b in self.bodies_of[root])
        links = [self._link(b, placed, place, found) for b in ([0] if placed.has_world else []) + bodies]
        joints = [j for b in bodies for j in read_joints(self, b, placed, place, found)]
        frames = [f for b in ([0] if placed.has_world else []) + bodies for f in self._frames(b, placed, place)]
        canonical = self.scoped_link(placed.roots[0], placed) if placed.roots else links[0].scoped if links else ""
        source = MjcfSource(
            document=self.document,
            place=place,
            prefix=placed.prefix,
            roots=tuple(self.name("BODY", b) for b in placed.roots),
            bodies=found.bodies,
            joints=found.joints,
            free=found.free,
            geoms=found.geoms,
            lights=found.lights,
            masses=found.masses,
            base=placed.base,
            settings=self.settings,
        )
        return SceneModel(
            name=placed.name,
            scoped=placed.scoped,
            pose_world=placed.pose_world,
            static=placed.static,
            declared_static=placed.static,
            self_collide=True,
            canonical_link=canonical,
            base=placed.base,
            links=tuple(links),
            joints=tuple(joints),
            frames=tuple(frames),
            plugins=placed.plugins,
            where=placed.where or (links[0].where if links else self.bundle.root.where),
            mjcf=source,
        )

    def link_name(self, body: int, placed: ModelPlacement) -> str:
        """What a body's link is called within its model."""
        return WORLD_LINK if body == 0 else self.name("BODY", body).removeprefix(placed.strip)

    def scoped_link(self, body: int, placed: ModelPlacement) -> str:
        """The same from the world down."""
        return f"{placed.scoped}::{self.link_name(body, placed)}"

    def _link(self, body: int, placed: ModelPlacement, place: Pose, found: ElementIds) -> SceneLink:
        model, name = self.model, self.link_name(body, placed)
        scoped = f"{placed.scoped}::{name}"
        found.bodies[scoped] = self.name("BODY", body)
        if body:
            found.masses[self.name("BODY", body)] = (
                float(model.body_mass[body]),
                tuple(model.body_ipos[body].tolist()),
                tuple(model.body_iquat[body].tolist()),
                tuple(model.body_inertia[body].tolist()),
            )
        pose = place @ self.pose(body)
        collisions: list[SceneCollision] = []
        visuals: list[SceneVisual] = []
        for g in range(model.body_geomadr[body], model.body_geomadr[body] + model.body_geomnum[body]):
            self._geom(g, scoped, collisions, visuals, found)
        lights = read_lights(self, body, scoped, pose, found) if body else ()
        return SceneLink(
            name=name,
            scoped=scoped,
            pose_world=pose,
            inertial=self._inertial(body),
            gravity=float(model.body_gravcomp[body]) != 1.0,
            kinematic=int(model.body_mocapid[body]) >= 0,
            self_collide=True,
            collisions=tuple(collisions),
            visuals=tuple(visuals),
            lights=lights,
            where=self.where("body", self.name("BODY", body)) if body else self.bundle.root.where,
        )

    def _inertial(self, body: int) -> Inertial:
        model = self.model
        turn = Pose((0.0, 0.0, 0.0), model.body_iquat[body]).matrix
        i = (turn * model.body_inertia[body]) @ turn.T
        xx, yy, zz, xy, xz, yz = (float(v) for v in (i[0, 0], i[1, 1], i[2, 2], i[0, 1], i[0, 2], i[1, 2]))
        x, y, z = (float(v) for v in model.body_ipos[body])
        return Inertial(float(model.body_mass[body]), (x, y, z), (xx, yy, zz, xy, xz, yz))

    def _frames(self, body: int, placed: ModelPlacement, place: Pose) -> Iterable[SceneFrame]:
        model = self.model
        for s in self.sites_of.get(body, ()):
            name = self.name("SITE", s).removeprefix(placed.strip)
            pose = place @ self.pose(body) @ Pose(model.site_pos[s], model.site_quat[s])
            yield SceneFrame(name, f"{placed.scoped}::{name}", pose, self.scoped_link(body, placed))

    # ------------------------------------------------------------------ geoms

    def _geom(
        self, g: int, link: str, collisions: list[SceneCollision], visuals: list[SceneVisual], found: ElementIds
    ) -> None:
        model, name = self.model, self.name("GEOM", g)
        collides, drawn = g in self.colliding, int(model.geom_group[g]) < _SHOWN_GROUPS
        shape, pose = self._shape(g)
        where = self.where("geom", name)
        scoped = f"{link}::{name}"
        found.geoms[name] = MjcfGeom(link, scoped, collides, drawn)
        if collides:
            surface = Surface(
                mu=float(model.geom_friction[g][0]) if model.geom_condim[g] > 1 else 0.0,
                mu2=float(model.geom_friction[g][0]) if model.geom_condim[g] > 1 else 0.0,
                torsional=float(model.geom_friction[g][1]),
                where=where,
            )
            collisions.append(SceneCollision(name, scoped, pose, shape, surface, where=where))
        if drawn:
            visuals.append(SceneVisual(name, scoped, pose, shape, self._material(g), where=where))

    def _material(self, g: int) -> Material:
        model = self.model
        colour = model.geom_rgba[g]
        number = int(model.geom_matid[g])
        if number >= 0 and colour.tolist() == [0.5, 0.5, 0.5, 1.0]:
            colour = model.mat_rgba[number]
        r, gr, b, a = (float(c) for c in colour)
        return Material(ambient=(r, gr, b, a), diffuse=(r, gr, b, a))

    def _shape(self, g: int) -> tuple[Geometry, Pose]:
        """The shape of a geom, and its pose in the link; a mesh's is that of its file's own axes."""
        model = self.model
        pose = Pose(model.geom_pos[g], model.geom_quat[g])
        a, b, c = (float(s) for s in model.geom_size[g])
        kind, number = int(model.geom_type[g]), int(model.geom_dataid[g])
        if kind in (_MESH, _SDF):
            own = Pose(model.mesh_pos[number], model.mesh_quat[number])
            file, uri = self._file("mesh", self.name("MESH", number))
            x, y, z = (float(v) for v in model.mesh_scale[number])
            return Mesh(file, uri, (x, y, z), missing=not file.is_file()), pose @ own.inverse()
        if kind == _HFIELD:
            file, uri = self._file("hfield", self.name("HFIELD", number))
            x, y, z, _ = (float(v) for v in model.hfield_size[number])
            return Heightmap(file, uri, (2 * x, 2 * y, z)), pose
        shapes: dict[int, Geometry] = {
            _PLANE: Plane(size=(2 * a or 100.0, 2 * b or 100.0)),
            _SPHERE: Sphere(a),
            _CAPSULE: Capsule(a, 2 * b),
            _CYLINDER: Cylinder(a, 2 * b),
            _ELLIPSOID: Ellipsoid((a, b, c)),
            _BOX: Box((2 * a, 2 * b, 2 * c)),
        }
        return shapes.get(kind, Empty()), pose

    def _file(self, kind: str, name: str) -> tuple[Path, str]:
        """The user's file behind an asset; for one that is written in the model, that file and the asset's name."""
        asset = getattr(self.spec, kind)(name)
        key = asset.file if asset is not None else ""
        if key in self.bundle.files:
            return self.bundle.files[key]
        return Path(self.bundle.file or ""), f"#{name}"


def _ids_by_owner(owners: Any) -> dict[int, list[int]]:
    """Numbers of elements by the number of what they belong to."""
    found: dict[int, list[int]] = {}
    for number, owner in enumerate(owners.tolist()):
        found.setdefault(owner, []).append(number)
    return found


def _engine_settings(bundle: GatheredFile) -> dict[str, Where]:
    """What the file itself says of the engine: option attributes and flags, and other global elements, with lines."""
    found: dict[str, Where] = {}
    for element in bundle.root.children:
        if element.name == "option":
            found.update(dict.fromkeys(element.attributes, element.where))
            for flag in element.children:
                found.update({f"flag {name}": flag.where for name in flag.attributes})
        elif element.name in ("size", "visual", "statistic", "keyframe"):
            found.setdefault(f"<{element.name}>", element.where)
    return found
