"""Shapes and lights of a composed scene as arrays, read once per composition."""

from __future__ import annotations

import mujoco
import numpy as np

from simkit.sensors.cameras.rendering.software.shape_meshes import PLANE
from simkit.sensors.cameras.rendering.software.vectors import Floats, Integers

_GEOM = int(mujoco.mjtObj.mjOBJ_GEOM)


class ShapeTable:
    """Properties of the shapes of a scene, one row per shape.

    Attributes:
        kinds: types of the shapes.
        geoms: ids of the geoms, -1 for a shape that is not a geom of the model.
        numbers: indices of meshes, height fields and planes; -1 without.
        objects: ids of flexes and skins.
        materials: ids of the materials, -1 without.
        has_coordinates: True for a shape with texture coordinates.
        textures: ids of the shapes' own textures, -1 for the material's.
        repeats: repeats of the shapes' own textures.
        is_uniform: True if a shape's own texture repeats per metre.
        sizes, positions: size and position [m], shape (n, 3).
        rotations: rotation matrices, shape (n, 3, 3).
        poses: positions, rotations and sizes together, to compare them, shape (n, 15).
        colours: red, green, blue and opacity, shape (n, 4).
        emission, specular, shininess: properties of the surfaces, shape (n,).
        segments: numbers of the shapes in images of ids, -1 for a shape that these do not show.
        casts_shadow: True for a shape that casts a shadow if its light has shadows.
    """

    def __init__(self, scene: mujoco.MjvScene) -> None:
        shapes = scene.geoms[: scene.ngeom]
        count = len(shapes)
        self.kinds: Integers = np.array([shape.type for shape in shapes], np.int32)
        self.objects: Integers = np.array([shape.objid for shape in shapes], np.int32)
        is_geom = np.array([shape.objtype == _GEOM for shape in shapes], bool)
        self.geoms: Integers = np.where(is_geom, self.objects, -1).astype(np.int32)
        self.numbers: Integers = np.array([shape.dataid for shape in shapes], np.int32)
        self.materials: Integers = np.array([shape.matid for shape in shapes], np.int32)
        self.has_coordinates = np.array([bool(shape.texcoord) for shape in shapes], bool)
        self.sizes: Floats = np.array([shape.size for shape in shapes], np.float32).reshape(count, 3)
        self.positions: Floats = np.array([shape.pos for shape in shapes], np.float32).reshape(count, 3)
        self.rotations: Floats = np.array([shape.mat for shape in shapes], np.float32).reshape(count, 3, 3)
        self.colours: Floats = np.array([shape.rgba for shape in shapes], np.float32).reshape(count, 4)
        self.emission: Floats = np.array([shape.emission for shape in shapes], np.float32)
        self.specular: Floats = np.array([shape.specular for shape in shapes], np.float32)
        self.shininess: Floats = np.array([shape.shininess for shape in shapes], np.float32)
        self.segments: Integers = np.array([shape.segid for shape in shapes], np.int32)
        decoration = int(mujoco.mjtCatBit.mjCAT_DECOR)
        self.casts_shadow = np.array([shape.category != decoration and shape.castshadow for shape in shapes], bool)
        pose = (self.positions, self.rotations.reshape(count, 9), self.sizes)
        self.poses: Floats = np.concatenate(pose, axis=1)
        self.textures: Integers = np.array([shape.texid for shape in shapes], np.int32)
        self.repeats: Floats = np.array([shape.texrepeat for shape in shapes], np.float32).reshape(count, 2)
        self.is_uniform = np.array([bool(shape.texuniform) for shape in shapes], bool)

    def __len__(self) -> int:
        return len(self.kinds)

    def planes(self) -> Integers:
        """Return the indices of the planes."""
        return np.flatnonzero(self.kinds == PLANE).astype(np.int32)
