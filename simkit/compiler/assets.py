"""Meshes, textures and materials of a spec, named by their content so that equal ones are one."""

from __future__ import annotations

import hashlib
from typing import Any

import mujoco
import numpy as np

from simkit.compiler.mesh_part import Floats, Ints

AssetKey = tuple[str, str]
"""(kind, MuJoCo's name)."""


class Assets:
    """Adds assets once. `used` collects what the model under construction refers to."""

    def __init__(self, spec: mujoco.MjSpec, known: set[AssetKey] | None = None) -> None:
        self.spec = spec
        self.known: set[AssetKey] = set(known or ())
        self.used: set[AssetKey] = set()

    def _is_new(self, kind: str, name: str) -> bool:
        key = (kind, name)
        self.used.add(key)
        if key in self.known:
            return False
        self.known.add(key)
        return True

    def surface(self, vertices: Floats, faces: Ints, uv: Floats | None = None, collides: bool = False) -> str:
        """A triangle mesh; one that does not collide may be flat or open."""
        name = "mesh#" + _digest(vertices, faces, uv, collides)
        if self._is_new("mesh", name):
            if len(vertices) < 4:  # MuJoCo wants four; the last is in no face
                vertices = np.vstack([vertices, vertices[:1], vertices[:1]])
                uv = None if uv is None else np.vstack([uv, uv[:1], uv[:1]])
            mesh = self.spec.add_mesh(name=name)
            mesh.inertia = (
                mujoco.mjtMeshInertia.mjMESH_INERTIA_CONVEX if collides else mujoco.mjtMeshInertia.mjMESH_INERTIA_SHELL
            )
            mesh.uservert = np.ascontiguousarray(vertices, np.float64).reshape(-1)
            mesh.userface = np.ascontiguousarray(faces, np.int32).reshape(-1)
            if uv is not None:
                mesh.usertexcoord = np.column_stack([uv[:, 0], 1.0 - uv[:, 1]]).reshape(-1)
                mesh.userfacetexcoord = np.ascontiguousarray(faces, np.int32).reshape(-1)
        return name

    def hull(self, points: Floats) -> str:
        """The convex hull of points. Raises QhullError where they are all in one plane."""
        from scipy.spatial import ConvexHull

        if _is_stout_prism(points):
            return self._corners(points)
        hull = ConvexHull(points)
        used, inverse = np.unique(hull.simplices, return_inverse=True)
        vertices = np.asarray(points, float)[used]
        faces = np.asarray(inverse).reshape(-1, 3)
        middle = vertices.mean(axis=0)
        corners = vertices[faces]
        normals = np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0])
        inwards = np.einsum("ij,ij->i", normals, corners[:, 0] - middle) < 0.0
        faces[inwards] = faces[inwards][:, ::-1]
        return self.surface(vertices, faces.astype(np.int32), collides=True)

    def _corners(self, points: Floats) -> str:
        """A convex mesh that MuJoCo itself finds the faces of."""
        name = "mesh#" + _digest(points)
        if self._is_new("mesh", name):
            mesh = self.spec.add_mesh(name=name)
            mesh.inertia = mujoco.mjtMeshInertia.mjMESH_INERTIA_CONVEX
            mesh.uservert = np.ascontiguousarray(points, np.float64).reshape(-1)
        return name

    def texture(self, pixels: Any, on_mesh: bool) -> str:
        """An image. Meshes and planes map it by coordinates, other shapes wear it on every side."""
        if not on_mesh:
            side = int(min(max(pixels.shape[:2]), 1024))
            from PIL import Image

            pixels = np.asarray(Image.fromarray(pixels).resize((side, side)), np.uint8)
        name = "texture#" + _digest(pixels, on_mesh)
        if self._is_new("texture", name):
            texture = self.spec.add_texture(name=name)
            texture.type = mujoco.mjtTexture.mjTEXTURE_2D if on_mesh else mujoco.mjtTexture.mjTEXTURE_CUBE
            texture.height, texture.width, texture.nchannel = (
                pixels.shape[0] * (1 if on_mesh else 6),
                pixels.shape[1],
                3,
            )
            texture.data = (
                np.ascontiguousarray(pixels) if on_mesh else np.ascontiguousarray(np.tile(pixels, (6, 1, 1)))
            ).tobytes()
        return name

    def material(self, emission: float, specular: float, texture: str = "") -> str:
        """How a geom reflects; its colour stays with the geom."""
        name = "material#" + _digest(round(emission, 4), round(specular, 4), texture)
        if texture:
            self.used.add(("texture", texture))
        if self._is_new("material", name):
            material = self.spec.add_material(name=name)
            material.emission, material.specular, material.shininess = emission, specular, 0.3
            material.rgba = (1.0, 1.0, 1.0, 1.0)
            if texture:
                material.textures[int(mujoco.mjtTextureRole.mjTEXROLE_RGB)] = texture
        return name

    def heights(self, rows: Any, size: tuple[float, float, float]) -> str:
        """A height field over `size` (x, y, highest); rows from -y to +y, values from 0 to 1."""
        name = "heights#" + _digest(rows, size)
        if self._is_new("hfield", name):
            field = self.spec.add_hfield(name=name)
            field.nrow, field.ncol = rows.shape
            field.size = (size[0] / 2, size[1] / 2, max(size[2], 1e-6), max(0.1, 0.05 * size[2]))
            field.userdata = np.ascontiguousarray(rows, np.float32).reshape(-1)
        return name

    def drop(self, keys: set[AssetKey]) -> None:
        """Deletes assets that nothing refers to any more; materials before the textures they use."""
        order = {"material": 0, "mesh": 1, "hfield": 2, "texture": 3}
        for kind, name in sorted(keys & self.known, key=lambda k: (order[k[0]], k[1])):
            self.spec.delete(getattr(self.spec, kind)(name))
            self.known.discard((kind, name))


def _is_stout_prism(points: Floats) -> bool:
    """Whether six points are a triangle and its shifted copy, and far from flat: the usual case, quickly told."""
    if len(points) != 6:
        return False
    shift = points[3:] - points[:3]
    if np.abs(shift - shift[0]).max() > 1e-9:
        return False
    u, v = points[1] - points[0], points[2] - points[0]
    area = float(np.linalg.norm(np.cross(u, v)))
    edge = float(max(u @ u, v @ v, (u - v) @ (u - v)))
    return area > 1e-3 * edge and float(shift[0] @ shift[0]) > 1e-8 * edge


def _digest(*values: Any) -> str:
    digest = hashlib.sha1(usedforsecurity=False)
    for value in values:
        if isinstance(value, np.ndarray):
            digest.update(f"{value.dtype}{value.shape}".encode())
            digest.update(np.ascontiguousarray(value).data)
        else:
            digest.update(repr(value).encode())
        digest.update(b"|")
    return digest.hexdigest()[:20]
