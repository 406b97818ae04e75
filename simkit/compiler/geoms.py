"""Collisions and visuals of a link as geoms of a body."""

from __future__ import annotations

import math
from collections import Counter
from collections.abc import Iterable
from dataclasses import dataclass, replace
from typing import TYPE_CHECKING, Any, Final

import mujoco
import numpy as np

from simkit.compiler import shape_geometry
from simkit.compiler.assets import Assets, geom_colours
from simkit.compiler.contact_friction import contact_properties
from simkit.compiler.geom_groups import COLLISION, COLLISION_CONTACT, COLLISION_RAY, DRAWN_COLLISION, VISUAL
from simkit.compiler.name_map import GeomOwner, ModelRecord
from simkit.compiler.wheel_cylinders import RoundMesh, TurningAxis, round_mesh
from simkit.diagnostics import Diagnostics, Where
from simkit.linear_algebra import matmul
from simkit.loaders.meshes.companion_files import Pixels
from simkit.loaders.meshes.mesh_part import Colour, Floats, MeshFileError, MeshPart, has_area, join_parts, report_once
from simkit.pose import Pose
from simkit.scene import (
    Cone,
    Empty,
    Geometry,
    Heightmap,
    Material,
    Mesh,
    Plane,
    Polyline,
    SceneCollision,
    SceneVisual,
    Surface,
)

if TYPE_CHECKING:
    from simkit.compiler.meshes.convex_decomposition import ConvexBodies


DIRECT: Final = 500
"""Number of geoms that are added to the world body itself."""

BLOCK: Final = 6000
"""Number of geoms in one attached specification; the time of an attachment grows with the square of this number."""


class WorldGeoms:
    """Writer of the geoms of the world body, in the order of their addition.

    A large world has tens of thousands of them. At each `add_geom`, MuJoCo lists all elements of the specification
    again: 80,000 geoms would take 15 s. Therefore all but the first geoms are added to a small specification, which is
    attached when it is full. The numbers of the compiled model are the same.

    Args:
        spec: specification of the world; before others use it, attach the geoms that wait.
        count: number of geoms that were added before.
        blocks: names of the geoms in each attached frame, by the name of the frame.
    """

    def __init__(self, spec: mujoco.MjSpec, count: int = 0, blocks: dict[str, frozenset[str]] | None = None) -> None:
        self.spec, self._count = spec, count
        self._blocks = dict(blocks or {})
        self._waiting: mujoco.MjSpec | None = None
        self._names: list[str] = []

    def add(self, name: str, **settings: Any) -> None:
        """Add a geom; it is in the specification at the latest after `attach_waiting`."""
        self._count += 1
        if self._count <= DIRECT:
            self.spec.worldbody.add_geom(name=name, **settings)
            return
        if self._waiting is None:
            self._waiting = mujoco.MjSpec()
        self._waiting.worldbody.add_geom(name=name, **settings)
        self._names.append(name)
        if len(self._names) >= BLOCK:
            self.attach_waiting()

    def attach_waiting(self) -> None:
        """Attach the geoms that wait."""
        if self._waiting is None:
            return
        waiting, self._waiting = self._waiting, None
        names, self._names = self._names, []
        block = f"{names[0]}#block"
        self.spec.attach(waiting, prefix="", frame=self.spec.worldbody.add_frame(name=block))
        self._blocks[block] = frozenset(names)

    def remove(self, names: Iterable[str]) -> None:
        """Remove geoms; a whole block of them is removed as one frame, which is as fast as one geom."""
        rest = set(names)
        for block, inside in list(self._blocks.items()):
            if inside <= rest:
                rest -= inside
                self.spec.delete(self.spec.frame(block))
                del self._blocks[block]
        for name in sorted(rest):
            self.spec.delete(self.spec.geom(name))

    def copy_to(self, spec: mujoco.MjSpec) -> WorldGeoms:
        """Return the writer of a copy of the specification, in which no geoms wait."""
        return WorldGeoms(spec, self._count, self._blocks)


_HALF_SPACE = (50.0, 50.0, 0.05)
_OVER = Pose((0.0, 0.0, 0.0), (0.0, 1.0, 0.0, 0.0))  # rotated by 180° about x
_HEIGHTS_HINT = "save the heights as an 8- or 16-bit grey PNG"
LEAST_AREA: Final = 1e-12
"""Least total area [m²] of triangles that are drawn."""


@dataclass(slots=True)
class GeomParent:
    """Body and frame that receive the geoms of one link.

    Attributes:
        body: MuJoCo body handle.
        offset: link frame in the body's frame.
        fixed: True if only the user moves the body (world geoms and mocap bodies).
        mass: mass of the moving tree [kg]; 0 if fixed.
        axis: axis about which the link turns without limits; None if there is no such axis.
        is_world: True if the body is the world body.
    """

    body: mujoco.MjsBody
    offset: Pose
    fixed: bool
    mass: float
    link: str
    axis: TurningAxis | None = None
    is_world: bool = False


GeomSettings = dict[str, Any]
"""Keyword arguments of `add_geom`."""


class GeomWriter:
    """Writer of the geoms of one top-level model. The record receives each geom's name with its owner.

    Args:
        world: writer of the geoms of the world body.
        assets: assets of the spec.
        record: record of the model.
        timestep: length of a step [s].
        diagnostics: collection for problems.
        ambient: ambient light of the scene.
        has_rolling: true if the world's engine in Gazebo has rolling friction.
    """

    def __init__(
        self,
        world: WorldGeoms,
        assets: Assets,
        record: ModelRecord,
        timestep: float,
        diagnostics: Diagnostics,
        ambient: Colour,
        has_rolling: bool = False,
    ) -> None:
        self.assets, self.record, self.timestep, self.diagnostics = assets, record, timestep, diagnostics
        self._world, self._ambient, self._has_rolling = world, ambient, has_rolling
        self._count: Counter[str] = Counter()

    def _add(self, parent: GeomParent, owner: GeomOwner, pose: Pose, **settings: Any) -> None:
        local = parent.offset @ pose
        self._add_at(parent, owner, local.position, local.quaternion, **settings)

    def _add_at(
        self, parent: GeomParent, owner: GeomOwner, position: Floats, quaternion: Floats, **settings: Any
    ) -> None:
        base = owner.scoped + ("#v" if owner.is_visual else "#")
        name = f"{base}{self._count[base]}"
        self._count[base] += 1
        self.record.geoms[name] = owner
        add = self._world.add if parent.is_world else parent.body.add_geom
        add(name=name, pos=position, quat=quaternion, mass=0.0, **settings)

    # ------------------------------------------------------------------ collisions

    def _without_rolling(self, surface: Surface) -> Surface:
        """Return a surface without Bullet's rolling friction, which Gazebo's other engines ignore."""
        if not surface.rolling or self._has_rolling:
            return surface
        message = "<rolling_friction> is ignored, as in Gazebo: the engine of the world is not Bullet"
        self.diagnostics.note("SK-PHYS-007", message, surface.where, '<physics type="bullet"> uses it')
        return replace(surface, rolling=None)

    def collision(self, parent: GeomParent, collision: SceneCollision) -> None:
        """Add the geoms of one `<collision>`."""
        shape = collision.geometry
        if isinstance(shape, Empty) or not self._has_size(shape, collision.where):
            return
        surface = self._without_rolling(collision.surface)
        contact = contact_properties(surface, self.timestep, parent.mass, self.diagnostics)
        solid: GeomSettings = {"group": COLLISION, **contact._asdict()}
        owner = GeomOwner(parent.link, collision.scoped, False)
        primitive = shape_geometry.primitive_of(shape, False)
        if isinstance(shape, Plane) and not parent.fixed and primitive is not None:
            message = "a plane on a moving link collides as a 100 m × 100 m plate"
            self.diagnostics.warning("SK-PHYS-016", message, collision.where)
            sunk = collision.pose_link @ primitive.pose @ Pose((0.0, 0.0, -_HALF_SPACE[2]))
            self._add(parent, owner, sunk, type=mujoco.mjtGeom.mjGEOM_BOX, size=_HALF_SPACE, **solid)
        elif primitive is not None:
            pose = collision.pose_link @ primitive.pose
            self._add(parent, owner, pose, type=primitive.type, size=primitive.size, **solid)
        elif isinstance(shape, Heightmap):
            self._heightmap(parent, owner, collision.pose_link, shape, collision.where, solid)
        elif isinstance(shape, Polyline):
            self._outlines(parent, owner, collision, shape, solid)
        else:
            parts = self._visual_parts(shape, collision.where)
            if parts:
                self._mesh_collision(parent, owner, collision, parts, solid)

    def _outlines(
        self, parent: GeomParent, owner: GeomOwner, collision: SceneCollision, shape: Polyline, solid: GeomSettings
    ) -> None:
        """Add the exact convex pieces of extruded outlines."""
        from simkit.compiler.meshes.convex_decomposition import convex_hull

        try:
            pieces = shape_geometry.polyline_pieces(shape)
        except ValueError as problem:
            self.diagnostics.error("SK-MESH-009", f"polyline: {problem}", collision.where)
            return
        for points in pieces:
            body = convex_hull(points)
            if body is not None:
                name = self.assets.surface(*body)
                self._add(parent, owner, collision.pose_link, type=mujoco.mjtGeom.mjGEOM_MESH, meshname=name, **solid)

    def _mesh_collision(
        self,
        parent: GeomParent,
        owner: GeomOwner,
        collision: SceneCollision,
        parts: list[MeshPart],
        solid: GeomSettings,
    ) -> None:
        # 10 ms, which a world without meshes need not take
        from simkit.compiler.meshes.convex_decomposition import convex_bodies
        from simkit.compiler.meshes.surface_patches import TRIANGLES_FROM

        shape = collision.geometry
        vertices, faces = join_parts(parts)
        optimization, most = (shape.optimization, shape.max_hulls) if isinstance(shape, Mesh) else ("", 16)
        bodies = convex_bodies(vertices, faces, fixed=parent.fixed, optimization=optimization, most=most)
        wheel = None
        if isinstance(shape, Mesh) and parent.axis is not None:
            wheel = round_mesh(bodies.shapes, collision.pose_link, parent.axis)
        is_exact = bodies.is_exact and wheel is None
        settings = solid if is_exact else {**solid, "group": COLLISION_CONTACT}
        if wheel is not None:
            self._wheel(parent, owner, collision, wheel, settings)
        else:
            for severity, code, text, hint in bodies.findings:
                title = _collision_title(shape)
                report_once(self.diagnostics, severity, code, f"{title} {text}", collision.where, hint)
            self._convex_bodies(parent, owner, collision.pose_link, bodies, settings)
        if not is_exact:
            drawn: GeomSettings = {"contype": 0, "conaffinity": 0, "group": COLLISION_RAY}
            is_shared = len(parts) == 1 and len(faces) > TRIANGLES_FROM  # with the visual of the same file
            name = self.assets.part(parts[0], False) if is_shared else self.assets.surface(vertices, faces)
            self._add(parent, owner, collision.pose_link, type=mujoco.mjtGeom.mjGEOM_MESH, meshname=name, **drawn)

    def _convex_bodies(
        self, parent: GeomParent, owner: GeomOwner, pose: Pose, bodies: ConvexBodies, settings: GeomSettings
    ) -> None:
        names = self.assets.convex_bodies(bodies)
        for name in names:
            self._add(parent, owner, pose, type=mujoco.mjtGeom.mjGEOM_MESH, meshname=name, **settings)
        self._large_surface(parent, owner, pose, bodies, names, settings)

    def _large_surface(
        self,
        parent: GeomParent,
        owner: GeomOwner,
        pose: Pose,
        bodies: ConvexBodies,
        names: list[str],
        settings: GeomSettings,
    ) -> None:
        """Add copies, boxes and height fields; a `Pose` for each would take as long as everything else."""
        mesh, box, field = mujoco.mjtGeom.mjGEOM_MESH, mujoco.mjtGeom.mjGEOM_BOX, mujoco.mjtGeom.mjGEOM_HFIELD
        geoms: list[tuple[Floats, Floats, GeomSettings]] = [
            (at, np.eye(3), {"type": mesh, "meshname": names[number]}) for number, at in bodies.copies
        ]
        geoms += [(b.centre, b.axes, {"type": box, "size": b.half}) for b in bodies.boxes]
        for tile, name in zip(bodies.tiles, self.assets.tiles(bodies), strict=True):
            middle = 0.5 * tile.cell * (tile.heights.shape[1] - 1, tile.heights.shape[0] - 1)
            at = tile.origin + matmul(tile.axes[:, :2], middle)
            geoms.append((at, tile.axes, {"type": field, "hfieldname": name}))
        frame, rotation = parent.offset @ pose, np.zeros(9)
        mujoco.mju_quat2Mat(rotation, frame.quaternion)
        turn = rotation.reshape(3, 3)
        for at, axes, piece in geoms:
            quaternion = np.zeros(4)
            mujoco.mju_mat2Quat(quaternion, matmul(turn, axes).reshape(9))
            self._add_at(parent, owner, frame.position + matmul(turn, at), quaternion, **piece, **settings)

    def _wheel(
        self, parent: GeomParent, owner: GeomOwner, collision: SceneCollision, wheel: RoundMesh, solid: GeomSettings
    ) -> None:
        size = (wheel.radius, wheel.length / 2, 0.0)
        cylinder = f"a cylinder of radius {wheel.radius:.4g} m and length {wheel.length:.4g} m"
        text = f"{_collision_title(collision.geometry)} is round about its joint axis: it collides as {cylinder}"
        report_once(self.diagnostics, "note", "SK-MESH-016", text, collision.where)
        kind = mujoco.mjtGeom.mjGEOM_CYLINDER
        self._add(parent, owner, collision.pose_link @ wheel.pose, type=kind, size=size, **solid)

    # ------------------------------------------------------------------ visuals

    def visual(self, parent: GeomParent, visual: SceneVisual) -> None:
        """Add the geoms of one `<visual>`."""
        shape = visual.geometry
        if isinstance(shape, Empty) or not self._has_size(shape, visual.where):
            return
        owner = GeomOwner(parent.link, visual.scoped, True)
        pixels = self._pixels(visual.material, visual.where)
        # the engine does not draw its own shapes, except planes, from the inside
        has_inner_side = visual.material is not None and visual.material.double_sided and not isinstance(shape, Plane)
        textured = shape_geometry.textured_triangles(shape) if pixels is not None or has_inner_side else None
        primitive = shape_geometry.primitive_of(shape, True) if textured is None else None
        pose = visual.pose_link
        if isinstance(shape, Heightmap):
            self._heightmap(parent, owner, pose, shape, visual.where, self._visual_settings(visual, None, pixels))
        elif primitive is None:
            for part in self._visual_parts(shape, visual.where) if textured is None else [textured]:
                self._add_visual_part(parent, owner, visual, part, pixels)
        else:
            size, kind = primitive.size, primitive.type
            if isinstance(shape, Plane) and not parent.fixed:
                size, kind = (size[0], size[1], 1e-4), mujoco.mjtGeom.mjGEOM_BOX
                pixels = None
            drawn = self._visual_settings(visual, None, pixels)
            self._add(parent, owner, pose @ primitive.pose, type=kind, size=size, **drawn)
            if kind == mujoco.mjtGeom.mjGEOM_PLANE and visual.material is not None and visual.material.double_sided:
                self._add(parent, owner, pose @ primitive.pose @ _OVER, type=kind, size=size, **drawn)

    def add_material(self, visual: SceneVisual, material: Material) -> str:
        """Add the material that a visual has if its description changes, and return its name in the engine.

        Args:
            visual: visual whose own material has a texture, or none.
            material: other description.
        """
        visual = replace(visual, material=material)
        pixels = self._pixels(material, visual.where)
        part = shape_geometry.textured_triangles(visual.geometry) if pixels is not None else None
        return str(self._visual_settings(visual, part, pixels)["material"])

    def _add_visual_part(
        self, parent: GeomParent, owner: GeomOwner, visual: SceneVisual, part: MeshPart, pixels: Pixels | None
    ) -> None:
        """Add the triangles of one material; the material of the `<visual>` has priority over that of the mesh file."""
        if not has_area(part, LEAST_AREA):
            name = f" ({part.name})" if part.name else ""
            text = f"{_collision_title(visual.geometry)}: a part{name} whose triangles have no area is not drawn"
            report_once(self.diagnostics, "note", "SK-MESH-013", text, visual.where)
            return
        look = self._visual_settings(visual, part, pixels if part.uv is not None else None)
        if pixels is not None and part.uv is None:
            look["rgba"] = _tinted(look["rgba"], pixels)
        mesh = self._surface_mesh(visual, part, self.assets.has_texture(look["material"]))
        self._add(parent, owner, visual.pose_link, type=mujoco.mjtGeom.mjGEOM_MESH, meshname=mesh, **look)

    def _surface_mesh(self, visual: SceneVisual, part: MeshPart, is_textured: bool) -> str:
        """Add the mesh of a part and return its name.

        The mesh has the texture scale of the visual's material, and an inner side if the material is double-sided.
        """
        if visual.material is None or not (is_textured or visual.material.double_sided):
            return self.assets.part(part, is_textured)
        vertices, faces, uv = part.vertices, part.faces, part.uv if is_textured else None
        if uv is not None:
            uv = 0.5 + (uv - 0.5) / visual.material.texture_scale
        if visual.material.double_sided:
            faces = np.vstack([faces, faces[:, ::-1] + len(vertices)])
            vertices, uv = np.vstack([vertices, vertices]), None if uv is None else np.vstack([uv, uv])
        return self.assets.surface(vertices, faces, uv)

    def _visual_settings(self, visual: SceneVisual, part: MeshPart | None, pixels: Pixels | None) -> GeomSettings:
        """Return the settings of a drawn geom; `pixels` is the texture of the `<visual>`, or None."""
        look = geom_colours(visual, part)
        digest = ""
        if visual.material is None and part is not None:
            pixels, digest = part.texture, part.texture_digest
        texture = self.assets.texture(pixels, digest) if pixels is not None else ""
        scale = visual.material.texture_scale if visual.material is not None and part is None else (1.0, 1.0)
        repeat = (1.0 / abs(scale[0]), 1.0 / abs(scale[1]))
        emission = look.emission_under(self._ambient)
        return {
            "rgba": look.rgba,
            "material": self.assets.material(emission, look, texture, repeat),
            "contype": 0,
            "conaffinity": 0,
            # a scripted model never collides; lidars that see collisions see its visuals instead
            "group": VISUAL if self.record.scene.moved_by is None else DRAWN_COLLISION,
            "castshadow": visual.cast_shadows,
        }

    def _pixels(self, material: Material | None, where: Where) -> Pixels | None:
        """Return the texture that the file names for a visual; None if there is none or if the image cannot be read."""
        if material is None or material.texture is None:
            return None
        try:
            return self.assets.picture(material.texture)
        except MeshFileError as problem:
            report_once(self.diagnostics, "warning", "SK-MESH-008", f"texture {material.texture} {problem}", where)
            return None

    # ------------------------------------------------------------------ collisions and visuals

    def _has_size(self, shape: Geometry, where: Where) -> bool:
        if all(0.0 < s < math.inf for s in shape_geometry.shape_sizes(shape)):
            return True
        message = f"a {type(shape).__name__.lower()} without size is ignored: {shape}"
        self.diagnostics.warning("SK-PHYS-017", message, where)
        return False

    def _visual_parts(self, shape: Geometry, where: Where) -> list[MeshPart]:
        if isinstance(shape, Mesh):
            from simkit.loaders.meshes.mesh_reader import load_mesh  # 4 ms: the formats

            return [] if shape.missing else load_mesh(shape, self.diagnostics, where)
        if isinstance(shape, Cone):
            return [MeshPart("cone", *shape_geometry.cone_triangles(shape))]
        if isinstance(shape, Polyline):
            try:
                return [MeshPart("polyline", *shape_geometry.polyline_triangles(shape))]
            except (ValueError, MeshFileError) as problem:
                self.diagnostics.error("SK-MESH-009", f"polyline: {problem}", where)
        return []

    def _heightmap(
        self, parent: GeomParent, owner: GeomOwner, pose: Pose, shape: Heightmap, where: Where, settings: GeomSettings
    ) -> None:
        if not parent.fixed:
            self.diagnostics.error("SK-MESH-010", "a heightmap can only belong to a static model", where)
            return
        try:
            rows = shape_geometry.heightmap_rows(shape)
        except MeshFileError as problem:
            report_once(
                self.diagnostics, "error", "SK-MESH-011", f"heightmap {shape.uri} {problem}", where, _HEIGHTS_HINT
            )
            return
        low, high = float(rows.min()), float(rows.max())
        z_size = shape.size[2]
        name = self.assets.heights((rows - low) / max(high - low, 1e-12), (*shape.size[:2], (high - low) * z_size))
        x, y, z = shape.position
        at = pose @ Pose((x, y, z + low * z_size))
        self._add(parent, owner, at, type=mujoco.mjtGeom.mjGEOM_HFIELD, hfieldname=name, **settings)


def _tinted(colour: Colour, pixels: Pixels) -> Colour:
    """Return a colour times the mean of a texture, for a mesh that has no texture coordinates (an STL file)."""
    r, g, b = np.broadcast_to(pixels.mean(axis=(0, 1))[:3] / 255.0, 3)
    return (float(colour[0] * r), float(colour[1] * g), float(colour[2] * b), colour[3])


def _collision_title(shape: Geometry) -> str:
    return shape.uri if isinstance(shape, Mesh) else type(shape).__name__.lower()
