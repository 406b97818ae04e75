"""Reader for Wavefront OBJ files with MTL materials; it returns one part for each group (`o`, `g`) and material.

trimesh's reader is not used, because it does not limit hostile files. It accepts vertices of two numbers and raises
IndexError for a missing vertex. It does not limit the number of faces and of referenced files.
"""

from __future__ import annotations

from dataclasses import dataclass, field

import numpy as np
import numpy.typing as npt

from simkit.loaders.meshes.companion_files import Companions, Pixels
from simkit.loaders.meshes.mesh_part import (
    LARGEST_FACES,
    Colour,
    Floats,
    MeshFileError,
    MeshPart,
    fan_triangles,
    integers_of,
    numbers_of,
    unique_rows,
)
from simkit.number_text import counted


@dataclass
class _MtlMaterial:
    """MTL material; `has_colour` is True if the file specifies the diffuse colour."""

    diffuse: tuple[float, float, float] = (1.0, 1.0, 1.0)
    has_colour: bool = False
    opacity: float = 1.0
    specular: float = 0.0
    emission: float = 0.0
    texture: str = ""


@dataclass
class _FaceGroup:
    """Faces of one group and material: texts of corners, and the number of corners of each face."""

    group: str
    material: str
    corners: list[bytes] = field(default_factory=list)
    counts: list[int] = field(default_factory=list)
    bases: list[tuple[int, int]] = field(default_factory=list)


def read_obj(content: bytes, companions: Companions) -> list[MeshPart]:
    """Return the parts of a file.

    Raises:
        MeshFileError: the file cannot be used.
    """
    content = content.replace(b"\\\r\n", b" ").replace(b"\\\n", b" ")
    positions: list[bytes] = []
    texcoords: list[bytes] = []
    blocks: dict[tuple[str, str], _FaceGroup] = {}
    libraries: list[str] = []
    group, material, faces = "", "", 0
    block: _FaceGroup | None = None
    for line in content.splitlines():
        if line.startswith(b"v "):  # fast path: most lines are vertices
            positions.append(line[2:])
            continue
        word, _, rest = line.strip().partition(b" ")
        if b"\t" in word:
            word, _, rest = line.strip().partition(b"\t")
        if word == b"v":
            positions.append(rest)
        elif word == b"vt":
            texcoords.append(rest)
        elif word == b"f":
            if block is None:
                block = blocks.setdefault((group, material), _FaceGroup(group, material))
            corners = rest.split(b"#")[0].split()
            block.corners += corners
            block.counts.append(len(corners))
            block.bases.append((len(positions), len(texcoords)) if b"-" in rest else (0, 0))
            faces += max(0, len(corners) - 2)
            if faces > LARGEST_FACES:
                raise MeshFileError(f"has more than {LARGEST_FACES} faces")
        elif word in (b"o", b"g"):
            group, block = rest.strip().decode("utf-8", "replace"), None
        elif word == b"usemtl":
            material, block = rest.strip().decode("utf-8", "replace"), None
        elif word == b"mtllib":
            libraries.append(rest.strip().decode("utf-8", "replace"))
    looks = _read_materials(libraries, companions) if any(m for _, m in blocks) else {}
    points = _rows(positions, 3, "vertices")
    uvs = _rows(texcoords, 2, "texture coordinates")
    parts = (_part(faces_of_material, points, uvs, looks, companions) for faces_of_material in blocks.values())
    return [part for part in parts if part is not None]


def _rows(lines: list[bytes], width: int, what: str) -> Floats:
    """Return the first `width` numbers of each line; colours or a weight may follow."""
    if not lines:
        return np.zeros((0, width))
    joined = b" ".join(lines)
    try:
        numbers = numbers_of(joined, what)
        columns = len(lines[0].split())
        if columns >= width and len(numbers) == columns * len(lines) and len(lines[-1].split()) == columns:
            return np.ascontiguousarray(numbers.reshape(-1, columns)[:, :width])
    except MeshFileError:
        pass
    rows = []
    for line in lines:
        words = line.split(b"#")[0].split()[:width]
        words += [b"0"] * (width - len(words)) if what == "texture coordinates" else []
        if len(words) != width:
            raise MeshFileError(f"has {what} with less than {counted(width, 'number')}")
        rows.append(words)
    return numbers_of(b" ".join(v for row in rows for v in row), what).reshape(-1, width)


def _part(
    block: _FaceGroup, points: Floats, uvs: Floats, looks: dict[str, _MtlMaterial], companions: Companions
) -> MeshPart | None:
    counts = np.array(block.counts, np.int64)
    at, at_uv = _indices(block, counts)
    triangles = fan_triangles(counts)
    if not len(triangles):
        return None
    if at.min() < 0 or at.max() >= len(points):
        bad = int(at[(at < 0) | (at >= len(points))][0]) + 1
        raise MeshFileError(f"has a face with vertex {bad}; there are {len(points)}")
    has_uv = bool(len(at_uv)) and bool((at_uv >= 0).all()) and int(at_uv.max()) < len(uvs)
    if has_uv:
        pairs, inverse = unique_rows(np.column_stack([at, at_uv]))
        uv: Floats | None = uvs[pairs[:, 1]]
    else:
        pairs, inverse = unique_rows(at[:, None])
        uv = None
    look = looks.get(block.material)
    if block.material and look is None and looks:
        companions.note(f"names the material {block.material!r}, which its library does not have")
    pixels: Pixels | None = None
    if look is not None and look.texture:
        pixels = companions.picture(look.texture) if uv is not None else None
    colour: Colour | None = None
    if look is not None and (look.has_colour or look.opacity < 1.0 or pixels is not None):
        colour = (*look.diffuse, look.opacity)
    return MeshPart(
        block.group,
        points[pairs[:, 0]],
        inverse[triangles].astype(np.int32),
        uv,
        colour,
        pixels,
        look.specular if look else 0.0,
        look.emission if look else 0.0,
    )


def _indices(block: _FaceGroup, counts: npt.NDArray[np.int64]) -> tuple[npt.NDArray[np.int64], npt.NDArray[np.int64]]:
    """Return the zero-based vertex indices and texture indices of all corners.

    The texture indices are empty if a corner has none.
    """
    plain = b" ".join(block.corners)
    slashes = block.corners[0].count(b"/") if block.corners else 0
    if not slashes and b"/" not in plain:
        at, at_uv = integers_of(plain, "faces"), np.zeros(0, np.int64)
    else:
        split = [corner.split(b"/") for corner in block.corners]
        at = integers_of(b" ".join(s[0] for s in split), "faces")
        with_uv = all(len(s) > 1 and s[1] for s in split)
        at_uv = integers_of(b" ".join(s[1] for s in split), "faces") if with_uv else np.zeros(0, np.int64)
    if len(at) != len(block.corners) or (len(at_uv) and len(at_uv) != len(at)):
        raise MeshFileError("has a face with an empty corner")
    if not len(at):
        return at, at_uv
    bases = np.repeat(np.array(block.bases, np.int64).reshape(-1, 2), counts, axis=0)
    # negative indices count from the end; 0 is invalid
    at = np.where(at > 0, at - 1, np.where(at < 0, bases[:, 0] + at, -1))
    if len(at_uv):
        at_uv = np.where(at_uv > 0, at_uv - 1, np.where(at_uv < 0, bases[:, 1] + at_uv, -1))
    return at, at_uv


def _read_materials(libraries: list[str], companions: Companions) -> dict[str, _MtlMaterial]:
    looks: dict[str, _MtlMaterial] = {}
    for line in dict.fromkeys(libraries):
        # a line may have several libraries, and a name may contain spaces
        for name in [line] if line.lower().count(".mtl") <= 1 else line.split():
            content = companions.content(name)
            if content is not None:
                _read_mtl(content, looks, companions)
    return looks


def _read_mtl(content: bytes, looks: dict[str, _MtlMaterial], companions: Companions) -> None:
    look = _MtlMaterial()
    for line in content.decode("utf-8", "replace").splitlines():
        word, _, rest = line.strip().replace("\t", " ").partition(" ")
        word, rest = word.lower(), rest.strip()
        if word == "newmtl":
            look = looks.setdefault(rest, _MtlMaterial())
        elif word in ("kd", "ks", "ke"):
            colour = _numbers(rest, 3)
            if colour is None:
                companions.note(f"has a material with {word.capitalize()} {rest[:40]!r}, which is not a colour")
            elif word == "kd":
                red, green, blue = colour
                look.diffuse, look.has_colour = (red, green, blue), True
            elif word == "ks":
                look.specular = max(colour)
            else:
                look.emission = 0.2126 * colour[0] + 0.7152 * colour[1] + 0.0722 * colour[2]
        elif word in ("d", "tr"):
            value = _numbers(rest.removeprefix("-halo"), 1)
            if value is not None:
                look.opacity = value[0] if word == "d" else 1.0 - value[0]
                # some exporters write inverse opacity, which would make the whole part invisible
                look.opacity = look.opacity if look.opacity > 0.01 else 1.0
        elif word == "map_kd":
            look.texture = _file_behind_options(rest)


def _numbers(text: str, count: int) -> tuple[float, ...] | None:
    """Return `count` numbers of a text, each clamped to 0..1; None if they are not numbers.

    If the text has fewer numbers, the last number is repeated.
    """
    try:
        numbers = [float(v) for v in text.split()[:count]]
    except ValueError:
        return None
    if not numbers or any(v != v for v in numbers):
        return None
    numbers += [numbers[-1]] * (count - len(numbers))
    return tuple(min(1.0, max(0.0, v)) for v in numbers)


def _file_behind_options(text: str) -> str:
    """Return the file name at the end of a `map_` line, after options such as `-s 1 1 1`."""
    words = text.split()
    while words and words[0].startswith("-") and len(words) > 1:
        words.pop(0)
        while len(words) > 1 and (_numbers(words[0], 1) is not None or words[0] in ("on", "off")):
            words.pop(0)
    return " ".join(words)
