"""Reader for COLLADA (`.dae`) with Gazebo's rules: the unit is applied, the up axis is ignored.

The result has one part for each node and material.
"""

from __future__ import annotations

import math
from functools import partial
from typing import Any, Final

import numpy as np
import numpy.typing as npt

from simkit.float_sum import float_sum
from simkit.linear_algebra import det, matmul
from simkit.loaders.meshes.collada_materials import ColladaMaterials, XmlElement
from simkit.loaders.meshes.companion_files import Companions
from simkit.loaders.meshes.mesh_part import (
    DEEPEST_NODE,
    LARGEST_FACES,
    MOST_NODES,
    Floats,
    Indices,
    Ints,
    MeshFileError,
    MeshPart,
    fan_triangles,
    integers_of,
    numbers_of,
    unique_rows,
)
from simkit.number_text import counted

_DEEPEST: Final = 500  # levels of XML elements; a node has one level, its geometry has a few
_PRIMITIVES: Final = ("triangles", "polylist", "polygons", "tristrips", "trifans")


def read_collada(content: bytes, companions: Companions) -> list[MeshPart]:
    """Return the parts of the file's scene, in metres.

    Raises:
        MeshFileError: the file cannot be used.
    """
    return ColladaFile(read_root(content), companions).parts()


def read_root(content: bytes) -> XmlElement:
    """Return the root element of a document without entities.

    No other file is read, and no entity is expanded.
    """
    from lxml import etree

    kind = partial(
        etree.XMLParser,
        resolve_entities=False,
        no_network=True,
        load_dtd=False,
        huge_tree=True,
        recover=True,
        remove_comments=True,
    )
    target: Any = _BoundedTreeBuilder()  # the stubs require more callbacks than lxml
    try:
        etree.fromstring(content, kind(target=target))
        root = etree.fromstring(content, kind())
    except (etree.XMLSyntaxError, ValueError) as problem:
        raise MeshFileError(f"is not readable as XML: {problem}") from None
    if root is None or not isinstance(root.tag, str):
        raise MeshFileError("is not readable as XML")
    if etree.QName(root).localname != "COLLADA":
        raise MeshFileError(f"begins with <{etree.QName(root).localname}>; a COLLADA file begins with <COLLADA>")
    return root


class _BoundedTreeBuilder:
    """Parser target that stores nothing and refuses documents with entities or with too deeply nested elements.

    lxml's own limits depend on the libxml2 that a process loads first. Some GL libraries load an old version without a
    limit for levels. Reading a million levels then takes hours.
    """

    def __init__(self) -> None:
        self._level = 0

    def doctype(self, name: str, public: str | None, system: str | None) -> None:
        raise MeshFileError("has a document type definition, which is refused")

    def start(self, tag: str | bytes, attrib: object) -> None:
        self._level += 1
        if self._level > _DEEPEST:
            raise MeshFileError(f"has elements that are nested more than {_DEEPEST} deep")

    def end(self, tag: str | bytes) -> None:
        self._level -= 1

    def close(self) -> None:
        """Return nothing."""


class ColladaFile:
    """COLLADA document: elements by id, and their converted content."""

    def __init__(self, root: XmlElement, companions: Companions) -> None:
        self.root, self.companions = root, companions
        self.by_id: dict[str, XmlElement] = {}
        for element in root.iter("{*}*"):
            name = element.get("id")
            if name:
                self.by_id.setdefault(name, element)
        self.looks = ColladaMaterials(self.by_id, companions)
        self.arrays: dict[XmlElement, Floats] = {}
        self.geometries: dict[str, list[tuple[MeshPart, str]]] = {}
        self.out: list[MeshPart] = []
        self.faces = self.nodes = 0

    def parts(self) -> list[MeshPart]:
        unit = self._unit()
        scenes = [self._target(e) for e in self.root.iterfind("{*}scene/{*}instance_visual_scene")]
        scenes = [s for s in scenes if s is not None] or list(self.root.iterfind(".//{*}visual_scene"))[:1]
        for scene in scenes:
            for node in scene.iterfind("{*}node"):
                self._node(node, np.diag([unit, unit, unit, 1.0]), "", 0)
        return self.out

    def _unit(self) -> float:
        for element in self.root.iterfind("{*}asset/{*}unit"):
            try:
                metres = float(element.get("meter", "1"))
            except ValueError:
                break
            if math.isfinite(metres) and metres > 0.0:
                return metres
            break
        return 1.0

    def _target(self, element: XmlElement, attribute: str = "url") -> XmlElement:
        return self.by_id.get(element.get(attribute, "").lstrip("#"))

    # ------------------------------------------------------------------ nodes

    def _node(self, node: XmlElement, above: Floats, named: str, depth: int) -> None:
        self.nodes += 1
        if depth > DEEPEST_NODE or self.nodes > MOST_NODES:
            raise MeshFileError(f"has nodes nested deeper than {DEEPEST_NODE} or more than {MOST_NODES} of them")
        name = node.get("name") or named
        matrix = matmul(above, node_transform(node))
        for child in node.iterfind("{*}node"):
            self._node(child, matrix, name, depth + 1)
        for instance in node.iterfind("{*}instance_node"):
            target = self._target(instance)
            if target is not None:
                self._node(target, matrix, name, depth + 1)
        for instance in node.iterfind("{*}instance_geometry"):
            self._place(self._target(instance), instance, node, name, matrix)
        for instance in node.iterfind("{*}instance_controller"):
            self._place(self._skinned(self._target(instance)), instance, node, name, matrix)

    def _skinned(self, controller: XmlElement | None) -> XmlElement:
        """Return the geometry that skins and morphs deform, in its bind pose."""
        for _ in range(8):
            if controller is None or not controller.tag.endswith("controller"):
                return controller
            source = controller.find("{*}skin")
            source = controller.find("{*}morph") if source is None else source
            controller = None if source is None else self._target(source, "source")
        return None

    def _place(self, geometry: XmlElement, instance: XmlElement, node: XmlElement, name: str, matrix: Floats) -> None:
        if geometry is None:
            self.companions.note(f"refers to {instance.get('url', '')[:80]!r}; it has no such element")
            return
        bound = {
            e.get("symbol", ""): e.get("target", "").lstrip("#")
            for e in instance.iterfind("{*}bind_material/{*}technique_common/{*}instance_material")
        }
        mirrored = float(det(matrix[:3, :3])) < 0.0
        names = (node.get("id"), node.get("name"), geometry.get("id"), geometry.get("name"))
        aliases = tuple(n for n in dict.fromkeys(names) if n and n != name)
        for part, symbol in self._geometry(geometry):
            self.faces += len(part.faces)
            if self.faces > LARGEST_FACES:
                raise MeshFileError(f"has more than {LARGEST_FACES} faces")
            look = self.looks.of(bound.get(symbol, symbol))
            faces = np.ascontiguousarray(part.faces[:, ::-1]) if mirrored else part.faces
            texture = look.texture if part.uv is not None else None
            self.out.append(
                MeshPart(
                    name or part.name,
                    matmul(part.vertices, matrix[:3, :3].T) + matrix[:3, 3],
                    faces,
                    part.uv,
                    look.colour,
                    texture,
                    look.specular,
                    look.emission,
                    aliases,
                )
            )

    # ------------------------------------------------------------------ geometry

    def _geometry(self, geometry: XmlElement) -> list[tuple[MeshPart, str]]:
        """Return the parts of a `<geometry>` in its own frame, each with the symbol of its material."""
        key = geometry.get("id", "") or str(id(geometry))
        if key not in self.geometries:
            mesh = geometry.find("{*}mesh")
            primitives = [] if mesh is None else [self._primitives(e) for e in mesh if _local(e) in _PRIMITIVES]
            name = geometry.get("name") or geometry.get("id") or ""
            self.geometries[key] = [(MeshPart(name, *mesh_arrays), s) for mesh_arrays, s in filter(None, primitives)]
        return self.geometries[key]

    def _primitives(self, element: XmlElement) -> tuple[tuple[Floats, Ints, Floats | None], str] | None:
        """Return vertices, faces and texture coordinates of a list of primitives, and the symbol of its material."""
        inputs = [
            (e.get("semantic"), e, _whole(e, "offset", 0), _whole(e, "set", 0)) for e in element.iterfind("{*}input")
        ]
        if not inputs:
            return None
        width = 1 + max(offset for _, _, offset, _ in inputs)
        corners, triangles = _corners(element, width)
        if not len(triangles):
            return None
        vertex = next(((e, offset) for s, e, offset, _ in inputs if s == "VERTEX"), None)
        if vertex is None:
            raise MeshFileError(f"has <{_local(element)}> without vertices")
        points = self._positions(self._target(vertex[0], "source"))
        at = corners[:, vertex[1]]
        if len(at) and (at.min() < 0 or at.max() >= len(points)):
            raise MeshFileError(f"has a face with vertex {int(at.max())}; there are {len(points)}")
        coordinates = sorted((k, offset, e) for s, e, offset, k in inputs if s == "TEXCOORD")[:1]
        uv = None
        for _, offset, e in coordinates:
            of_uv = self._source(self._target(e, "source"))
            at_uv = corners[:, offset]
            if of_uv.shape[1] >= 2 and len(of_uv) and at_uv.min() >= 0 and at_uv.max() < len(of_uv):
                pairs, inverse = unique_rows(np.column_stack([at, at_uv]))
                uv = of_uv[pairs[:, 1], :2]
        if uv is None:
            pairs, inverse = unique_rows(at[:, None])
        faces = inverse[triangles].astype(np.int32)
        return (points[pairs[:, 0]], faces, uv), element.get("material", "")

    def _positions(self, vertices: XmlElement) -> Floats:
        if vertices is not None:
            for entry in vertices.iterfind("{*}input"):
                if entry.get("semantic") == "POSITION":
                    positions = self._source(self._target(entry, "source"))
                    if positions.shape[1] >= 3:
                        return positions[:, :3]
        raise MeshFileError("has faces without vertex positions")

    def _source(self, source: XmlElement) -> Floats:
        """Return the rows of a `<source>`, as its accessor defines them."""
        if source is None:
            raise MeshFileError("refers to a source that it does not have")
        if source not in self.arrays:
            array = source.find("{*}float_array")
            if array is None:
                raise MeshFileError("has a source without numbers")
            numbers = numbers_of(array.text or "", "coordinates")
            accessor = source.find("{*}technique_common/{*}accessor")
            stride = 3 if accessor is None else _whole(accessor, "stride", 1)
            offset = 0 if accessor is None else _whole(accessor, "offset", 0)
            if not 0 < stride <= 64 or not 0 <= offset <= len(numbers):
                raise MeshFileError("has a source with an impossible stride")
            rows = (len(numbers) - offset) // stride
            self.arrays[source] = numbers[offset : offset + rows * stride].reshape(rows, stride)
        return self.arrays[source]


def _corners(element: XmlElement, width: int) -> tuple[Indices, Indices]:
    """Return the indices of all corners, shape (c, width), and triangles as row numbers of these corners."""
    kind = _local(element)
    lists = [integers_of(p.text or "", "faces") for p in element.iterfind("{*}p")]
    lists += [integers_of(p.text or "", "faces") for p in element.iterfind("{*}ph/{*}p")]
    lists = [p[: len(p) // width * width].reshape(-1, width) for p in lists]
    if not lists:
        return np.zeros((0, width), np.int64), np.zeros((0, 3), np.int64)
    counts = np.array([len(p) for p in lists], np.int64)
    corners = np.concatenate(lists)
    if kind == "polygons" or kind == "trifans":
        return corners, fan_triangles(counts)
    if kind == "tristrips":
        return corners, strip_triangles(counts)
    if kind == "polylist":
        listed = element.find("{*}vcount")
        counts = integers_of("" if listed is None else listed.text or "", "polygon sizes")
        if len(counts) and (counts.min() < 0 or int(counts.sum()) > len(corners)):
            raise MeshFileError("declares more corners than it has")
        return corners, fan_triangles(counts)
    triangles = len(corners) // 3
    return corners, np.arange(3 * triangles).reshape(-1, 3)


def strip_triangles(counts: npt.ArrayLike) -> Indices:
    """Return the triangles of consecutive strips; every second triangle is reversed."""
    out, start = [], 0
    for count in np.asarray(counts).tolist():
        i = start + np.arange(max(0, count - 2))
        odd = (i - start) % 2
        out.append(np.column_stack([i, i + 1 + odd, i + 2 - odd]))
        start += count
    return np.concatenate(out) if out else np.zeros((0, 3), np.int64)


def node_transform(node: XmlElement) -> Floats:
    """Return a node's transform by Gazebo's rules: its matrix, or else translation, rotation and scale."""
    matrix_element = node.find("{*}matrix")
    if matrix_element is not None:
        return _exact_count(matrix_element, 16).reshape(4, 4)
    matrix = np.eye(4)
    move = node.find("{*}translate")
    if move is not None:
        matrix[:3, 3] = _exact_count(move, 3)
    for turn in node.iterfind("{*}rotate"):
        x, y, z, degrees = _exact_count(turn, 4)
        matrix = matmul(matrix, _rotation((x, y, z), math.radians(degrees)))
    stretch = node.find("{*}scale")
    if stretch is not None:
        matrix = matmul(matrix, np.diag([*_exact_count(stretch, 3), 1.0]))
    return matrix


def _rotation(axis: tuple[float, float, float], angle: float) -> Floats:
    """Return a rotation matrix by Rodrigues' formula."""
    length = math.sqrt(float_sum(c * c for c in axis))
    matrix = np.eye(4)
    if length > 0.0 and math.isfinite(angle):
        x, y, z = (c / length for c in axis)
        cross = np.array(((0.0, -z, y), (z, 0.0, -x), (-y, x, 0.0)))
        matrix[:3, :3] += math.sin(angle) * cross + (1.0 - math.cos(angle)) * matmul(cross, cross)
    return matrix


def _exact_count(element: XmlElement, count: int) -> Floats:
    numbers = numbers_of(element.text or "", f"<{_local(element)}>")
    if len(numbers) != count or not np.isfinite(numbers).all():
        raise MeshFileError(f"has <{_local(element)}> with {counted(len(numbers), 'number')}, it needs {count}")
    return numbers


def _whole(element: XmlElement, name: str, default: int) -> int:
    try:
        value = int(element.get(name, default))
    except ValueError:
        value = -1
    if not 0 <= value <= 1_000_000:
        raise MeshFileError(f"has {name}={element.get(name)[:40]!r} in <{_local(element)}>")
    return value


def _local(element: XmlElement) -> str:
    return str(element.tag).rpartition("}")[2]
