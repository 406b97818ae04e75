"""Temperatures of all geoms of a world, and heat textures on their surfaces."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass
from functools import lru_cache
from pathlib import Path
from typing import Any, Final

import mujoco
import numpy as np
import numpy.typing as npt

from simkit.compiler.meshes.companion_files import read_pixels
from simkit.compiler.meshes.mesh_reader import load_mesh
from simkit.compiler.shape_geometry import textured_triangles, turn_z_to
from simkit.diagnostics import NOWHERE, Diagnostics
from simkit.pose import Pose, Vector
from simkit.runtime import Simulation
from simkit.runtime.handles.visual import HeatSignature
from simkit.scene import Geometry, Mesh, Plane
from simkit.sensors.cameras.rendering.view import Ids
from simkit.sensors.rays.embree_rays import TriangleScene, has_embree

Kelvins = npt.NDArray[np.float32]

_LUMA: Final = np.array((0.299, 0.587, 0.114))
_FAR: Final = np.float32(1e6)
_DEFAULT: Final = (0.5, 0.5, 0.5, 1.0)  # the engine's colour of a geom that is given none


@dataclass(frozen=True, eq=False)
class HeatTexture:
    """The red channel of a picture, from 0 to 1, rows from the top; it repeats beyond its edges.

    Attributes:
        framed: with a pixel more on each side, of the opposite one, so that what is between the last and the first is
            right.
        mean: of all its pixels.
    """

    framed: npt.NDArray[np.float32]
    mean: float

    def at(self, uv: Vector) -> npt.NDArray[np.float32]:
        """Its values at texture coordinates, shape (n, 2), v upwards, between its pixels linearly."""
        import cv2

        height, width = self.framed.shape[0] - 2, self.framed.shape[1] - 2
        column = (uv[:, 0] % 1.0 * width + 0.5).astype(np.float32)
        row = ((1.0 - uv[:, 1]) % 1.0 * height + 0.5).astype(np.float32)
        found = []
        for first in range(0, len(uv), 32000):  # OpenCV's rows end at 32767
            part = slice(first, first + 32000)
            found.append(cv2.remap(self.framed, column[None, part], row[None, part], cv2.INTER_LINEAR)[0])
        return np.concatenate(found) if found else np.empty(0, np.float32)


class TexturedMesh:
    """The triangles of a visual, in its own frame, with texture coordinates.

    Args:
        corners: [m], shape (n, 3).
        faces: shape (m, 3).
        uv: of the corners, shape (n, 2).
    """

    def __init__(self, corners: Vector, faces: npt.NDArray[np.int32], uv: Vector) -> None:
        self._scene = TriangleScene(corners, faces)
        # on each triangle both coordinates are linear: uv = slope · point + start
        a, first = corners[faces[:, 0]], uv[faces[:, 0]]
        edges = np.stack([corners[faces[:, k]] - a for k in (1, 2)], axis=1)
        rises = np.stack([uv[faces[:, k]] - first for k in (1, 2)], axis=1)
        slopes = np.einsum("mki,mjk->mij", rises, np.linalg.pinv(edges))
        starts = first - np.einsum("mij,mj->mi", slopes, a)
        self._maps = np.concatenate((slopes, starts[:, :, None]), axis=2)

    def texture_hits(self, origin: Vector, directions: Vector) -> tuple[npt.NDArray[np.intp], Vector]:
        """Which rays from a point hit, and the texture coordinates there.

        Args:
            origin: shape (3,) [m].
            directions: unit vectors, shape (n, 3).
        """
        limits = np.full(len(directions), _FAR)
        which, distances, triangles = self._scene.nearest(origin, directions, 0.0, limits)
        points = origin + directions[which] * distances[:, None]
        maps = self._maps.take(triangles, axis=0)
        u, v = (np.einsum("nj,nj->n", maps[:, i, :3], points) + maps[:, i, 3] for i in (0, 1))
        return which, np.column_stack((u, v))


@dataclass(frozen=True, eq=False)
class HeatSurface:
    """A visual with a heat signature.

    Attributes:
        body: of the engine, that carries it.
        pose: of the visual in that body.
        skin: None where nothing tells where on the picture a point is; it then has the mean everywhere.
    """

    body: int
    pose: Pose
    signature: HeatSignature
    picture: HeatTexture
    skin: TexturedMesh | None

    @property
    def mean(self) -> float:
        """[K]."""
        return float(self._temperature_at(np.float32(self.picture.mean)))

    def _temperature_at(self, share: Any) -> Any:
        coldest, hottest = self.signature.coldest, self.signature.hottest
        return coldest + (hottest - coldest) * share

    def temperatures(self, eye: Vector, rotation: Vector, directions: Vector) -> Kelvins:
        """Where rays meet it [K], shape (n,); the mean where they pass its edge.

        Args:
            eye: of the camera in the visual's frame [m].
            rotation: of the camera in it, shape (3, 3).
            directions: unit vectors in the camera's frame, shape (n, 3).
        """
        found = np.full(len(directions), self.mean, np.float32)
        if self.skin is not None and len(directions):
            which, uv = self.skin.texture_hits(eye, directions @ rotation.T)
            found[which] = self._temperature_at(self.picture.at(uv))
        return found


@dataclass(frozen=True, eq=False)
class TemperatureMap:
    """The temperatures of one world at one time.

    Attributes:
        table: of each geom [K], shape (ngeom + 1,); the last, index -1, is of where there is none.
        is_source: which of them have a temperature of their own.
        surfaces: what has more than one.
        surface_of: the place of each geom's among them, -1 for most.
    """

    table: Kelvins
    is_source: npt.NDArray[np.bool_]
    surfaces: tuple[HeatSurface, ...]
    surface_of: npt.NDArray[np.int32]

    def seen(self, ids: Ids) -> Iterator[tuple[int, npt.NDArray[np.intp]]]:
        """The places of surfaces that are seen, and at which pixels of the flattened picture."""
        places = self.surface_of.take(ids.ravel(), mode="wrap")
        pixels = np.flatnonzero(places >= 0)
        places = places[pixels]
        pixels = pixels[np.argsort(places, kind="stable")]
        counts = np.bincount(places, minlength=len(self.surfaces))
        for place, part in enumerate(np.split(pixels, np.cumsum(counts)[:-1])):
            if len(part):
                yield place, part


def make_temperature_map(sim: Simulation, air: float, span: float) -> TemperatureMap:
    """What is how warm now.

    Args:
        air: temperature of what has none of its own [K].
        span: between what is black and what is white of that [K], as in Gazebo: half of it below the air's temperature
            and half above.
    """
    model, names = sim.mj_model, sim.engine.names
    table = np.full(model.ngeom + 1, air, np.float32)
    table[:-1] += (_brightness(model) - 0.5) * span
    is_source = np.zeros(model.ngeom + 1, np.bool_)
    surface_of = np.full(model.ngeom + 1, -1, np.int32)
    temperatures = sim.contents.temperatures.by_visual()
    surfaces: list[HeatSurface] = []
    for link in names.links.values() if temperatures else ():
        drawn = names.drawn(link.scoped)
        for visual in link.scene.visuals:
            temperature, geoms = temperatures.get(visual.scoped), list(drawn.get(visual.scoped, ()))
            if temperature is None or not geoms:
                continue
            if isinstance(temperature, HeatSignature):
                picture, skin = _load_heat_texture(temperature.picture), _make_textured_mesh(visual.geometry)
                surface = HeatSurface(link.body, link.offset @ visual.pose_link, temperature, picture, skin)
                surface_of[geoms] = len(surfaces)
                surfaces.append(surface)
                temperature = surface.mean
            table[geoms], is_source[geoms] = temperature, True
    return TemperatureMap(table, is_source, tuple(surfaces), surface_of)


def _brightness(model: mujoco.MjModel) -> Vector:
    """Of each geom's colour without light, from 0 to 1 (Rec. 601); a texture counts with its mean."""
    shown = model.geom_rgba[:, :3].astype(np.float64)
    material = model.geom_matid
    of_material = material >= 0
    if of_material.any():
        # what has the engine's default colour has that of its material
        plain = of_material & (model.geom_rgba == np.array(_DEFAULT, np.float32)).all(axis=1)
        shown[plain] = model.mat_rgba[material[plain], :3]
        textures = model.mat_texid[:, int(mujoco.mjtTextureRole.mjTEXROLE_RGB)]
        for i in np.flatnonzero(of_material).tolist():
            texture = int(textures[material[i]])
            if texture >= 0:
                shown[i] *= _mean_colour(model, texture)
    brightness: Vector = np.clip(shown @ _LUMA, 0.0, 1.0)
    return brightness


def _mean_colour(model: mujoco.MjModel, texture: int) -> Vector:
    size = int(model.tex_height[texture]) * int(model.tex_width[texture])
    channels, start = int(model.tex_nchannel[texture]), int(model.tex_adr[texture])
    pixels = model.tex_data[start : start + size * channels].reshape(size, channels)
    mean: Vector = pixels[:, :3].mean(axis=0) / 255.0
    return mean if channels >= 3 else np.full(3, mean[0])


@lru_cache(maxsize=32)
def _load_heat_texture(path: Path) -> HeatTexture:
    red = np.ascontiguousarray(read_pixels(path)[..., 0], np.float32) / np.float32(255.0)
    return HeatTexture(np.pad(red, 1, mode="wrap"), float(red.mean(dtype=np.float64)))


@lru_cache(maxsize=64)
def _make_textured_mesh(shape: Geometry) -> TexturedMesh | None:
    """The triangles of a shape; None for a shape without texture coordinates, and without a ray tracer."""
    if not has_embree():
        return None
    parts = list(_triangles(shape))
    if not parts:
        return None
    first = np.cumsum([0, *(len(corners) for corners, _, _ in parts)])
    faces = np.vstack([faces + start for (_, faces, _), start in zip(parts, first, strict=False)])
    corners = np.vstack([corners for corners, _, _ in parts])
    return TexturedMesh(corners, faces.astype(np.int32), np.vstack([uv for _, _, uv in parts]))


def _triangles(shape: Geometry) -> Iterator[tuple[Vector, npt.NDArray[np.int32], Vector]]:
    """Corners, faces and texture coordinates of its parts, where they have some."""
    if isinstance(shape, Mesh):
        for part in [] if shape.missing else load_mesh(shape, Diagnostics(), NOWHERE):
            if part.uv is not None:
                yield part.vertices, part.faces, part.uv
    elif isinstance(shape, Plane):
        uv = np.array(((0.0, 0.0), (1.0, 0.0), (1.0, 1.0), (0.0, 1.0)))
        flat = np.column_stack(((uv - 0.5) * shape.size, np.zeros(4)))
        turn = Pose(quaternion=turn_z_to(shape.normal)).matrix
        yield flat @ turn.T, np.array(((0, 1, 2), (0, 2, 3)), np.int32), uv
    elif (textured := textured_triangles(shape)) is not None and textured.uv is not None:
        yield textured.vertices, textured.faces, textured.uv
