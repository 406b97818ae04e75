"""Convex collision bodies of a mesh, computed once for each content and cached.

MuJoCo collides a mesh as its convex hull, which is exact for a convex mesh. A moving non-convex mesh is replaced by the
hulls of its connected pieces, or by a convex decomposition if the file requests one. A static mesh keeps its exact
surface. Rays always hit the triangles of the mesh. CoACD (the extra `decompose`) computes the decomposition; the same
mesh and settings give the same pieces.
"""

from __future__ import annotations

import hashlib
import importlib.util
import math
import os
import re
import sys
import tempfile
from collections import OrderedDict
from dataclasses import dataclass
from pathlib import Path
from typing import Final

import numpy as np

from simkit import progress
from simkit.child_process import ChildProcesses
from simkit.compiler.meshes.box_pieces import BoxPiece, box_pieces
from simkit.compiler.meshes.convex_pieces import (
    convex_pieces,
    filled_ratio,
    hull_volume,
    is_convex,
    is_inside_out,
    is_own_hull,
    mesh_volume,
    moving_pieces,
    surface_prisms,
)
from simkit.compiler.meshes.height_tiles import HeightTile
from simkit.compiler.meshes.surface_patches import LEAST_TOLERANCE, TRIANGLES_FROM, is_large, large_surface_pieces
from simkit.diagnostics import Severity
from simkit.float_sum import float_sum
from simkit.install_command import install_command
from simkit.linear_algebra import matmul, norm
from simkit.loaders.meshes.mesh_cache import FORMAT, load_arrays, store_arrays
from simkit.loaders.meshes.mesh_part import Floats, Ints
from simkit.number_text import counted

THRESHOLD: Final = 0.05
"""Concavity of CoACD, relative to the size of the mesh, below which a piece counts as convex."""

MOST_HULLS: Final = 256
_SEED: Final = 0
_WALL_LIMIT: Final = 600.0  # [s]
_SCRIPT: Final = Path(__file__).with_name("run_coacd.py")
_ROUND: Final = re.compile(r"\biter (\d+) ")
_SHARE: Final = re.compile(r"\bProcessing \[([\d.]+)%\]")


class DecompositionError(Exception):
    """Failed decomposition; the text has the reason, `hint` the remedy."""

    def __init__(self, text: str, hint: str = "") -> None:
        super().__init__(text)
        self.hint = hint


def is_available() -> bool:
    """Check whether CoACD is installed."""
    return importlib.util.find_spec("coacd") is not None


def decompose(vertices: Floats, faces: Ints, most: int) -> list[Floats]:
    """Return at most `most` point sets whose hulls together make up the mesh.

    Raises:
        DecompositionError: CoACD is missing or failed.
    """
    if not is_available():
        raise DecompositionError(
            "convex decomposition needs CoACD, which is not installed", install_command("decompose")
        )
    with tempfile.TemporaryDirectory(prefix="simkit-") as folder:
        source, target = Path(folder) / "in.npz", Path(folder) / "out.npz"
        most = min(max(1, most), MOST_HULLS)
        settings = {"threshold": THRESHOLD, "most": most, "seed": _SEED}
        np.savez(source, vertices=vertices.astype(float), faces=faces.astype(np.int32), **settings)  # type: ignore[arg-type]
        _run(source, target, len(faces), most)
        try:
            with np.load(target, allow_pickle=False) as result:
                return [np.asarray(result[f"p{i}"], float) for i in range(len(result.files))]
        except (OSError, ValueError, KeyError):
            raise DecompositionError("CoACD gave no result") from None


def _run(source: Path, target: Path, triangles: int, most: int) -> None:
    """Run CoACD in a child process and report its progress."""
    single_thread = {"OMP_NUM_THREADS": "1", "OMP_DYNAMIC": "false"}
    environment = {**os.environ, "PYTHONPATH": os.pathsep.join(filter(None, sys.path)), **single_thread}
    rounds = most.bit_length() + 1  # each round divides all pieces that are not convex enough
    with progress.task(f"decomposing {counted(triangles, 'triangle')} into convex pieces", rounds, unit="%") as task:
        try:
            done = ChildProcesses().run(
                _SCRIPT,
                [str(source), str(target)],
                environment=environment,
                limit=_WALL_LIMIT,
                on_line=lambda line: _read_progress(line, task),
            )
        except OSError as problem:
            raise DecompositionError(f"CoACD could not be started: {problem.strerror}") from None
    if done.is_late:
        raise DecompositionError(f"CoACD did not end within {_WALL_LIMIT:g} s")
    if done.code:
        lines = [line for line in done.last_lines(50) if "[info]" not in line]
        raise DecompositionError(f"CoACD failed ({lines[-1][:200] if lines else f'exit code {done.code}'})")


def _read_progress(line: str, task: progress.Task) -> None:
    """Read the progress from a line of CoACD's log: "iter 2 ---- waiting pool: 4" or "Processing [25.0%]"."""
    assert task.total is not None
    if match := _ROUND.search(line):
        task.done = float(match[1])
    elif match := _SHARE.search(line):
        task.done = math.floor(task.done) + min(0.99, float(match[1]) / 100.0)
    task.total = max(task.total, math.ceil(task.done))


LARGEST_RATIO: Final = 1.1
"""Largest ratio of the hulls' volume to the mesh's volume that is reported as a note; a larger one is a warning."""

LARGEST_ESTIMATE: Final = 1.25
"""The same limit for meshes that are not closed, whose volume is an estimate."""

LARGEST_ERROR: Final = 0.005
"""Largest error [m] of the contacts of a large static mesh that is not reported as a warning."""

_REPORTS: Final = (
    9  # version of the bodies and of the texts of their findings, which are cached: raise it with every change
)
_DECOMPOSE: Final = 'give the collision simple shapes, or <mesh optimization="convex_decomposition">'
_KEPT: Final = 128
_memory: OrderedDict[str, ConvexBodies] = OrderedDict()

CollisionFinding = tuple[Severity, str, str, str]
"""Severity, code, text without the mesh's name, and hint."""


@dataclass(frozen=True, eq=False)
class ConvexBodies:
    """Convex collision bodies of one mesh.

    Attributes:
        shapes: vertices, shape (n, 3) [m], and faces of each body; no faces if MuJoCo has to compute them.
        is_exact: True if the bodies have the surface of the mesh; otherwise rays need a copy of the mesh itself.
        findings: diagnostics about the conversion.
        tiles: height fields that collide beside the bodies.
        copies: number of a shape and offset [m] of each further place of it.
        boxes: boxes that collide beside the bodies.
    """

    shapes: tuple[tuple[Floats, Ints], ...]
    is_exact: bool = True
    findings: tuple[CollisionFinding, ...] = ()
    tiles: tuple[HeightTile, ...] = ()
    copies: tuple[tuple[int, Floats], ...] = ()
    boxes: tuple[BoxPiece, ...] = ()


def convex_bodies(
    vertices: Floats, faces: Ints, *, fixed: bool, optimization: str = "", most: int = 16
) -> ConvexBodies:
    """Return the collision bodies of a mesh.

    Args:
        vertices: vertices with equal ones merged, shape (n, 3) [m].
        faces: vertex indices, shape (m, 3).
        fixed: True if the mesh is static, or if only the user moves it.
        optimization: "", "convex_hull" or "convex_decomposition", as in SDF's `<mesh>`.
        most: largest number of pieces of a decomposition.
    """
    settings = (FORMAT, _REPORTS, fixed, optimization, most if optimization == "convex_decomposition" else 0, THRESHOLD)
    key = _key(vertices, faces, (*settings, is_available() if optimization == "convex_decomposition" else None))
    if key not in _memory:
        _memory[key] = _load(key) or _store(key, _compute_bodies(vertices, faces, fixed, optimization, most))
        while len(_memory) > _KEPT:
            _memory.popitem(last=False)
    _memory.move_to_end(key)
    return _memory[key]


def _compute_bodies(vertices: Floats, faces: Ints, fixed: bool, optimization: str, most: int) -> ConvexBodies:
    if not len(faces):
        return ConvexBodies(
            (), True, (("warning", "SK-MESH-003", "has no triangle with an area; it never collides", ""),)
        )
    volume = hull_volume(vertices)
    if volume <= 1e-9 * float(np.ptp(vertices, axis=0).max()) ** 3:
        return _surface_plates(vertices, faces)
    if is_convex(vertices, faces) and not (fixed and is_inside_out(vertices, faces)):
        return ConvexBodies(_hulls([vertices]), is_own_hull(vertices, faces))
    if optimization == "convex_hull":
        return ConvexBodies(_hulls([vertices]), False)
    if optimization == "convex_decomposition":
        try:
            pieces = _hulls(decompose(vertices, faces, most))
            if not pieces:
                raise DecompositionError("CoACD gave no piece")
            return ConvexBodies(pieces, False, (_decompose_mesh(vertices, faces, pieces),))
        except DecompositionError as problem:
            rest = _surface(vertices, faces) if fixed else _by_pieces(vertices, faces)
            finding: CollisionFinding = ("warning", "SK-MESH-014", f"is not decomposed: {problem}", problem.hint)
            return ConvexBodies(rest.shapes, rest.is_exact, (finding, *rest.findings))
    return _surface(vertices, faces) if fixed else _by_pieces(vertices, faces)


def _decompose_mesh(vertices: Floats, faces: Ints, pieces: tuple[tuple[Floats, Ints], ...]) -> CollisionFinding:
    volume = mesh_volume(vertices, faces)
    total = float_sum(hull_volume(points) for points, _ in pieces)
    share = f"together {total / volume:.2f} times its volume" if volume else "the mesh is not closed"
    return "note", "SK-MESH-004", f"collides as {counted(len(pieces), 'convex piece')} ({share})", ""


def _by_pieces(vertices: Floats, faces: Ints) -> ConvexBodies:
    pieces = moving_pieces(vertices, faces)
    sets = [points for points, _ in pieces if hull_volume(points) > 0.0] or [vertices]
    mesh_size = mesh_volume(vertices, faces)
    hulls_size = float_sum(hull_volume(points) for points in sets)
    hulls = "its convex hull" if len(sets) == 1 else f"the convex hulls of its {counted(len(sets), 'piece')}"
    if mesh_size:
        ratio = hulls_size / mesh_size
        severity: Severity = "warning" if ratio > LARGEST_RATIO else "note"
        share = f"{ratio:.2f} times the mesh's volume"
    else:
        ratio = filled_ratio(vertices, faces, sets)
        severity = "warning" if ratio > LARGEST_ESTIMATE else "note"
        share = f"about {ratio:.1f} times the volume that the mesh encloses (it is not closed)"
    text = f"collides as {hulls}, {share}"
    finding = severity, "SK-MESH-004", text, _DECOMPOSE if severity == "warning" else ""
    findings = (finding,) if not mesh_size or hulls_size > 1.005 * mesh_size else ()
    is_exact = all(is_convex(*piece) and is_own_hull(*piece) for piece in pieces)
    return ConvexBodies(_hulls(sets), is_exact, findings)


def _surface(vertices: Floats, faces: Ints) -> ConvexBodies:
    findings: list[CollisionFinding] = []
    tiles: list[HeightTile] = []
    copies: list[tuple[int, Floats]] = []
    boxes: list[BoxPiece] = []
    large = large_surface_pieces(vertices, faces) if len(faces) > TRIANGLES_FROM else None
    if large is not None and (large.error <= LEAST_TOLERANCE or is_large(vertices, faces)):
        pieces, tiles, error, copies = large
        kind = f"{sum(not p.is_solid for p in pieces)} patches of"
        shapes, boxes, copies = _shapes_and_boxes([p.points for p in pieces], copies)
        if error > LARGEST_ERROR:
            text = (
                f"has {len(faces)} triangles; it is simplified for contacts, and its surface is exact to {error:.2g} m"
            )
            findings.append(("warning", "SK-MESH-005", text, "give the collision a coarser mesh or several meshes"))
    else:
        pieces = convex_pieces(vertices, faces)
        kind = f"{sum(not p.is_solid for p in pieces)} prisms on"
        shapes = _hulls([p.points for p in pieces])
    closed = sum(p.is_solid for p in pieces) + len(copies)
    fields = f", and {counted(len(tiles), 'height field')}" if tiles else ""
    text = f"is not convex: it collides as {counted(closed, 'convex piece')} and {kind} its surface{fields}"
    findings.append(("note", "SK-MESH-006", text, ""))
    return ConvexBodies(shapes, False, tuple(findings), tuple(tiles), tuple(copies), tuple(boxes))


def _shapes_and_boxes(
    pieces: list[Floats], copies: list[tuple[int, Floats]]
) -> tuple[tuple[tuple[Floats, Ints], ...], list[BoxPiece], list[tuple[int, Floats]]]:
    """Return the pieces that are no boxes, the boxes at all places, and the copies of the pieces that are no boxes."""
    fitted = box_pieces(pieces)
    is_shape = np.array([box is None for box in fitted], bool)
    numbers = np.cumsum(is_shape) - 1
    boxes = [box for box in fitted if box is not None]
    boxes += [box._replace(centre=box.centre + at) for number, at in copies if (box := fitted[number]) is not None]
    shapes = tuple((pieces[number], np.zeros((0, 3), np.int32)) for number in np.flatnonzero(is_shape).tolist())
    return shapes, boxes, [(int(numbers[number]), at) for number, at in copies if is_shape[number]]


def _surface_plates(vertices: Floats, faces: Ints) -> ConvexBodies:
    finding: CollisionFinding = ("note", "SK-MESH-007", "is flat: it collides as a thin plate", "")
    return ConvexBodies(_hulls(surface_prisms(vertices, faces)), False, (finding,))


# ---------------------------------------------------------------------- hulls


def _hulls(sets: list[Floats]) -> tuple[tuple[Floats, Ints], ...]:
    return tuple(shape for points in sets if (shape := convex_hull(points)) is not None)


def convex_hull(points: Floats) -> tuple[Floats, Ints] | None:
    """Return vertices and outward faces of the convex hull; None for a degenerate hull without contacts."""
    from scipy.spatial import ConvexHull, QhullError

    if _is_thick_prism(points):
        return points, np.zeros((0, 3), np.int32)
    try:
        hull = ConvexHull(points)
    except (QhullError, ValueError):
        return None
    used, inverse = np.unique(hull.simplices, return_inverse=True)
    vertices = np.asarray(points, float)[used]
    faces = np.asarray(inverse).reshape(-1, 3)
    corners = vertices[faces]
    normals = np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0])
    inwards = np.einsum("ij,ij->i", normals, corners[:, 0] - vertices.mean(axis=0)) < 0.0
    faces[inwards] = faces[inwards][:, ::-1]
    return vertices, faces.astype(np.int32)


def _is_thick_prism(points: Floats) -> bool:
    """Check quickly whether six points are a triangle and its shifted copy and are far from flat: the usual case."""
    if len(points) != 6:
        return False
    shift = points[3:] - points[:3]
    if np.abs(shift - shift[0]).max() > 1e-9:
        return False
    u, v = points[1] - points[0], points[2] - points[0]
    area = norm(np.cross(u, v))
    edge = float(max(matmul(u, u), matmul(v, v), matmul(u - v, u - v)))
    return area > 1e-3 * edge and float(matmul(shift[0], shift[0])) > 1e-8 * edge


# ---------------------------------------------------------------------- cache


def _key(vertices: Floats, faces: Ints, settings: object) -> str:
    digest = hashlib.sha256(repr(settings).encode())
    digest.update(np.ascontiguousarray(vertices).data)
    digest.update(np.ascontiguousarray(faces).data)
    return digest.hexdigest()[:40]


def _load(key: str) -> ConvexBodies | None:
    stored = load_arrays("collisions", key)
    if stored is None:
        return None
    header, arrays = stored
    try:
        cuts = [np.cumsum(arrays[name])[:-1] for name in ("vertex_counts", "face_counts")]
        vertices, faces = np.split(arrays["vertices"], cuts[0]), np.split(arrays["faces"], cuts[1])
        shapes = tuple(zip(vertices, faces, strict=True)) if len(arrays["vertex_counts"]) else ()
        findings = tuple((severity, str(b), str(c), str(d)) for severity, b, c, d in header["findings"])
        cuts = [np.cumsum(arrays["tile_sizes"].prod(axis=1))[:-1]]
        heights = np.split(arrays["tile_heights"], cuts[0]) if len(arrays["tile_sizes"]) else []
        tiles = tuple(
            HeightTile(numbers[:3], numbers[3:12].reshape(3, 3), numbers[12:14], rows.reshape(size), float(numbers[14]))
            for numbers, rows, size in zip(arrays["tiles"], heights, arrays["tile_sizes"], strict=True)
        )
        copies = tuple(zip(arrays["copies"].tolist(), arrays["copy_offsets"], strict=True))
        boxes = tuple(BoxPiece(row[:3], row[3:12].reshape(3, 3), row[12:]) for row in arrays["boxes"])
        return ConvexBodies(shapes, bool(header["is_exact"]), findings, tiles, copies, boxes)
    except Exception:  # noqa: BLE001 -- after any error with a foreign file, the bodies are computed again
        return None


def _store(key: str, bodies: ConvexBodies) -> ConvexBodies:
    shapes = bodies.shapes
    arrays = {
        "vertices": np.concatenate([v for v, _ in shapes]) if shapes else np.zeros((0, 3)),
        "faces": np.concatenate([f for _, f in shapes]) if shapes else np.zeros((0, 3), np.int32),
        "vertex_counts": np.array([len(v) for v, _ in shapes], np.int64),
        "face_counts": np.array([len(f) for _, f in shapes], np.int64),
        "tiles": np.array([(*t.origin, *t.axes.flat, *t.cell, t.base) for t in bodies.tiles]).reshape(-1, 15),
        "tile_sizes": np.array([t.heights.shape for t in bodies.tiles], np.int64).reshape(-1, 2),
        "copies": np.array([number for number, _ in bodies.copies], np.int64),
        "copy_offsets": np.array([offset for _, offset in bodies.copies]).reshape(-1, 3),
        "boxes": np.array([(*b.centre, *b.axes.flat, *b.half) for b in bodies.boxes]).reshape(-1, 15),
        "tile_heights": np.concatenate([np.zeros(0), *(t.heights.reshape(-1) for t in bodies.tiles)]),
    }
    has_failed = any(code == "SK-MESH-014" for _, code, _, _ in bodies.findings)
    if not has_failed:  # a failed decomposition is tried again the next time
        store_arrays("collisions", key, {"is_exact": bodies.is_exact, "findings": bodies.findings}, arrays)
    return bodies
