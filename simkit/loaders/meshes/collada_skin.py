"""Skins of COLLADA files: the faces that move with each bone of a skeleton, and the motion of the bones.

A vertex moves with the bone that has the largest weight at this vertex. A face moves with every bone of its corners, so
that no gaps open at a bent joint. A bone with almost no faces (of a finger) passes them to its parent bone.
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import lru_cache
from pathlib import Path
from typing import Final

import numpy as np

from simkit.input_file import read_input
from simkit.linear_algebra import matmul
from simkit.loaders.meshes.collada import ColladaFile, node_transform, read_root
from simkit.loaders.meshes.collada_materials import XmlElement
from simkit.loaders.meshes.companion_files import Companions
from simkit.loaders.meshes.mesh_part import (
    DEEPEST_NODE,
    LARGEST_FILE,
    MOST_NODES,
    Floats,
    Indices,
    MeshFileError,
    MeshPart,
    integers_of,
)

_LEAST_FRACTION: Final = 0.012
"""Least fraction of all vertices for a bone; a smaller bone passes its vertices to its parent bone."""

_MOST_FRAMES: Final = 20_000


@dataclass(frozen=True, eq=False)
class Bone:
    """Joint of the skeleton.

    Attributes:
        name: name of the node.
        words: name, sid and id of the node, as far as the file has them.
        parent: index of the parent in the list of bones, or -1.
        rest: transform in the parent's frame, shape (4, 4), in the file's unit.
    """

    name: str
    words: frozenset[str]
    parent: int
    rest: Floats


@dataclass(frozen=True, eq=False)
class Skin:
    """Skeleton with its mesh pieces and its animation.

    Attributes:
        bones: bones, parents first.
        pieces: mesh parts in the bone's frame and in the file's unit, by index in `bones`.
        times: times of the animation's frames [s], shape (f,); empty without animation.
        frames: transforms of the moving bones, each of shape (f, 4, 4), by index in `bones`.
        unit: length of the file's unit [m].
        notes: one sentence for each part that cannot be read.
    """

    bones: tuple[Bone, ...]
    pieces: dict[int, tuple[MeshPart, ...]]
    times: Floats
    frames: dict[int, Floats]
    unit: float
    notes: tuple[str, ...] = ()


def read_skin(file: Path) -> Skin:
    """Read the skeleton, its mesh pieces and its animation from a COLLADA file.

    Raises:
        MeshFileError: the file cannot be used.
    """
    try:
        stat = file.stat()
    except (OSError, ValueError) as problem:
        raise MeshFileError(f"cannot be read: {getattr(problem, 'strerror', problem)}") from None
    if file.suffix.lower() != ".dae":
        raise MeshFileError(f"is a {file.suffix or 'nameless'} file; skins and animations are read from .dae")
    if not file.is_file() or stat.st_size > LARGEST_FILE:
        raise MeshFileError("is not a file, or too large")
    return _read(file, (stat.st_mtime_ns, stat.st_size))


def bone_parts(file: Path, bone: str) -> list[MeshPart]:
    """Return the mesh parts of one bone, in its own frame and in the file's unit.

    Raises:
        MeshFileError: the file cannot be used, or no face moves with the bone.
    """
    skin = read_skin(file)
    for place, parts in skin.pieces.items():
        if skin.bones[place].name == bone:
            return list(parts)
    raise MeshFileError(f"has no bone {bone!r} that carries anything")


@lru_cache(maxsize=16)
def _read(file: Path, _version: tuple[int, int]) -> Skin:
    try:
        return _SkinFile(read_root(read_input(file, LARGEST_FILE)), Companions(file)).skin()
    except MeshFileError:
        raise
    except OSError as problem:
        raise MeshFileError(f"cannot be read: {problem.strerror}") from None
    except (ValueError, IndexError, KeyError, TypeError, AttributeError, RecursionError) as problem:
        raise MeshFileError(f"is not a readable skin: {' '.join(str(problem).split())[:200]}") from None


class _SkinFile(ColladaFile):
    def skin(self) -> Skin:
        self.bones: list[Bone] = []
        self.of_node: dict[XmlElement, int] = {}
        scenes = [self._target(e) for e in self.root.iterfind("{*}scene/{*}instance_visual_scene")]
        scenes = [s for s in scenes if s is not None] or list(self.root.iterfind(".//{*}visual_scene"))[:1]
        for scene in scenes:
            for node in scene.iterfind("{*}node"):
                self._skeleton(node, np.eye(4), -1, 0)
        if not self.bones:
            raise MeshFileError("has no skeleton")
        times, frames = self._animation()
        return Skin(tuple(self.bones), self._pieces(), times, frames, self._unit(), tuple(self.companions.notes))

    def _skeleton(self, node: XmlElement, above: Floats, parent: int, depth: int) -> None:
        self.nodes += 1
        if depth > DEEPEST_NODE or self.nodes > MOST_NODES:
            raise MeshFileError("has too many nodes, or nodes nested too deeply")
        matrix = node_transform(node)
        if node.get("type") == "JOINT":
            words = [w for w in (node.get("name"), node.get("sid"), node.get("id")) if w]
            self.of_node[node] = len(self.bones)
            self.bones.append(Bone(words[0] if words else "", frozenset(words), parent, matmul(above, matrix)))
            above, parent = np.eye(4), len(self.bones) - 1
        else:
            above = matmul(above, matrix)
        for child in node.iterfind("{*}node"):
            self._skeleton(child, above, parent, depth + 1)

    # ------------------------------------------------------------------ mesh pieces of the bones

    def _pieces(self) -> dict[int, tuple[MeshPart, ...]]:
        pieces: dict[int, list[MeshPart]] = {}
        for instance in self.root.iterfind(".//{*}instance_controller"):
            controller = self._target(instance)
            skin = None if controller is None else controller.find("{*}skin")
            geometry = None if skin is None else self._target(skin, "source")
            if geometry is not None and geometry.tag.endswith("geometry"):
                self._bind_geometry(skin, geometry, instance, pieces)
        return {bone: tuple(parts) for bone, parts in pieces.items()}

    def _bind_geometry(
        self, skin: XmlElement, geometry: XmlElement, instance: XmlElement, found: dict[int, list[MeshPart]]
    ) -> None:
        bones, inverses, vertex_joints = self._vertex_bones(skin)
        shape = skin.find("{*}bind_shape_matrix")
        bind = np.eye(4) if shape is None else np.array([float(v) for v in shape.text.split()]).reshape(4, 4)
        bound = {
            e.get("symbol", ""): e.get("target", "").lstrip("#")
            for e in instance.iterfind("{*}bind_material/{*}technique_common/{*}instance_material")
        }
        mesh = geometry.find("{*}mesh")
        vertices = self._positions(None if mesh is None else mesh.find("{*}vertices"))
        at = {row.tobytes(): i for i, row in reversed(list(enumerate(np.ascontiguousarray(vertices))))}
        for part, symbol in self._geometry(geometry):
            of = np.array([at[row.tobytes()] for row in np.ascontiguousarray(part.vertices)])
            joint_of_vertex = vertex_joints[of]
            look = self.looks.of(bound.get(symbol, symbol))
            for local in sorted(set(joint_of_vertex.tolist())):
                mine = (joint_of_vertex[part.faces] == local).any(axis=1)
                used, faces = np.unique(part.faces[mine], return_inverse=True)
                matrix = matmul(inverses[local], bind)
                points = matmul(part.vertices[used], matrix[:3, :3].T) + matrix[:3, 3]
                uv = None if part.uv is None else part.uv[used]
                piece = MeshPart(
                    part.name, points, faces.reshape(-1, 3).astype(np.int32), uv, look.colour,
                    look.texture if uv is not None else None, look.specular, look.emission,
                )  # fmt: skip
                found.setdefault(bones[local], []).append(piece)

    def _vertex_bones(self, skin: XmlElement) -> tuple[list[int], Floats, Indices]:
        """Return the bone index and the inverse bind matrix of each joint of the skin, and the joint of each vertex."""
        inputs = {e.get("semantic"): self._target(e, "source") for e in skin.iterfind("{*}joints/{*}input")}
        names = next(iter(inputs["JOINT"].iterfind("{*}Name_array")), None)
        names = inputs["JOINT"].find("{*}IDREF_array") if names is None else names
        by_word = {word: i for i, bone in reversed(list(enumerate(self.bones))) for word in bone.words}
        unknown = [n for n in names.text.split() if n not in by_word]
        if unknown:
            raise MeshFileError(f"has a skin with the joint {unknown[0]!r}, which is not a bone of its skeleton")
        bones = [by_word[n] for n in names.text.split()]
        inverses = self._source(inputs["INV_BIND_MATRIX"]).reshape(-1, 4, 4)
        element = skin.find("{*}vertex_weights")
        offsets = {e.get("semantic"): int(e.get("offset", 0)) for e in element.iterfind("{*}input")}
        weights = next(self._target(e, "source") for e in element.iterfind("{*}input") if e.get("semantic") == "WEIGHT")
        weight = self._source(weights)[:, 0]
        counts = integers_of(element.find("{*}vcount").text or "", "weights")
        rows = integers_of(element.find("{*}v").text or "", "weights").reshape(-1, 1 + max(offsets.values()))
        joint, strong = rows[:, offsets["JOINT"]], weight[rows[:, offsets["WEIGHT"]]]
        vertex_joints, start = np.zeros(len(counts), np.int64), 0
        for i, count in enumerate(counts.tolist()):
            if count:
                vertex_joints[i] = max(0, joint[start + int(np.argmax(strong[start : start + count]))])
            start += count
        return bones, inverses, self._merge_light_bones(bones, vertex_joints)

    def _merge_light_bones(self, bones: list[int], vertex_joints: Indices) -> Indices:
        """Give the vertices of bones with almost no vertices to the nearest ancestor bone of the skin."""
        fractions = np.bincount(vertex_joints, minlength=len(bones)) / max(1, len(vertex_joints))
        local = {bone: i for i, bone in enumerate(bones)}
        for i in sorted(range(len(bones)), key=lambda k: -bones[k]):
            above = self.bones[bones[i]].parent
            while above >= 0 and above not in local:
                above = self.bones[above].parent
            if 0.0 < fractions[i] < _LEAST_FRACTION and above >= 0:
                vertex_joints = np.where(vertex_joints == i, local[above], vertex_joints)
                fractions[local[above]] += fractions[i]
        return vertex_joints

    # ------------------------------------------------------------------ animation

    def _animation(self) -> tuple[Floats, dict[int, Floats]]:
        """Return all times of the animation [s], and the transforms of every moving bone at these times."""
        by_id = {node.get("id"): bone for node, bone in self.of_node.items() if node.get("id")}
        channels: dict[int, tuple[Floats, Floats]] = {}
        for channel in self.root.iterfind(".//{*}library_animations//{*}channel"):
            target = channel.get("target", "").partition("/")[0]
            sampler = self._target(channel, "source")
            if target not in by_id or sampler is None:
                continue
            inputs = {e.get("semantic"): self._target(e, "source") for e in sampler.iterfind("{*}input")}
            times, values = self._source(inputs["INPUT"])[:, 0], self._source(inputs["OUTPUT"])
            if values.shape[1] != 16 or len(times) != len(values) or not 0 < len(times) <= _MOST_FRAMES:
                text = f"animates {channel.get('target', '')[:80]!r} without matrices; this animation is ignored"
                self.companions.note(text)
                continue
            channels[by_id[target]] = times, values.reshape(-1, 4, 4)
        if not channels:
            return np.zeros(0), {}
        times = np.unique(np.concatenate([t for t, _ in channels.values()]))
        # no interpolation: the bones of a file usually have the same times
        frames = {
            bone: matrices[np.clip(np.searchsorted(key_times, times + 1e-9, side="right") - 1, 0, len(key_times) - 1)]
            for bone, (key_times, matrices) in channels.items()
        }
        return times, frames
