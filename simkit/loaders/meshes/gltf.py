"""Reader for glTF 2.0 (`.gltf`, `.glb`) with Gazebo's rules: node transforms are applied, the file's axes stay.

Gazebo passes the file to assimp, which does not rotate glTF's y axis to z, and keeps the root node's transform. A model
made for Gazebo therefore has `<pose>0 0 0 1.5708 0 0</pose>`. An additional rotation here would be wrong.
"""

from __future__ import annotations

import base64
import binascii
from typing import TYPE_CHECKING, Final

import numpy as np
import numpy.typing as npt

from simkit.json_reader import parse_json
from simkit.linear_algebra import det, matmul
from simkit.loaders.meshes.collada import strip_triangles
from simkit.loaders.meshes.companion_files import LARGEST_COMPANION, Companions, Pixels
from simkit.loaders.meshes.mesh_part import (
    DEEPEST_NODE,
    LARGEST_FACES,
    MOST_NODES,
    Colour,
    Floats,
    MeshFileError,
    MeshPart,
    fan_triangles,
)
from simkit.number_text import counted

if TYPE_CHECKING:
    from simkit.run_spec import JsonObject


_TYPES: Final = {"SCALAR": 1, "VEC2": 2, "VEC3": 3, "VEC4": 4, "MAT2": 4, "MAT3": 9, "MAT4": 16}
_NUMBERS: Final = {5120: "<i1", 5121: "<u1", 5122: "<i2", 5123: "<u2", 5125: "<u4", 5126: "<f4"}
_CANNOT: Final = ("KHR_draco_mesh_compression", "EXT_meshopt_compression", "KHR_mesh_quantization")


def read_gltf(content: bytes, companions: Companions) -> list[MeshPart]:
    """Return the parts of the file's scene, one for each node and material.

    Raises:
        MeshFileError: the file cannot be used.
    """
    document, binary = _chunks(content) if content[:4] == b"glTF" else (content, None)
    try:
        tree = parse_json(document.decode("utf-8-sig"))
    except ValueError as problem:
        raise MeshFileError(f"is not readable JSON: {problem}") from None
    if not isinstance(tree, dict):
        raise MeshFileError("is not a glTF document")
    version = str((tree.get("asset") or {}).get("version", "2.0")) if isinstance(tree.get("asset"), dict) else "2.0"
    if not version.startswith("2"):
        raise MeshFileError(f"is glTF {version[:20]}; only glTF 2.0 is supported")
    required = [e for e in tree.get("extensionsRequired") or [] if e in _CANNOT[:2]]
    if required:
        raise MeshFileError(f"needs {', '.join(required)}, which is not supported; save it without compression")
    try:
        return _Gltf(tree, binary, companions).parts()
    except (KeyError, IndexError, TypeError, ValueError, AttributeError, OverflowError) as problem:
        raise MeshFileError(f"is not a valid glTF document ({type(problem).__name__}: {problem})") from None


def _chunks(content: bytes) -> tuple[bytes, bytes | None]:
    """Return the JSON and the binary chunk of a `.glb` container."""
    at, document, binary = 12, b"", None
    while at + 8 <= len(content):
        length = int.from_bytes(content[at : at + 4], "little")
        kind = content[at + 4 : at + 8]
        chunk = content[at + 8 : at + 8 + length]
        if len(chunk) < length:
            raise MeshFileError("is cut short")
        if kind == b"JSON" and not document:
            document = chunk
        elif kind == b"BIN\0" and binary is None:
            binary = chunk
        at += 8 + length + (-length) % 4
    return document, binary


MeshArrays = tuple[Floats, npt.NDArray[np.int32], Floats | None]
"""Vertices [m], triangles and texture coordinates, None if there are none."""


class _Gltf:
    """glTF document with its buffers."""

    def __init__(self, tree: JsonObject, binary: bytes | None, companions: Companions) -> None:
        self.tree, self.binary, self.companions = tree, binary, companions
        self.buffers: dict[int, bytes] = {}
        self.meshes: dict[int, list[tuple[MeshPart, int | None]]] = {}
        self.looks: dict[int | None, tuple[Colour | None, Pixels | None, float, float]] = {}
        self.out: list[MeshPart] = []
        self.nodes = self.faces = 0

    def parts(self) -> list[MeshPart]:
        scenes = self.tree.get("scenes") or []
        nodes = self.tree.get("nodes") or []
        if scenes:
            roots = _entry(scenes, self.tree.get("scene", 0)).get("nodes") or []
        else:
            below = {child for node in nodes for child in node.get("children") or []}
            roots = [i for i in range(len(nodes)) if i not in below]
        for root in roots:
            self._node(root, np.eye(4), "", 0)
        return self.out

    def _node(self, index: int, above: Floats, named: str, depth: int) -> None:
        self.nodes += 1
        if depth > DEEPEST_NODE or self.nodes > MOST_NODES:
            raise MeshFileError(f"has nodes nested deeper than {DEEPEST_NODE} or more than {MOST_NODES} of them")
        node = _entry(self.tree["nodes"], index)
        name = str(node.get("name") or named)
        matrix = matmul(above, _transform(node))
        if node.get("mesh") is not None:
            self._place(node["mesh"], name, matrix)
        for child in node.get("children") or []:
            self._node(child, matrix, name, depth + 1)

    def _place(self, index: int, name: str, matrix: Floats) -> None:
        if index not in self.meshes:
            mesh = _entry(self.tree["meshes"], index)
            primitives = [self._primitive(p) for p in mesh.get("primitives") or []]
            self.meshes[index] = [(MeshPart(str(mesh.get("name", "")), *a), m) for a, m in filter(None, primitives)]
        mirrored = float(det(matrix[:3, :3])) < 0.0
        for part, material in self.meshes[index]:
            self.faces += len(part.faces)
            if self.faces > LARGEST_FACES:
                raise MeshFileError(f"has more than {LARGEST_FACES} faces")
            colour, texture, specular, emission = self._look(material)
            uv = self._flipped_uv(part.uv, material)
            self.out.append(
                MeshPart(
                    name or part.name,
                    matmul(part.vertices, matrix[:3, :3].T) + matrix[:3, 3],
                    np.ascontiguousarray(part.faces[:, ::-1]) if mirrored else part.faces,
                    uv,
                    colour,
                    texture if uv is not None else None,
                    specular,
                    emission,
                    (part.name,) if part.name and part.name != name else (),
                )
            )

    # ------------------------------------------------------------------ numbers

    def _primitive(self, primitive: JsonObject) -> tuple[MeshArrays, int | None] | None:
        mode = primitive.get("mode", 4)
        attributes = primitive["attributes"]
        if mode not in (4, 5, 6) or "POSITION" not in attributes:
            return None
        if "KHR_draco_mesh_compression" in (primitive.get("extensions") or {}):
            raise MeshFileError("is compressed with Draco, which is not supported; save it without compression")
        points = self._accessor(attributes["POSITION"]).astype(float)
        if points.shape[1] != 3:
            raise MeshFileError("has positions that are not three numbers each")
        if primitive.get("indices") is not None:
            order = self._accessor(primitive["indices"]).reshape(-1).astype(np.int64)
        else:
            order = np.arange(len(points))
        if len(order) and int(order.max()) >= len(points):
            raise MeshFileError(f"has a face with vertex {int(order.max())}; there are {len(points)}")
        count = np.array([len(order)])
        loose = np.arange(len(order) // 3 * 3).reshape(-1, 3)
        faces = order[strip_triangles(count) if mode == 5 else fan_triangles(count) if mode == 6 else loose].astype(
            np.int32
        )
        material = primitive.get("material")
        where = self._base_texture(material).get("texCoord", 0)
        uv = None
        if f"TEXCOORD_{where}" in attributes:
            coordinates = self._accessor(attributes[f"TEXCOORD_{where}"]).astype(float)
            uv = coordinates[:, :2] if len(coordinates) == len(points) and coordinates.shape[1] >= 2 else None
        return ((points, faces, uv), material) if len(faces) else None

    def _accessor(self, index: int) -> npt.NDArray[np.number]:
        accessor = _entry(self.tree["accessors"], index)
        width, kind = _TYPES[accessor["type"]], np.dtype(_NUMBERS[accessor["componentType"]])
        count = int(accessor["count"])
        if not 0 <= count <= 3 * LARGEST_FACES:
            raise MeshFileError(f"has an accessor of {counted(count, 'element')}")
        if accessor.get("bufferView") is None:
            rows = np.zeros((count, width), kind)
        else:
            rows = self._view(accessor["bufferView"], int(accessor.get("byteOffset", 0)), count, width, kind)
        sparse = accessor.get("sparse")
        if sparse:
            few = int(sparse["count"])
            at, values = sparse["indices"], sparse["values"]
            index_type = np.dtype(_NUMBERS[at["componentType"]])
            which = self._view(at["bufferView"], int(at.get("byteOffset", 0)), few, 1, index_type).reshape(-1)
            rows = rows.copy()
            rows[which] = self._view(values["bufferView"], int(values.get("byteOffset", 0)), few, width, kind)
        if accessor.get("normalized") and kind.kind in "iu":
            return np.maximum(rows.astype(float) / np.iinfo(kind).max, -1.0)
        return rows

    def _view(
        self, index: int, offset: int, count: int, width: int, kind: np.dtype[np.number]
    ) -> npt.NDArray[np.number]:
        view = _entry(self.tree["bufferViews"], index)
        data = self._buffer(view["buffer"])
        start = int(view.get("byteOffset", 0)) + offset
        size = width * kind.itemsize
        stride = int(view.get("byteStride") or size)
        end = int(view.get("byteOffset", 0)) + int(view["byteLength"])
        if (
            min(start, offset, count) < 0
            or stride < size
            or (count and start + stride * (count - 1) + size > min(end, len(data)))
        ):
            raise MeshFileError("has numbers outside of its buffer")
        if not count:
            return np.zeros((0, width), kind)
        return np.ndarray((count, width), kind, data, start, (stride, kind.itemsize))

    def _buffer(self, index: int) -> bytes:
        if index not in self.buffers:
            uri = _entry(self.tree["buffers"], index).get("uri")
            content = self.binary if uri is None else self._bytes(str(uri))
            if content is None:
                raise MeshFileError("has a buffer that cannot be read: " + "; ".join(self.companions.notes[-1:]))
            self.buffers[index] = content
        return self.buffers[index]

    def _bytes(self, uri: str) -> bytes | None:
        if not uri.startswith("data:"):
            return self.companions.content(uri)
        head, _, body = uri.partition(",")
        if not head.endswith(";base64") or len(body) > 2 * LARGEST_COMPANION:
            self.companions.note("has a data URI that is not base64")
            return None
        try:
            return base64.b64decode(body)
        except (binascii.Error, ValueError):
            self.companions.note("has a data URI that is not base64")
            return None

    # ------------------------------------------------------------------ materials and textures

    def _material(self, index: int | None) -> JsonObject:
        return {} if index is None else _entry(self.tree.get("materials") or [], index)

    def _base_texture(self, index: int | None) -> JsonObject:
        texture = (self._material(index).get("pbrMetallicRoughness") or {}).get("baseColorTexture") or {}
        return texture if isinstance(texture, dict) else {}

    def _look(self, index: int | None) -> tuple[Colour | None, Pixels | None, float, float]:
        if index is None:
            return None, None, 0.0, 0.0
        if index not in self.looks:
            material = self._material(index)
            base = material.get("pbrMetallicRoughness") or {}
            r, g, b, a = (min(1.0, max(0.0, float(v))) for v in base.get("baseColorFactor") or (1.0, 1.0, 1.0, 1.0))
            opacity = a if material.get("alphaMode", "OPAQUE") == "BLEND" and a > 0.01 else 1.0
            texture = self._base_texture(index)
            pixels = self._picture(texture["index"]) if texture.get("index") is not None else None
            red, green, blue = (float(v) for v in material.get("emissiveFactor") or (0.0, 0.0, 0.0))
            bright = 0.0 if material.get("emissiveTexture") else 0.2126 * red + 0.7152 * green + 0.0722 * blue
            specular = 0.5 * max(0.0, 1.0 - float(base.get("roughnessFactor", 1.0)))
            self.looks[index] = ((r, g, b, opacity), pixels, specular, min(1.0, max(0.0, bright)))
        return self.looks[index]

    def _picture(self, index: int) -> Pixels | None:
        texture = _entry(self.tree.get("textures") or [], index)
        source = texture.get("source")
        if source is None:
            for extension in (texture.get("extensions") or {}).values():
                source = extension.get("source", source)
        if source is None:
            return None
        image = _entry(self.tree.get("images") or [], source)
        name = str(image.get("name") or f"image {source}")
        if image.get("bufferView") is not None:
            view = _entry(self.tree["bufferViews"], image["bufferView"])
            start, length = int(view.get("byteOffset", 0)), int(view["byteLength"])
            data = self._buffer(view["buffer"])
            return self.companions.picture_in(data[max(0, start) : max(0, start) + length], name)
        uri = str(image.get("uri", ""))
        if uri.startswith("data:"):
            content = self._bytes(uri)
            return None if content is None else self.companions.picture_in(content, name)
        return self.companions.picture(uri)

    def _flipped_uv(self, uv: Floats | None, material: int | None) -> Floats | None:
        """Return texture coordinates with v upwards, with KHR_texture_transform applied. In glTF, v points down."""
        if uv is None:
            return None
        change = (self._base_texture(material).get("extensions") or {}).get("KHR_texture_transform")
        if change:
            angle = float(change.get("rotation", 0.0))
            c, s = np.cos(angle), np.sin(angle)
            uv = matmul(uv * np.asarray(change.get("scale", (1.0, 1.0)), float), np.array(((c, -s), (s, c))))
            uv = uv + np.asarray(change.get("offset", (0.0, 0.0)), float)
        return np.column_stack([uv[:, 0], 1.0 - uv[:, 1]])


def _entry(items: object, index: int | None) -> JsonObject:
    if (
        not isinstance(items, list)
        or isinstance(index, bool)
        or not isinstance(index, int)
        or not 0 <= index < len(items)
    ):
        raise MeshFileError(f"refers to an entry {str(index)[:20]}, which is missing")
    entry = items[index]
    if not isinstance(entry, dict):
        raise MeshFileError("has an entry that is not an object")
    return entry


def _transform(node: JsonObject) -> Floats:
    if node.get("matrix") is not None:
        return _finite(node["matrix"], 16).reshape(4, 4).T
    matrix = np.eye(4)
    x, y, z, w = _finite(node.get("rotation", (0.0, 0.0, 0.0, 1.0)), 4)
    length = float(np.sqrt(x * x + y * y + z * z + w * w))
    if length > 0.0:
        x, y, z, w = (c / length for c in (x, y, z, w))
        matrix[:3, :3] = (
            (1 - 2 * (y * y + z * z), 2 * (x * y - z * w), 2 * (x * z + y * w)),
            (2 * (x * y + z * w), 1 - 2 * (x * x + z * z), 2 * (y * z - x * w)),
            (2 * (x * z - y * w), 2 * (y * z + x * w), 1 - 2 * (x * x + y * y)),
        )
    matrix[:3, :3] *= _finite(node.get("scale", (1.0, 1.0, 1.0)), 3)
    matrix[:3, 3] = _finite(node.get("translation", (0.0, 0.0, 0.0)), 3)
    return matrix


def _finite(values: npt.ArrayLike, count: int) -> Floats:
    numbers = np.asarray(values, float).reshape(-1)
    if len(numbers) != count or not np.isfinite(numbers).all():
        raise MeshFileError(f"has a node whose transform is not {counted(count, 'number')}")
    return numbers
