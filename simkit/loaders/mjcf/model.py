"""Reader of one model: converts the bodies, joints, geoms and lights of a compiled MJCF file to a scene."""

from __future__ import annotations

from collections.abc import Iterable
from pathlib import Path
from typing import Final

from simkit.linear_algebra import matmul
from simkit.loaders.mjcf.compiled_file import CompiledFile, ModelPlacement
from simkit.loaders.mjcf.joints import read_joints
from simkit.loaders.mjcf.lights import read_lights
from simkit.loaders.sdf.inertial import moments_of
from simkit.pose import Pose
from simkit.scene import Inertial, Material, SceneCollision, SceneFrame, SceneLink, SceneModel, SceneVisual, Surface
from simkit.scene import geometry as shapes
from simkit.scene.geometry import Geometry, vec3
from simkit.scene.mjcf_source import MjcfGeom, MjcfSource

_PLANE, _HFIELD, _SPHERE, _CAPSULE, _ELLIPSOID, _CYLINDER, _BOX, _MESH, _SDF = range(9)
_SHOWN_GROUPS: Final = 3
"""Number of geom groups that are drawn: groups 0 to 2, which MuJoCo's own viewers show by default."""


class ModelReader:
    """Reader of one model in a compiled file.

    Args:
        file: the compiled file.
        placed: the bodies of the model and its poses.
    """

    def __init__(self, file: CompiledFile, placed: ModelPlacement) -> None:
        self._file, self._placed = file, placed
        self._model = file.model
        self._place = placed.pose_world @ placed.frame.inverse()
        self._source = MjcfSource(
            document=file.compiled.document,
            place=self._place,
            prefix=placed.prefix,
            roots=tuple(file.name("BODY", b) for b in placed.roots),
            base=placed.base,
            settings=file.settings,
        )

    def read(self) -> SceneModel:
        """Return the model with its links, joints and frames."""
        file, placed = self._file, self._placed
        bodies = sorted(b for root in placed.roots for b in file.bodies_of[root])
        own_bodies = [*((0,) if placed.has_world else ()), *bodies]
        links = [self._link(b) for b in own_bodies]
        joints = [j for b in bodies for j in read_joints(file, b, placed, self._place, self._source)]
        frames = [f for b in own_bodies for f in self._frames(b)]
        canonical = file.scoped_link(placed.roots[0], placed) if placed.roots else links[0].scoped if links else ""
        model = SceneModel(
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
            where=placed.where or (links[0].where if links else file.source.root.where),
            mjcf=self._source,
        )
        self._source.as_read[""] = model
        return model

    def _link(self, body: int) -> SceneLink:
        file, model, source = self._file, self._model, self._source
        name = file.link_name(body, self._placed)
        scoped = f"{self._placed.scoped}::{name}"
        source.bodies[scoped] = file.name("BODY", body)
        if body:
            arrays = (model.body_ipos, model.body_iquat, model.body_inertia)
            centre, axes, moments = (tuple(array[body].tolist()) for array in arrays)
            source.masses[file.name("BODY", body)] = (float(model.body_mass[body]), centre, axes, moments)
        pose = self._place @ file.pose(body)
        collisions: list[SceneCollision] = []
        visuals: list[SceneVisual] = []
        for g in range(model.body_geomadr[body], model.body_geomadr[body] + model.body_geomnum[body]):
            self._geom(g, scoped, collisions, visuals)
        lights = read_lights(file, body, scoped, pose, source) if body else ()
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
            where=file.where("body", file.name("BODY", body)) if body else file.source.root.where,
        )

    def _inertial(self, body: int) -> Inertial:
        model = self._model
        turn = Pose((0.0, 0.0, 0.0), model.body_iquat[body]).matrix
        i = matmul(turn * model.body_inertia[body], turn.T)
        return Inertial(float(model.body_mass[body]), vec3(model.body_ipos[body]), moments_of(i))

    def _frames(self, body: int) -> Iterable[SceneFrame]:
        file, model, placed = self._file, self._model, self._placed
        for s in file.sites_of.get(body, ()):
            name = file.name("SITE", s).removeprefix(placed.strip)
            pose = self._place @ file.pose(body) @ Pose(model.site_pos[s], model.site_quat[s])
            yield SceneFrame(name, f"{placed.scoped}::{name}", pose, file.scoped_link(body, placed))

    # ------------------------------------------------------------------ geoms

    def _geom(self, g: int, link: str, collisions: list[SceneCollision], visuals: list[SceneVisual]) -> None:
        file, model = self._file, self._model
        name = file.name("GEOM", g)
        collides, drawn = g in file.colliding, int(model.geom_group[g]) < _SHOWN_GROUPS
        shape, pose = self._shape(g)
        where = file.where("geom", name)
        scoped = f"{link}::{name}"
        self._source.geoms[name] = MjcfGeom(link, scoped, collides, drawn)
        if collides:
            mu = float(model.geom_friction[g][0]) if model.geom_condim[g] > 1 else 0.0
            surface = Surface(mu, mu, torsional=float(model.geom_friction[g][1]), where=where)
            collisions.append(SceneCollision(name, scoped, pose, shape, surface, where=where))
        if drawn:
            visuals.append(SceneVisual(name, scoped, pose, shape, self._material(g), where=where))

    def _material(self, g: int) -> Material:
        model = self._model
        colour = model.geom_rgba[g]
        number = int(model.geom_matid[g])
        if number >= 0 and colour.tolist() == [0.5, 0.5, 0.5, 1.0]:
            colour = model.mat_rgba[number]
        r, gr, b, a = (float(c) for c in colour)
        return Material(ambient=(r, gr, b, a), diffuse=(r, gr, b, a))

    def _shape(self, g: int) -> tuple[Geometry, Pose]:
        """Return the shape of a geom and its pose in the link; for a mesh, the pose of the mesh file's own axes."""
        model = self._model
        pose = Pose(model.geom_pos[g], model.geom_quat[g])
        a, b, c = (float(s) for s in model.geom_size[g])
        kind, number = int(model.geom_type[g]), int(model.geom_dataid[g])
        if kind in (_MESH, _SDF):
            engine_pose = Pose(model.mesh_pos[number], model.mesh_quat[number])
            file, uri = self._asset("mesh", self._file.name("MESH", number))
            scale = vec3(model.mesh_scale[number])
            return shapes.Mesh(file, uri, scale, missing=not file.is_file()), pose @ engine_pose.inverse()
        if kind == _HFIELD:
            file, uri = self._asset("hfield", self._file.name("HFIELD", number))
            x, y, z, _ = (float(v) for v in model.hfield_size[number])
            return shapes.Heightmap(file, uri, (2 * x, 2 * y, z)), pose
        primitives: dict[int, Geometry] = {
            _PLANE: shapes.Plane(size=(2 * a or 100.0, 2 * b or 100.0)),
            _SPHERE: shapes.Sphere(a),
            _CAPSULE: shapes.Capsule(a, 2 * b),
            _CYLINDER: shapes.Cylinder(a, 2 * b),
            _ELLIPSOID: shapes.Ellipsoid((a, b, c)),
            _BOX: shapes.Box((2 * a, 2 * b, 2 * c)),
        }
        return primitives.get(kind, shapes.Empty()), pose

    def _asset(self, kind: str, name: str) -> tuple[Path, str]:
        """Return file and URI of an asset; for an asset without a file, the path of the MJCF file and `#NAME`."""
        source = self._file.source
        asset = getattr(self._file.spec, kind)(name)
        key = asset.file if asset is not None else ""
        if key in source.files:
            return source.files[key]
        return Path(source.file or ""), f"#{name}"
