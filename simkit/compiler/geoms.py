"""Collisions and visuals of a link as geoms of a body."""

from __future__ import annotations

from collections import Counter
from dataclasses import dataclass
from typing import Any

import mujoco
import numpy as np

from simkit.compiler.assets import Assets
from simkit.compiler.friction import Contact, contact_of
from simkit.compiler.groups import COLLISION, COLLISION_CONTACT, COLLISION_RAY, VISUAL
from simkit.compiler.mesh import MeshFileError, load_mesh, pixels_of
from simkit.compiler.mesh_part import Floats, Ints, MeshPart, joined
from simkit.compiler.names import GeomOwner, ModelRecord
from simkit.compiler.shapes import cone, heights, polyline, primitive_of, sizes_of
from simkit.compiler.static import (
    PRISMS_MOST,
    convex_pieces,
    hull_volume,
    hulls,
    is_convex,
    is_inside_out,
    prisms,
    thinned,
)
from simkit.diagnostics import Diagnostics, Where
from simkit.pose import Pose
from simkit.scene import Cone, Empty, Geometry, Heightmap, Material, Mesh, Plane, Polyline, SceneCollision, SceneVisual

_HALF_SPACE = (50.0, 50.0, 0.05)


@dataclass(slots=True)
class Place:
    """Where geoms of one link go.

    Attributes:
        body: MuJoCo body handle.
        offset: the link frame in the body's frame.
        fixed: nothing moves it but the user (world geoms and mocap bodies).
        mass: of the moving tree [kg]; 0 where fixed.
    """

    body: Any
    offset: Pose
    fixed: bool
    mass: float
    link: str


class GeomWriter:
    """Writes the geoms of one top-level model and notes whose they are."""

    def __init__(self, assets: Assets, record: ModelRecord, timestep: float, diagnostics: Diagnostics) -> None:
        self.assets, self.record, self.timestep, self.diagnostics = assets, record, timestep, diagnostics
        self._count: Counter[str] = Counter()

    def _add(self, place: Place, owner: GeomOwner, pose: Pose, **settings: Any) -> Any:
        base = owner.scoped + ("#v" if owner.is_visual else "#")
        name = f"{base}{self._count[base]}"
        self._count[base] += 1
        self.record.geoms[name] = owner
        local = place.offset @ pose
        return place.body.add_geom(name=name, pos=local.position, quat=local.quaternion, mass=0.0, **settings)

    # ------------------------------------------------------------------ collisions

    def collision(self, place: Place, collision: SceneCollision) -> None:
        """Adds what collides for one `<collision>`."""
        shape = collision.geometry
        if isinstance(shape, Empty) or not self._has_size(shape, collision.where):
            return
        contact = contact_of(collision.surface, self.timestep, place.mass, self.diagnostics)
        owner = GeomOwner(place.link, collision.scoped, False)
        primitive = primitive_of(shape, False)
        if isinstance(shape, Plane) and not place.fixed and primitive is not None:
            self.diagnostics.warning(
                "SK-PHYS-016", "a plane on a moving link collides as a 100 m × 100 m plate", collision.where
            )
            sunk = collision.pose_link @ primitive.pose @ Pose((0.0, 0.0, -_HALF_SPACE[2]))
            self._add(
                place, owner, sunk, type=mujoco.mjtGeom.mjGEOM_BOX, size=_HALF_SPACE, **_colliding(contact, COLLISION)
            )
        elif primitive is not None:
            pose = collision.pose_link @ primitive.pose
            self._add(place, owner, pose, type=primitive.type, size=primitive.size, **_colliding(contact, COLLISION))
        elif isinstance(shape, Heightmap):
            self._heightmap(place, owner, collision.pose_link, shape, collision.where, _colliding(contact, COLLISION))
        else:
            parts = self._parts(shape, collision.where)
            if parts:
                self._mesh_collision(place, owner, collision, parts, contact)

    def _mesh_collision(
        self, place: Place, owner: GeomOwner, collision: SceneCollision, parts: list[MeshPart], contact: Contact
    ) -> None:
        vertices, faces = joined(parts)
        pose, where = collision.pose_link, collision.where
        if not len(faces):
            self.diagnostics.error(
                "SK-MESH-003", f"{_title(collision.geometry)}: all triangles are without area", where
            )
        elif hull_volume(vertices) <= 1e-9 * float(np.ptp(vertices, axis=0).max()) ** 3:
            self._flat_collision(place, owner, collision, vertices, faces, contact)
        elif is_convex(vertices, faces) and not (place.fixed and is_inside_out(vertices, faces)):
            self._hull(place, owner, pose, vertices, contact, COLLISION)
        elif place.fixed:
            self._static_collision(place, owner, collision, vertices, faces, contact)
        else:
            self._moving_collision(place, owner, collision, vertices, faces, contact)

    def _moving_collision(
        self, place: Place, owner: GeomOwner, collision: SceneCollision, vertices: Floats, faces: Ints, contact: Contact
    ) -> None:
        sets = [points for points in hulls(vertices, faces) if hull_volume(points) > 0.0] or [vertices]
        import trimesh

        whole = sum(hull_volume(points) for points in sets)
        mesh = trimesh.Trimesh(vertices, faces, process=False)
        own = abs(float(mesh.volume)) if mesh.is_watertight else 0.0
        if not own or whole > 1.05 * own:
            found = f"{whole / own:.2f} times its volume" if own else "the mesh is not closed"
            self.diagnostics.note(
                "SK-MESH-004",
                f"{_title(collision.geometry)} collides as the convex hull of each of its {len(sets)} pieces ({found})",
                collision.where,
            )
        for points in sets:
            self._hull(place, owner, collision.pose_link, points, contact, COLLISION)

    def _static_collision(
        self, place: Place, owner: GeomOwner, collision: SceneCollision, vertices: Floats, faces: Ints, contact: Contact
    ) -> None:
        if len(faces) > PRISMS_MOST:
            coarse_vertices, coarse_faces = thinned(vertices, faces, PRISMS_MOST)
            self.diagnostics.warning(
                "SK-MESH-005",
                f"{_title(collision.geometry)}: for contacts {len(faces)} triangles become {len(coarse_faces)}",
                collision.where,
            )
            pieces = convex_pieces(coarse_vertices, coarse_faces)
        else:
            pieces = convex_pieces(vertices, faces)
        for piece in pieces:
            self._hull(place, owner, collision.pose_link, piece.points, contact, COLLISION_CONTACT)
        self._ray_copy(place, owner, collision.pose_link, vertices, faces)
        thin = sum(not p.exact for p in pieces)
        self.diagnostics.note(
            "SK-MESH-006",
            f"{_title(collision.geometry)} is not convex: it collides as {len(pieces) - thin} convex pieces "
            f"and {thin} prisms on its surface",
            collision.where,
        )

    def _flat_collision(
        self, place: Place, owner: GeomOwner, collision: SceneCollision, vertices: Floats, faces: Ints, contact: Contact
    ) -> None:
        self.diagnostics.note(
            "SK-MESH-007", f"{_title(collision.geometry)} is flat: it collides as a thin plate", collision.where
        )
        for points in prisms(vertices, faces):
            self._hull(place, owner, collision.pose_link, points, contact, COLLISION_CONTACT)
        self._ray_copy(place, owner, collision.pose_link, vertices, faces)

    def _hull(self, place: Place, owner: GeomOwner, pose: Pose, points: Floats, contact: Contact, group: int) -> None:
        from scipy.spatial import QhullError

        try:
            name = self.assets.hull(points)
        except QhullError:
            return  # a sliver without volume touches nothing
        self._add(place, owner, pose, type=mujoco.mjtGeom.mjGEOM_MESH, meshname=name, **_colliding(contact, group))

    def _ray_copy(self, place: Place, owner: GeomOwner, pose: Pose, vertices: Floats, faces: Ints) -> None:
        name = self.assets.surface(vertices, faces)
        self._add(
            place,
            owner,
            pose,
            type=mujoco.mjtGeom.mjGEOM_MESH,
            meshname=name,
            contype=0,
            conaffinity=0,
            group=COLLISION_RAY,
        )

    # ------------------------------------------------------------------ visuals

    def visual(self, place: Place, visual: SceneVisual) -> None:
        """Adds what is drawn for one `<visual>`."""
        shape = visual.geometry
        if isinstance(shape, Empty) or not self._has_size(shape, visual.where):
            return
        owner = GeomOwner(place.link, visual.scoped, True)
        primitive = primitive_of(shape, True)
        if primitive is not None:
            if isinstance(shape, Plane) and not place.fixed:
                size = (primitive.size[0], primitive.size[1], 1e-4)
                look = self._look(visual, None, on_mesh=False)
                self._add(
                    place, owner, visual.pose_link @ primitive.pose, type=mujoco.mjtGeom.mjGEOM_BOX, size=size, **look
                )
                return
            look = self._look(visual, None, on_mesh=isinstance(shape, Plane))
            self._add(place, owner, visual.pose_link @ primitive.pose, type=primitive.type, size=primitive.size, **look)
        elif isinstance(shape, Heightmap):
            self._heightmap(place, owner, visual.pose_link, shape, visual.where, self._look(visual, None, on_mesh=True))
        else:
            for part in self._parts(shape, visual.where):
                look = self._look(visual, part, on_mesh=True)
                textured = part.uv if "material" in look and part.uv is not None else None
                name = self.assets.surface(part.vertices, part.faces, textured)
                self._add(place, owner, visual.pose_link, type=mujoco.mjtGeom.mjGEOM_MESH, meshname=name, **look)

    def _look(self, visual: SceneVisual, part: MeshPart | None, on_mesh: bool) -> dict[str, Any]:
        """Colour, material and mask settings of a drawn geom; the file's material wins over the mesh's own."""
        material = visual.material
        pixels = None
        if material is not None:
            colour = material.diffuse
            if material.texture is not None and (part is None or part.uv is not None):
                pixels = self._pixels(material, visual.where)
        else:
            colour = part.colour if part is not None and part.colour is not None else (0.7, 0.7, 0.7, 1.0)
            pixels = part.texture if part is not None else None
        emission = float(np.dot(material.emissive[:3], (0.2126, 0.7152, 0.0722))) if material is not None else 0.0
        specular = float(max(material.specular[:3])) if material is not None else 0.0
        texture = self.assets.texture(pixels, on_mesh) if pixels is not None else ""
        r, g, b, a = colour
        rgba = [r, g, b, a * (1.0 - min(1.0, max(0.0, visual.transparency)))]
        if rgba == [0.5, 0.5, 0.5, 1.0]:
            rgba[0] = 0.5001  # exactly MuJoCo's default would be taken for "not given"
        return {
            "rgba": rgba,
            "material": self.assets.material(min(1.0, emission), min(1.0, specular), texture),
            "contype": 0,
            "conaffinity": 0,
            "group": VISUAL,
            "castshadow": visual.cast_shadows,
        }

    def _pixels(self, material: Material, where: Where) -> Any:
        from PIL import Image

        try:
            with Image.open(str(material.texture)) as image:
                return pixels_of(image)
        except (OSError, ValueError, Image.DecompressionBombError) as problem:
            self.diagnostics.warning("SK-MESH-008", f"texture {material.texture} cannot be read: {problem}", where)
            return None

    # ------------------------------------------------------------------ shared

    def _has_size(self, shape: Geometry, where: Where) -> bool:
        if all(np.isfinite(s) and s > 0.0 for s in sizes_of(shape)):
            return True
        self.diagnostics.warning(
            "SK-PHYS-017", f"a {type(shape).__name__.lower()} without size is left out: {shape}", where
        )
        return False

    def _parts(self, shape: Geometry, where: Where) -> list[MeshPart]:
        if isinstance(shape, Mesh):
            return load_mesh(shape, self.diagnostics, where)
        if isinstance(shape, Cone):
            return [MeshPart("cone", *cone(shape))]
        if isinstance(shape, Polyline):
            try:
                return [MeshPart("polyline", *polyline(shape))]
            except (ValueError, MeshFileError) as problem:
                self.diagnostics.error("SK-MESH-009", f"polyline: {problem}", where)
        return []

    def _heightmap(
        self, place: Place, owner: GeomOwner, pose: Pose, shape: Heightmap, where: Where, settings: dict[str, Any]
    ) -> None:
        if not place.fixed:
            self.diagnostics.error("SK-MESH-010", "a heightmap can only belong to a static model", where)
            return
        try:
            rows = heights(shape)
        except (OSError, ValueError) as problem:
            self.diagnostics.error("SK-MESH-011", f"heightmap {shape.uri}: {problem}", where)
            return
        low, high = float(rows.min()), float(rows.max())
        name = self.assets.heights(
            (rows - low) / max(high - low, 1e-12), (*shape.size[:2], (high - low) * shape.size[2])
        )
        x, y, z = shape.position
        place_at = pose @ Pose((x, y, z + low * shape.size[2]))
        self._add(place, owner, place_at, type=mujoco.mjtGeom.mjGEOM_HFIELD, hfieldname=name, **settings)


def _colliding(contact: Contact, group: int) -> dict[str, Any]:
    return {
        "group": group,
        "contype": contact.contype,
        "conaffinity": contact.conaffinity,
        "condim": contact.condim,
        "priority": contact.priority,
        "friction": contact.friction,
        "solref": contact.solref,
        "solimp": contact.solimp,
    }


def _title(shape: Geometry) -> str:
    return shape.uri if isinstance(shape, Mesh) else type(shape).__name__.lower()
