"""STL: triangles without names, units or colours.

trimesh's reader does not hold the bounds on hostile files, so ours stays: a file that is cut short becomes an empty
scene without a word, and its errors name arrays instead of what is wrong with the file.
"""

from __future__ import annotations

import re
from typing import Final

import numpy as np

from simkit.compiler.meshes.companion_files import Companions
from simkit.compiler.meshes.mesh_part import LARGEST_FACES, Floats, Ints, MeshFileError, MeshPart, numbers_of

_HEADER: Final = 84
_RECORD: Final = np.dtype([("normal", "<f4", 3), ("corners", "<f4", (3, 3)), ("attribute", "<u2")])
_VERTEX: Final = re.compile(rb"vertex[ \t]+([^\r\n]*)", re.IGNORECASE)


def read_stl(content: bytes, companions: Companions) -> list[MeshPart]:
    """The triangles of a binary or ASCII file. Raises MeshFileError.

    A binary file is known by its length: exporters write `solid` at the beginning of binary files as well.
    """
    promised = int.from_bytes(content[80:_HEADER], "little") if len(content) >= _HEADER else -1
    held = (len(content) - _HEADER) // _RECORD.itemsize
    is_text = content[:512].lstrip()[:5].lower() == b"solid"
    if promised >= 0 and len(content) == _HEADER + promised * _RECORD.itemsize:
        corners = _binary(content, promised)
    elif is_text and (b"facet" in content[:4096].lower() or b"endsolid" in content[-512:].lower()):
        corners = _ascii(content)
    elif 0 < promised <= held:
        companions.note(f"has {len(content) - _HEADER - promised * _RECORD.itemsize} bytes behind its last triangle")
        corners = _binary(content, promised)
    elif promised > 0:
        raise MeshFileError(f"is cut short: its header promises {promised} triangles, there are {max(0, held)}")
    else:
        raise MeshFileError("holds no triangles")
    return [MeshPart("", *merge_corners(corners))]


def _binary(content: bytes, count: int) -> Floats:
    if count > LARGEST_FACES:
        raise MeshFileError(f"has more than {LARGEST_FACES} faces")
    records = np.frombuffer(content, _RECORD, count, _HEADER)
    return np.asarray(records["corners"], float).reshape(-1, 3)


def _ascii(content: bytes) -> Floats:
    if content.lower().count(b"vertex") > 3 * LARGEST_FACES:
        raise MeshFileError(f"has more than {LARGEST_FACES} faces")
    numbers = numbers_of(b" ".join(_VERTEX.findall(content)), "vertex")
    if not len(numbers) or len(numbers) % 9:
        raise MeshFileError(f"has {len(numbers) / 3:g} corners, which is no number of triangles")
    return numbers.reshape(-1, 3)


def merge_corners(corners: Floats) -> tuple[Floats, Ints]:
    """Vertices and faces of loose triangles, shape (3·m, 3); equal corners are one."""
    packed = np.ascontiguousarray(corners + 0.0).view(np.dtype((np.void, 24))).reshape(-1)
    _, first, inverse = np.unique(packed, return_index=True, return_inverse=True)
    order = np.argsort(first, kind="stable")
    rank = np.empty_like(order)
    rank[order] = np.arange(len(order))
    return corners[first[order]], rank[np.asarray(inverse).reshape(-1)].reshape(-1, 3).astype(np.int32)
