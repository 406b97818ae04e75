"""Asset files of a model: read once, with a size limit, and checked before MuJoCo reads them."""

from __future__ import annotations

import struct
from pathlib import Path
from typing import Final

from simkit.diagnostics import Diagnostics, Where
from simkit.input_file import read_input
from simkit.number_text import counted

MAX_BYTES: Final = 256 << 20
MAX_PIXELS: Final = 64_000_000
_MAX_CELLS: Final = 25_000_000

_KNOWN_SUFFIXES: Final[dict[str, frozenset[str]]] = {
    "mesh": frozenset({".stl", ".obj", ".msh"}),
    "flexcomp": frozenset({".stl", ".obj", ".msh"}),
    "texture": frozenset({".png", ".ktx"}),
    "hfield": frozenset({".png", ".bin", ".hf"}),
    "skin": frozenset({".skn"}),
}

_TETRAHEDRON: Final = b"v 0 0 0\nv 0.01 0 0\nv 0 0.01 0\nv 0 0 0.01\nf 1 3 2\nf 1 2 4\nf 1 4 3\nf 2 3 4\n"
_PIXEL: Final = bytes.fromhex(
    "89504e470d0a1a0a0000000d4948445200000001000000010802000000907753de0000000c49444154789c636868680000030401814bd3d210"
    "0000000049454e44ae426082"
)


def placeholder(kind: str) -> tuple[str, bytes]:
    """Return suffix and content of a small valid file that replaces a missing one."""
    if kind == "texture":
        return ".png", _PIXEL
    if kind == "hfield":
        return ".bin", struct.pack("<2i4f", 2, 2, 0.0, 0.0, 0.0, 0.0)
    return ".obj", _TETRAHEDRON


def read_asset(path: Path, kind: str, where: Where, diagnostics: Diagnostics) -> bytes:
    """Read a file; return empty bytes, with an error recorded, if it is unreadable, too large or of the wrong kind."""
    try:
        data = read_input(path, MAX_BYTES)
    except OSError as error:
        diagnostics.error("SK-MJCF-007", f"cannot read {path}: {error.strerror or error}", where)
        return b""
    problem = _asset_problem(data, path.suffix.lower(), kind)
    if problem:
        diagnostics.error("SK-MJCF-007", f"{path}: {problem}", where)
        return b""
    return data


def _asset_problem(data: bytes, suffix: str, kind: str) -> str:
    """Describe the problem that makes a file unusable; empty if there is none."""
    if not data:
        return "the file is empty"
    if suffix not in _KNOWN_SUFFIXES.get(kind, ()):
        known = ", ".join(sorted(_KNOWN_SUFFIXES.get(kind, ())))
        return f"MuJoCo cannot read a {suffix or 'file without suffix'} as a {kind} (supported: {known})"
    if data.startswith(b"\x89PNG"):
        return _png_problem(data)
    if suffix == ".stl":
        return _stl_problem(data)
    if suffix == ".msh":
        return _msh_problem(data)
    if kind == "hfield":
        return _hfield_problem(data)
    return ""


def _png_problem(data: bytes) -> str:
    if len(data) < 33:
        return "the PNG file ends inside its header"
    width, height = struct.unpack(">2I", data[16:24])
    return f"{width} x {height} pixels; the limit is {MAX_PIXELS} pixels" if width * height > MAX_PIXELS else ""


def _stl_problem(data: bytes) -> str:
    if len(data) < 84:
        return "not a binary STL file: too short"
    (count,) = struct.unpack("<I", data[80:84])
    if len(data) != 84 + 50 * count:
        if data.lstrip().startswith(b"solid"):
            return "an ASCII STL file; MuJoCo only reads binary STL files"
        return f"the STL header declares {counted(count, 'triangle')}, but the file has {(len(data) - 84) // 50}"
    return ""


def _msh_problem(data: bytes) -> str:
    if len(data) < 16:
        return "the MSH file ends inside its header"
    vertices, normals, coordinates, faces = struct.unpack("<4i", data[:16])
    if min(vertices, normals, coordinates, faces) < 0 or vertices == 0:
        return f"its header declares {vertices} vertices, {normals} normals, {faces} faces"
    declared = 16 + 12 * vertices + 12 * normals + 8 * coordinates + 12 * faces
    return "" if declared == len(data) else f"its header declares {declared} bytes, but the file has {len(data)}"


def _hfield_problem(data: bytes) -> str:
    if len(data) < 8:
        return "the height field ends inside its header"
    rows, columns = struct.unpack("<2i", data[:8])
    if rows < 1 or columns < 1 or rows * columns > _MAX_CELLS:
        return f"its header declares {rows} x {counted(columns, 'height')}"
    declared = 8 + 4 * rows * columns
    return "" if declared == len(data) else f"its header declares {declared} bytes, but the file has {len(data)}"
