"""Textures of shapes, sampled as OpenGL does it: bilinear, between two reduced levels, repeated at the edges."""

from __future__ import annotations

from typing import Final

import mujoco
import numpy as np

from simkit.sensors.cameras.rendering.software import shape_meshes
from simkit.sensors.cameras.rendering.software.frame import Frame
from simkit.sensors.cameras.rendering.software.rasteriser import draw_numbers, draw_values, nearer
from simkit.sensors.cameras.rendering.software.shape_table import ShapeTable
from simkit.sensors.cameras.rendering.software.triangles import Corners, Triangles
from simkit.sensors.cameras.rendering.software.vectors import Array, Floats, rotate

_ROLES: Final = int(mujoco.mjtTextureRole.mjNTEXROLE)
_RGB: Final = int(mujoco.mjtTextureRole.mjTEXROLE_RGB)
_PLANAR: Final = int(mujoco.mjtTexture.mjTEXTURE_2D)
_SRGB: Final = int(mujoco.mjtColorSpace.mjCOLORSPACE_SRGB)
_MAPPED: Final = (*shape_meshes.UNIT, shape_meshes.CAPSULE)
"""Types of shapes with texture coordinates of their own."""


class Texture:
    """One texture with its reduced levels, each half as large as the one before.

    Args:
        model: compiled model.
        number: id of the texture.

    Attributes:
        is_cube: True for a texture of six faces, looked up by direction.
        levels: images from fine to coarse, shape (height, width, 3); of a cube (6·size, size, 3).
    """

    def __init__(self, model: mujoco.MjModel, number: int) -> None:
        height, width = int(model.tex_height[number]), int(model.tex_width[number])
        channels, first = int(model.tex_nchannel[number]), int(model.tex_adr[number])
        pixels = np.asarray(model.tex_data[first : first + height * width * channels]).reshape(height, width, channels)
        pixels = np.repeat(pixels, 3, axis=2) if channels == 1 else pixels[..., :3]
        self.is_cube = int(model.tex_type[number]) != _PLANAR
        image = _linear_table(int(model.tex_colorspace[number]) == _SRGB)[pixels]
        if self.is_cube and height == width:
            image = np.tile(image, (6, 1, 1))
        self.levels = [image]
        while max(self.levels[-1].shape[1], self.levels[-1].shape[0] // (6 if self.is_cube else 1)) > 1:
            self.levels.append(_halved(self.levels[-1], 6 if self.is_cube else 1))

    def sample(self, s: Floats, t: Floats, texels: Floats) -> Floats:
        """Return colours of a planar texture, shape (n, 3).

        Args:
            s: texture coordinates to the right, shape (n,); the texture repeats at whole numbers.
            t: texture coordinates downwards, shape (n,).
            texels: size of a pixel in the finest level [texels], shape (n,).
        """
        return self._between_levels(texels, lambda level, rows: self._planar(level, s[rows], t[rows]))

    def sample_cube(self, directions: Floats, texels: Floats) -> Floats:
        """Return colours of a cube, shape (n, 3), in directions (n, 3)."""
        face, s, t = _cube_face(directions)
        return self._between_levels(texels, lambda level, rows: self._on_face(level, face[rows], s[rows], t[rows]))

    def _between_levels(self, texels: Floats, sample: object) -> Floats:
        assert callable(sample)
        level = np.minimum(_binary_logarithm(np.maximum(texels, np.float32(1.0))), np.float32(len(self.levels) - 1))
        lower = level.astype(np.int32)
        share = (level - lower).astype(np.float32)
        colours = np.empty((len(texels), 3), np.float32)
        for number in np.unique(lower).tolist():
            rows = np.flatnonzero(lower == number)
            colours[rows] = sample(number, rows)
            mixed = rows[share[rows] > 0.0]
            if len(mixed) and number + 1 < len(self.levels):
                coarse = sample(number + 1, mixed)
                colours[mixed] += share[mixed, None] * (coarse - colours[mixed])
        return colours

    def _planar(self, level: int, s: Floats, t: Floats) -> Floats:
        image = self.levels[level]
        height, width = image.shape[:2]
        x, y = s * np.float32(width) - np.float32(0.5), t * np.float32(height) - np.float32(0.5)
        x0, y0 = np.floor(x), np.floor(y)
        column, row = x0.astype(np.int64) % width, y0.astype(np.int64) % height
        return _blend(image, (column, (column + 1) % width), (row, (row + 1) % height), x - x0, y - y0)

    def _on_face(self, level: int, face: Array, s: Floats, t: Floats) -> Floats:
        image = self.levels[level]
        size = image.shape[1]
        x = np.clip(s * np.float32(size) - np.float32(0.5), 0, size - 1)
        y = np.clip(t * np.float32(size) - np.float32(0.5), 0, size - 1)
        x0, y0 = np.floor(x), np.floor(y)
        column, row = x0.astype(np.int64), y0.astype(np.int64)
        rows = face * size + row, face * size + np.minimum(row + 1, size - 1)
        return _blend(image, (column, np.minimum(column + 1, size - 1)), rows, x - x0, y - y0)


def _blend(
    image: Floats, columns: tuple[Array, Array], rows: tuple[Array, Array], right: Floats, down: Floats
) -> Floats:
    """Return the bilinear mean of four pixels each, shape (n, 3)."""
    flat, width = image.reshape(-1, 3), image.shape[1]
    upper, lower = (
        a + right[:, None] * (b - a)
        for a, b in ((flat.take(row * width + columns[0], 0), flat.take(row * width + columns[1], 0)) for row in rows)
    )
    mean: Floats = upper + down[:, None] * (lower - upper)
    return mean


def _linear_table(is_srgb: bool) -> Floats:
    """Return the value of each byte of a texture, from 0 to 1."""
    values = [byte / 255.0 for byte in range(256)]
    if is_srgb:
        values = [v / 12.92 if v <= 0.04045 else ((v + 0.055) / 1.055) ** 2.4 for v in values]
    return np.array(values, np.float32)


def _halved(image: Floats, faces: int) -> Floats:
    """Return an image, or faces below each other, at half the size: the mean of 2 x 2 pixels."""
    height, width = image.shape[0] // faces, image.shape[1]
    parts = image.reshape(faces, height, width, 3)
    for axis in (1, 2):
        size = parts.shape[axis]
        if size > 1:
            even = np.take(parts, np.arange(0, size - size % 2, 2), axis)
            odd = np.take(parts, np.arange(1, size, 2), axis)
            parts = (even + odd) * np.float32(0.5)
    return np.ascontiguousarray(parts.reshape(-1, parts.shape[2], 3))


def _binary_logarithm(values: Floats) -> Floats:
    """Return log2 of values of at least 1, to three digits, by their exponent and a polynomial of their mantissa."""
    mantissa, exponent = np.frexp(values)
    x = mantissa * np.float32(2.0) - np.float32(1.0)
    # x in 0…1; the error is below 0.001
    curve = x * (np.float32(1.4252) + x * (np.float32(-0.6317) + x * np.float32(0.2065)))
    logarithm: Floats = (exponent - 1).astype(np.float32) + np.minimum(curve, np.float32(1.0))
    return logarithm


def _cube_face(directions: Floats) -> tuple[Array, Floats, Floats]:
    """Return the face of each direction (+x, -x, +y, -y, +z, -z) and the coordinates on it (OpenGL 2.1, table 3.19)."""
    size = np.abs(directions)
    axis = size.argmax(axis=1)
    main = np.take_along_axis(directions, axis[:, None], 1)[:, 0]
    x, y, z = directions[:, 0], directions[:, 1], directions[:, 2]
    face = 2 * axis + (main < 0.0)
    s = np.choose(face, (-z, z, x, x, x, -x))
    t = np.choose(face, (-y, -y, z, -z, -y, -y))
    length = np.maximum(np.abs(main), np.float32(1e-12))
    half = np.float32(0.5)
    return face, half * (s / length + np.float32(1.0)), half * (t / length + np.float32(1.0))


class TexturedShapes:
    """Textures of the shapes of a scene.

    Args:
        model: compiled model.
        table: shapes of the scene.
        textures: textures of the model by their id, filled here.
    """

    def __init__(self, model: mujoco.MjModel, table: ShapeTable, textures: dict[int, Texture]) -> None:
        self._model, self._table, self._known = model, table, textures
        shape_textures = table.textures
        numbers = np.full(len(table), -1, np.int32)
        if model.ntex and model.nmat:
            by_material = np.asarray(model.mat_texid).reshape(model.nmat, _ROLES)[:, _RGB]
            has_material = table.materials >= 0
            numbers[has_material] = by_material[table.materials[has_material]]
        numbers[shape_textures >= 0] = shape_textures[shape_textures >= 0]
        for row in np.flatnonzero(numbers >= 0):
            is_bare = table.kinds[row] in (shape_meshes.LINE, shape_meshes.LINEBOX)
            channels = int(model.tex_nchannel[numbers[row]])
            is_cube = int(model.tex_type[numbers[row]]) != _PLANAR
            # the engine binds a cube to explicit coordinates as if it were planar, and draws no texture
            if is_bare or channels not in (3, 4) or (is_cube and table.has_coordinates[row]):
                numbers[row] = -1
        self.numbers = numbers

    def __bool__(self) -> bool:
        return bool((self.numbers >= 0).any())

    def coordinates(self, corners: Corners, frame: Frame) -> Floats:
        """Return the texture coordinates at corners, shape (n, 3); two of them for planar textures."""
        uv = np.zeros((len(corners.points), 3), np.float32)
        for row in np.unique(corners.owners[self.numbers[corners.owners] >= 0]).tolist():
            rows = np.flatnonzero(corners.owners == row)
            uv[rows] = self._of_shape(row, corners.points[rows], corners.coordinates[rows], frame)
        return uv

    def _of_shape(self, row: int, points: Floats, coordinates: Floats, frame: Frame) -> Floats:
        """Return coordinates as MuJoCo 4 maps them: repeated over the unit shape, or over the metres of its size."""
        table, model = self._table, self._model
        kind, material, is_own = int(table.kinds[row]), int(table.materials[row]), bool(table.textures[row] >= 0)
        size = np.where(table.sizes[row] > 0.0, table.sizes[row], np.float32(1.0))
        is_uniform = bool(table.is_uniform[row] if is_own else model.mat_texuniform[material])
        repeat = table.repeats[row] if is_own else np.asarray(model.mat_texrepeat[material], np.float32)
        if is_uniform:
            repeat = repeat * size[:2]
        if (kind in _MAPPED or table.has_coordinates[row]) and not self.texture(row).is_cube:
            return np.append(coordinates * repeat, np.zeros((len(points), 1), np.float32), axis=1)
        position = (table.positions[row].astype(np.float64) - frame.origin).astype(np.float32)
        local = rotate(points - position, table.rotations[row].T)
        if kind in _MAPPED or kind == shape_meshes.PLANE:
            local = local / size
        if self.texture(row).is_cube:
            return np.asarray(local * size if is_uniform else local, np.float32)
        half = np.float32(0.5)
        if kind == shape_meshes.PLANE:
            # an endless plane begins in its middle, another one at its edge
            start = np.where(table.sizes[row, :2] > 0.0, half, np.float32(0.0))
            s, t = (half * local[:, 0] + start[0]) * repeat[0], (start[1] - half * local[:, 1]) * repeat[1]
        else:
            s = half * repeat[0] / size[0] * local[:, 0] - half
            t = -half * repeat[1] / size[1] * local[:, 1] - half
        return np.stack((s, t, np.zeros_like(s)), axis=-1)

    def texture(self, row: int) -> Texture:
        """Return the texture of a shape."""
        number = int(self.numbers[row])
        if number not in self._known:
            self._known[number] = Texture(self._model, number)
        return self._known[number]

    def apply(self, frame: Frame, triangles: Triangles, coordinates: Floats, image: Floats, keys: Floats) -> None:
        """Multiply the colours of an image by the textures of its shapes.

        Args:
            frame: pose and frustum of the image.
            triangles: triangles of the image.
            coordinates: texture coordinates at the corners of `triangles`, shape (n, 3).
            image: colours, shape (height, width, 3).
            keys: keys after all triangles were drawn.
        """
        faces = triangles.of_shapes(self.numbers >= 0)
        if not len(faces):
            return
        owners = np.zeros((*keys.shape, 3), np.float32)
        draw_numbers(frame, triangles.points, faces, triangles.owners + np.int32(1), owners, nearer(keys))
        where = np.zeros((*keys.shape, 3), np.float32)
        draw_values(frame, triangles.points, faces, coordinates, where, nearer(keys))
        numbers = owners[..., 0].astype(np.int32)
        size = _pixel_sizes(where, numbers)
        flat, flat_where = image.reshape(-1, 3), where.reshape(-1, 3)
        for number in np.unique(numbers).tolist():
            if not number:
                continue
            pixels = np.flatnonzero(numbers == number)
            texture = self.texture(number - 1)
            at = flat_where[pixels]
            steps = size.reshape(-1, 6)[pixels]
            if texture.is_cube:
                reach = np.maximum(np.abs(at).max(axis=1), np.float32(1e-12))
                texels = steps.max(axis=1) / reach * np.float32(0.5 * texture.levels[0].shape[1])
                flat[pixels] *= texture.sample_cube(at, texels)
            else:
                height, width = texture.levels[0].shape[:2]
                texels = np.maximum(
                    *(_length(steps[:, k] * np.float32(width), steps[:, k + 1] * np.float32(height)) for k in (0, 3))
                )
                flat[pixels] *= texture.sample(at[:, 0], at[:, 1], texels)


def _length(x: Floats, y: Floats) -> Floats:
    lengths: Floats = np.sqrt(x * x + y * y)
    return lengths


def _pixel_sizes(where: Floats, numbers: Array) -> Floats:
    """Return how much coordinates change to the next column and row of the same shape, shape (height, width, 6)."""
    sizes = np.zeros((*numbers.shape, 6), np.float32)
    for axis, first in ((1, 0), (0, 3)):
        change = np.abs(np.diff(where, axis=axis))
        change[np.diff(numbers, axis=axis) != 0] = 0.0
        low = tuple(slice(None, -1) if k == axis else slice(None) for k in (0, 1))
        high = tuple(slice(1, None) if k == axis else slice(None) for k in (0, 1))
        part = sizes[..., first : first + 3]
        part[low] = change
        # at the border of a shape only the step on the other side is known; a seam has a step that is too large
        other = part[high]
        smaller = (other == 0.0) | ((change > 0.0) & (change < other))
        other[smaller] = change[smaller]
    return sizes
