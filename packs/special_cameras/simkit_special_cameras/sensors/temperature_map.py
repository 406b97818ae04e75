"""Temperatures of all geoms of a world, and heat textures on their surfaces."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass
from functools import lru_cache
from pathlib import Path
from typing import Final

import mujoco
import numpy as np
import numpy.typing as npt

from simkit import Pose, Simulation
from simkit.compiler.shape_geometry import textured_triangles, turn_z_to
from simkit.extend import Diagnostics, Vector, Where
from simkit.linear_algebra import matmul
from simkit.loaders.meshes.companion_files import read_pixels
from simkit.loaders.meshes.mesh_reader import load_mesh
from simkit.runtime.handles.visual import HeatSignature
from simkit.scene import Geometry, Mesh, Plane
from simkit.sensors.cameras.rendering.view import Ids
from simkit.sensors.rays.embree_rays import TriangleScene, has_embree

Kelvins = npt.NDArray[np.float32]

_LUMA: Final = np.array((0.299, 0.587, 0.114))
_FAR: Final = np.float32(1e6)
_DEFAULT: Final = (0.5, 0.5, 0.5, 1.0)  # colour that the engine gives to a geom without one


@dataclass(frozen=True, eq=False)
class HeatTexture:
    """Red channel of an image, from 0 to 1, rows from the top; the texture repeats beyond its edges.

    Attributes:
        framed: pixels with a border of one pixel copied from the opposite edge, so that interpolation wraps around.
        mean: mean of all pixels.
    """

    framed: npt.NDArray[np.float32]
    mean: float

    def at(self, uv: Vector) -> npt.NDArray[np.float32]:
        """Return the linearly interpolated values at texture coordinates, shape (n, 2), with v upwards."""
        import cv2

        height, width = self.framed.shape[0] - 2, self.framed.shape[1] - 2
        column = (uv[:, 0] % 1.0 * width + 0.5).astype(np.float32)
        row = ((1.0 - uv[:, 1]) % 1.0 * height + 0.5).astype(np.float32)
        samples = []
        for first in range(0, len(uv), 32000):  # OpenCV's rows are limited to 32767 pixels
            part = slice(first, first + 32000)
            samples.append(cv2.remap(self.framed, column[None, part], row[None, part], cv2.INTER_LINEAR)[0])
        return np.concatenate(samples) if samples else np.empty(0, np.float32)


class TexturedMesh:
    """Triangles of a visual with texture coordinates, in the visual's own frame.

    Args:
        corners: corners [m], shape (n, 3).
        faces: corner indices of the triangles, shape (m, 3).
        uv: texture coordinates of the corners, shape (n, 2).
    """

    def __init__(self, corners: Vector, faces: npt.NDArray[np.int32], uv: Vector) -> None:
        self._scene = TriangleScene(corners, faces)
        # both coordinates are linear on each triangle: uv = slope · point + start
        a, first = corners[faces[:, 0]], uv[faces[:, 0]]
        edges = np.stack([corners[faces[:, k]] - a for k in (1, 2)], axis=1)
        rises = np.stack([uv[faces[:, k]] - first for k in (1, 2)], axis=1)
        slopes = np.einsum("mki,mjk->mij", rises, _edge_inverses(edges))
        starts = first - np.einsum("mij,mj->mi", slopes, a)
        self._maps = np.concatenate((slopes, starts[:, :, None]), axis=2)

    def texture_hits(self, origin: Vector, directions: Vector) -> tuple[npt.NDArray[np.intp], Vector]:
        """Return the indices of the rays that hit, and the texture coordinates there.

        Args:
            origin: origin of the rays [m], shape (3,).
            directions: unit vectors, shape (n, 3).
        """
        limits = np.full(len(directions), _FAR)
        hits, distances, triangles = self._scene.nearest(origin, directions, 0.0, limits)
        points = origin + directions[hits] * distances[:, None]
        maps = self._maps.take(triangles, axis=0)
        u, v = (np.einsum("nj,nj->n", maps[:, i, :3], points) + maps[:, i, 3] for i in (0, 1))
        return hits, np.column_stack((u, v))


@dataclass(frozen=True, eq=False)
class HeatSurface:
    """Visual with a heat signature.

    Attributes:
        body: body of the engine that carries the visual.
        pose: pose of the visual in that body.
        signature: range of temperatures.
        picture: heat texture.
        skin: triangles with texture coordinates; None without them, and the temperature is then the mean everywhere.
    """

    body: int
    pose: Pose
    signature: HeatSignature
    picture: HeatTexture
    skin: TexturedMesh | None

    @property
    def mean(self) -> float:
        """Mean temperature [K]."""
        return float(self._temperature_at(np.float32(self.picture.mean)))

    def _temperature_at(self, share: Kelvins | np.float32) -> Kelvins | np.float32:
        coldest, hottest = self.signature.coldest, self.signature.hottest
        return coldest + (hottest - coldest) * share

    def temperatures(self, eye: Vector, rotation: Vector, directions: Vector) -> Kelvins:
        """Return the temperatures where rays hit the surface [K], shape (n,); the mean where rays miss all triangles.

        Args:
            eye: position of the camera in the visual's frame [m].
            rotation: rotation matrix of the camera in that frame, shape (3, 3).
            directions: unit vectors in the camera's frame, shape (n, 3).
        """
        temperatures = np.full(len(directions), self.mean, np.float32)
        if self.skin is not None and len(directions):
            hits, uv = self.skin.texture_hits(eye, matmul(directions, rotation.T))
            temperatures[hits] = self._temperature_at(self.picture.at(uv))
        return temperatures


@dataclass(frozen=True, eq=False)
class TemperatureMap:
    """Temperatures of one world at one time.

    Attributes:
        table: temperature of each geom [K], shape (ngeom + 1,); the last, index -1, applies where there is no geom.
        is_source: True for geoms with a temperature of their own.
        surfaces: visuals with more than one temperature.
        surface_of: index of each geom's surface in `surfaces`, -1 for none.
    """

    table: Kelvins
    is_source: npt.NDArray[np.bool_]
    surfaces: tuple[HeatSurface, ...]
    surface_of: npt.NDArray[np.int32]

    def seen(self, ids: Ids) -> Iterator[tuple[int, npt.NDArray[np.intp]]]:
        """Yield the indices of visible surfaces, with their pixels in the flattened image."""
        surfaces = self.surface_of.take(ids.ravel(), mode="wrap")
        pixels = np.flatnonzero(surfaces >= 0)
        surfaces = surfaces[pixels]
        pixels = pixels[np.argsort(surfaces, kind="stable")]
        counts = np.bincount(surfaces, minlength=len(self.surfaces))
        for surface, part in enumerate(np.split(pixels, np.cumsum(counts)[:-1])):
            if len(part):
                yield surface, part


def make_temperature_map(sim: Simulation, air: float, span: float) -> TemperatureMap:
    """Return the current temperatures.

    Args:
        sim: simulation.
        air: temperature of all objects that have no temperature in the file [K].
        span: temperature difference between a white and a black object [K], as in Gazebo. Half of the difference is
            above `air`, and half is below.
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
    """Return the brightness of each geom's unlit colour, from 0 to 1 (Rec. 601); a texture counts with its mean."""
    shown = model.geom_rgba[:, :3].astype(np.float64)
    material = model.geom_matid
    of_material = material >= 0
    if of_material.any():
        # a geom with the engine's default colour shows the colour of its material
        plain = of_material & (model.geom_rgba == np.array(_DEFAULT, np.float32)).all(axis=1)
        shown[plain] = model.mat_rgba[material[plain], :3]
        textures = model.mat_texid[:, int(mujoco.mjtTextureRole.mjTEXROLE_RGB)]
        for i in np.flatnonzero(of_material).tolist():
            texture = int(textures[material[i]])
            if texture >= 0:
                shown[i] *= _mean_colour(model, texture)
    brightness: Vector = np.clip(matmul(shown, _LUMA), 0.0, 1.0)
    return brightness


def _mean_colour(model: mujoco.MjModel, texture: int) -> Vector:
    size = int(model.tex_height[texture]) * int(model.tex_width[texture])
    channels, start = int(model.tex_nchannel[texture]), int(model.tex_adr[texture])
    pixels = model.tex_data[start : start + size * channels].reshape(size, channels)
    mean: Vector = pixels[:, :3].mean(axis=0) / 255.0
    return mean if channels >= 3 else np.full(3, mean[0])


def _edge_inverses(edges: Vector) -> Vector:
    """Return the pseudo-inverses (m, 3, 2) of the two edges of each triangle, shape (m, 2, 3) [m]."""
    a, b = (edges * edges).sum(axis=2).T
    c = (edges[:, 0] * edges[:, 1]).sum(axis=1)
    determinant = a * b - c * c
    is_flat = determinant <= 1e-12 * a * b  # both edges lie on one line
    scale = np.where(is_flat, np.maximum(a + b, 1e-300), determinant)[:, None, None]
    first, second = edges[:, 0], edges[:, 1]
    both = np.stack((b[:, None] * first - c[:, None] * second, a[:, None] * second - c[:, None] * first), axis=2)
    inverses: Vector = np.where(is_flat[:, None, None], edges.transpose(0, 2, 1), both) / scale
    return inverses


@lru_cache(maxsize=32)
def _load_heat_texture(path: Path) -> HeatTexture:
    red = np.ascontiguousarray(read_pixels(path)[..., 0], np.float32) / np.float32(255.0)
    return HeatTexture(np.pad(red, 1, mode="wrap"), float(red.mean(dtype=np.float64)))


@lru_cache(maxsize=64)
def _make_textured_mesh(shape: Geometry) -> TexturedMesh | None:
    """Return the triangles of a shape; None if the shape has no texture coordinates or Embree is not installed."""
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
    """Yield corners, faces and texture coordinates of the parts of a shape that have texture coordinates."""
    if isinstance(shape, Mesh):
        for part in [] if shape.missing else load_mesh(shape, Diagnostics(), Where()):
            if part.uv is not None:
                yield part.vertices, part.faces, part.uv
    elif isinstance(shape, Plane):
        uv = np.array(((0.0, 0.0), (1.0, 0.0), (1.0, 1.0), (0.0, 1.0)))
        flat = np.column_stack(((uv - 0.5) * shape.size, np.zeros(4)))
        turn = Pose(quaternion=turn_z_to(shape.normal)).matrix
        yield matmul(flat, turn.T), np.array(((0, 1, 2), (0, 2, 3)), np.int32), uv
    elif (textured := textured_triangles(shape)) is not None and textured.uv is not None:
        yield textured.vertices, textured.faces, textured.uv
