"""Meshes, textures and materials of a spec, and the colours of geoms.

The name of an asset contains a hash of its content, so that geoms share equal assets.
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import lru_cache
from pathlib import Path
from typing import TYPE_CHECKING, Final
from weakref import WeakKeyDictionary

import mujoco
import numpy as np

from simkit.loaders.meshes.companion_files import Pixels, read_pixels
from simkit.loaders.meshes.mesh_cache import content_digest
from simkit.loaders.meshes.mesh_part import Colour, Floats, Ints, MeshPart
from simkit.scene import Material, SceneVisual

if TYPE_CHECKING:
    from simkit.compiler.meshes.convex_decomposition import ConvexBodies

AssetKey = tuple[str, str]
"""Kind and MuJoCo name of an asset."""

_names: WeakKeyDictionary[MeshPart, dict[bool, str]] = WeakKeyDictionary()
_body_names: WeakKeyDictionary[ConvexBodies, list[str]] = WeakKeyDictionary()
_tile_digests: WeakKeyDictionary[ConvexBodies, str] = WeakKeyDictionary()


class Assets:
    """Writer that adds each asset once.

    MuJoCo visits all meshes at each attachment of geoms. With 72,000 convex bodies, this took a third of the load of a
    world. Meshes are therefore added after all geoms, by `add_waiting`.

    Attributes:
        spec: specification; before others use its meshes, call `add_waiting`.
        known: assets that were added.
        used: assets of the model under construction.
    """

    def __init__(self, spec: mujoco.MjSpec, known: set[AssetKey] | None = None) -> None:
        self.spec = spec
        self.known: set[AssetKey] = set(known or ())
        self.used: set[AssetKey] = set()
        self._pictures: dict[Path, Pixels] = {}
        self._waiting: dict[str, bytes] = {}

    def _is_new(self, kind: str, name: str) -> bool:
        key = (kind, name)
        self.used.add(key)
        if key in self.known:
            return False
        self.known.add(key)
        return True

    def surface(self, vertices: Floats, faces: Ints, uv: Floats | None = None) -> str:
        """Add a triangle mesh, which may be flat or open, and return its name."""
        name = "mesh#" + content_digest(vertices, faces, uv)
        if self._is_new("mesh", name):
            self._add_mesh(name, mesh_bytes(vertices, faces, uv))
        return name

    def part(self, part: MeshPart, has_uv: bool) -> str:
        """Add the triangles of a part as a mesh and return the name of the mesh.

        The name is computed once for each part, because every load of a file returns the same `MeshPart` objects.
        """
        uv = part.uv if has_uv else None
        names = _names.setdefault(part, {})
        if has_uv not in names:
            names[has_uv] = "mesh#" + content_digest(part.vertices, part.faces, uv)
        if self._is_new("mesh", names[has_uv]):
            self._add_mesh(names[has_uv], mesh_bytes(part.vertices, part.faces, uv))
        return names[has_uv]

    def convex_bodies(self, bodies: ConvexBodies) -> list[str]:
        """Add the convex bodies of a mesh and return their names, which are computed once for each mesh."""
        names = _body_names.get(bodies)
        if names is None:
            names = _body_names[bodies] = ["mesh#" + content_digest(*shape, None) for shape in bodies.shapes]
        for name, shape in zip(names, bodies.shapes, strict=True):
            if self._is_new("mesh", name):
                self._add_mesh(name, mesh_bytes(*shape))
        return names

    def _add_mesh(self, name: str, content: bytes) -> None:
        """Add a mesh; it is in the specification after `add_waiting`."""
        self._waiting[name] = content

    def add_waiting(self) -> None:
        """Add the meshes that wait as files in memory: MuJoCo caches the conversion of a file and does not repeat it.

        The inertia type "shell" is fast to compute and valid for open and flat meshes too. MuJoCo never uses the
        result, because every body has an explicit mass.
        """
        waiting, self._waiting = self._waiting, {}
        for name, content in waiting.items():
            mesh = self.spec.add_mesh(name=name)
            mesh.inertia = mujoco.mjtMeshInertia.mjMESH_INERTIA_SHELL
            mesh.file = file_of(name)
            self.spec.assets[mesh.file] = content

    def picture(self, file: Path) -> Pixels:
        """Return the image of a texture file. Each file is read only once.

        Raises:
            MeshFileError: the file cannot be used.
        """
        if file not in self._pictures:
            self._pictures[file] = read_pixels(file)
        return self._pictures[file]

    def texture(self, pixels: Pixels, digest: str = "") -> str:
        """Add an image that is mapped by texture coordinates, and return its name.

        Args:
            pixels: image.
            digest: hash of the image if it is known; large images take as long to hash as to read.
        """
        name = "texture#" + (digest or content_digest(pixels))
        if self._is_new("texture", name):
            texture = self.spec.add_texture(name=name)
            texture.type = mujoco.mjtTexture.mjTEXTURE_2D
            texture.height, texture.width, texture.nchannel = pixels.shape
            texture.data = np.ascontiguousarray(pixels).tobytes()
        return name

    def material(self, emission: float, look: GeomColours, texture: str, repeat: tuple[float, float]) -> str:
        """Add a material with the reflection properties of a geom and return its name. The geom itself has the colour.

        Args:
            emission: emission under the scene's ambient light.
            look: reflection properties of the material.
            texture: name of the texture; empty for none.
            repeat: repetitions of the image, across and up; for shapes that have no texture coordinates.
        """
        values = (round(emission, 4), round(look.specular, 4), round(look.shininess, 4))
        name = _material_name(*values, texture, *repeat)
        if texture:
            self.used.add(("texture", texture))
        if self._is_new("material", name):
            material = self.spec.add_material(name=name)
            material.emission, material.specular, material.shininess = values
            material.rgba = (1.0, 1.0, 1.0, 1.0)
            if texture:
                material.textures[int(mujoco.mjtTextureRole.mjTEXROLE_RGB)] = texture
                material.texrepeat = repeat
        return name

    @staticmethod
    def has_texture(material: str) -> bool:
        """Check by its name whether a material has a texture."""
        return material.endswith("#textured")

    def heights(self, rows: Floats, size: tuple[float, float, float]) -> str:
        """Add a height field and return its name.

        The field is solid down to a twentieth of its height, at least 0.1 m, below its lowest point.

        Args:
            rows: heights from 0 to 1, ordered from -y to +y.
            size: extent along x and y, and greatest height [m].
        """
        name = "heights#" + content_digest(rows, size)
        if self._is_new("hfield", name):
            self._add_field(name, rows, size, max(0.1, 0.05 * size[2]))
        return name

    def tiles(self, bodies: ConvexBodies) -> list[str]:
        """Add the height fields of a mesh and return their names, which contain one hash of all of them."""
        digest = _tile_digests.get(bodies)
        if digest is None:
            values = [value for t in bodies.tiles for value in (t.cell, t.heights, np.array(t.base))]
            shapes = [t.heights.shape for t in bodies.tiles]
            digest = content_digest(np.concatenate([np.zeros(0), *(value.reshape(-1) for value in values)]), shapes)
            _tile_digests[bodies] = digest
        names = [f"heights#{digest}_{number}" for number in range(len(bodies.tiles))]
        for name, tile in zip(names, bodies.tiles, strict=True):
            if self._is_new("hfield", name):
                rows, columns = tile.heights.shape
                high = float(tile.heights.max())
                size = (float(tile.cell[0]) * (columns - 1), float(tile.cell[1]) * (rows - 1), high)
                self._add_field(name, tile.heights / max(high, 1e-12), size, tile.base)
        return names

    def _add_field(self, name: str, rows: Floats, size: tuple[float, float, float], base: float) -> None:
        field = self.spec.add_hfield(name=name)
        field.nrow, field.ncol = rows.shape
        field.size = (size[0] / 2, size[1] / 2, max(size[2], 1e-6), base)
        field.userdata = np.ascontiguousarray(rows, np.float32).reshape(-1)

    def drop(self, keys: set[AssetKey]) -> None:
        """Delete unused assets. Materials are deleted first, because they refer to textures."""
        order = {"material": 0, "mesh": 1, "hfield": 2, "texture": 3}
        for kind, name in sorted(keys & self.known, key=lambda k: (order[k[0]], k[1])):
            self.spec.delete(getattr(self.spec, kind)(name))
            self.spec.assets.pop(file_of(name), None)
            self.known.discard((kind, name))


def file_of(name: str) -> str:
    """Return the name of the file in memory (`spec.assets`) of a mesh."""
    return name.replace("#", "_") + ".msh"


def mesh_bytes(vertices: Floats, faces: Ints, uv: Floats | None = None) -> bytes:
    """Return a mesh in MuJoCo's MSH format.

    The format has counts, then vertices and texture coordinates in single precision, then faces.
    """
    if len(vertices) < 4:  # MuJoCo needs four vertices; no face uses the added vertices
        vertices = np.vstack([vertices, np.repeat(vertices[:1], 4 - len(vertices), axis=0)])
        uv = None if uv is None else np.vstack([uv, np.repeat(uv[:1], len(vertices) - len(uv), axis=0)])
    counts = np.array([len(vertices), 0, 0 if uv is None else len(uv), len(faces)], "<i4")
    content = [counts.tobytes(), vertices.astype("<f4").tobytes()]
    if uv is not None:  # the first row of an image is its top
        content.append(np.column_stack([uv[:, 0], 1.0 - uv[:, 1]]).astype("<f4").tobytes())
    content.append(faces.astype("<i4").tobytes())
    return b"".join(content)


@lru_cache(maxsize=1024)
def _material_name(*values: object) -> str:
    texture = values[3]
    return "material#" + content_digest(*values) + ("#textured" if texture else "")


PLAIN: Final[Colour] = (0.7, 0.7, 0.7, 1.0)
_SHININESS: Final = 0.3


@dataclass(frozen=True, slots=True)
class GeomColours:
    """Colour of a geom, and the reflection and emission of its material as fractions from 0 to 1.

    The renderer computes diffuse + specular + emission in the style of OpenGL. It has no separate ambient colour and
    uses the diffuse colour instead. If the ambient colour of a file is darker or brighter than its diffuse colour, the
    emission compensates for the difference, as in Gazebo Classic. This emission may be negative. An ambient colour with
    a different hue is not supported. The roughness of a PBR material sets the size of highlights. MuJoCo has no
    equivalent of metalness and of further texture maps.

    Attributes:
        ambient: brightness of the ambient colour relative to that of the diffuse colour.
    """

    rgba: tuple[float, float, float, float]
    emission: float = 0.0
    specular: float = 0.0
    shininess: float = _SHININESS
    ambient: float = 1.0

    def emission_under(self, ambient: Colour) -> float:
        """Return the emission that compensates for a material's own ambient colour under the scene's ambient light."""
        return self.emission + (self.ambient - 1.0) * brightness(ambient)


def geom_colours(visual: SceneVisual, part: MeshPart | None) -> GeomColours:
    """Return the colours of a visual or of one part of its mesh.

    The material of the `<visual>` has priority over the material in the mesh file.
    """
    material = visual.material
    emission, specular, shininess, ambient = 0.0, 0.0, _SHININESS, 1.0
    if material is not None:
        colour, emission = _colour_and_emission(material)
        specular, ambient = max(material.specular[:3]), _relative_ambient(material)
        if material.shininess is not None:
            shininess = min(1.0, material.shininess / 128.0)
        elif material.roughness is not None:
            shininess = 1.0 - min(1.0, max(0.0, material.roughness))
    elif part is not None:
        colour = part.colour or PLAIN
        emission, specular = part.emission, part.specular
    else:
        colour = PLAIN
    r, g, b, a = colour
    a *= 1.0 - min(1.0, max(0.0, visual.transparency))
    if (r, g, b, a) == (0.5, 0.5, 0.5, 1.0):
        r = 0.5001  # MuJoCo interprets its exact default as "not given"
    return GeomColours((r, g, b, a), min(1.0, emission), min(1.0, specular), shininess, ambient)


def _relative_ambient(material: Material) -> float:
    """Return the brightness of the ambient colour relative to the diffuse colour.

    The result is 1 for a black or mostly emissive material.
    """
    diffuse = brightness(material.diffuse)
    if diffuse <= 0.0 or brightness(material.emissive) > diffuse:
        return 1.0
    return brightness(material.ambient) / diffuse


def _colour_and_emission(material: Material) -> tuple[Colour, float]:
    """Return the colour of a geom and its emission from 0 to 1.

    MuJoCo emits in the surface's own colour, so a mostly emissive material uses its emissive colour.
    """
    diffuse, glow = brightness(material.diffuse), brightness(material.emissive)
    if glow <= 0.0:
        return material.diffuse, 0.0
    if glow > diffuse:
        strongest = max(material.emissive[:3])
        r, g, b = (c / strongest for c in material.emissive[:3])
        return (r, g, b, material.diffuse[3]), strongest
    return material.diffuse, glow / diffuse


def brightness(colour: Colour) -> float:
    """Return the relative luminance of linear red, green and blue (Rec. 709)."""
    return 0.2126 * colour[0] + 0.7152 * colour[1] + 0.0722 * colour[2]
