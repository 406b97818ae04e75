"""Disk cache of converted meshes, keyed by content.

If the cache cannot be read or written, meshes are converted again, which only costs time. A cache file is written under
a temporary name and then renamed, so that no process reads half a file. If the cache file is broken or has another
version, the mesh is converted again. A conversion that reads companion files (materials, textures) stores their sizes
and times. The conversion is repeated if one of them has changed.
"""

from __future__ import annotations

import contextlib
import hashlib
import io
import json
import os
import sys
import tempfile
import zlib
from collections.abc import Mapping
from dataclasses import dataclass, field
from functools import lru_cache
from pathlib import Path
from typing import TYPE_CHECKING, Any, Final

import numpy as np

from simkit.home_folder import home_folder
from simkit.input_file import read_input
from simkit.loaders.meshes.mesh_part import MeshPart

if TYPE_CHECKING:
    import numpy.typing as npt

    from simkit.run_spec import JsonMapping, JsonObject


# cached, because NumPy needs ten times as long to format a type as to hash it
_text_of_type = lru_cache(maxsize=64)(str)


def content_digest(*values: object) -> str:
    """Return a hash of arrays and other values, 20 hexadecimal digits."""
    digest = hashlib.sha1(usedforsecurity=False)
    for value in values:
        if isinstance(value, np.ndarray):
            digest.update(f"{_text_of_type(value.dtype)}{value.shape}".encode())
            digest.update(np.ascontiguousarray(value).data)
        else:
            digest.update(repr(value).encode())
        digest.update(b"|")
    return digest.hexdigest()[:20]


FORMAT: Final = "simkit mesh 6"
"""Version of the conversions; change it whenever a reader returns different numbers for the same file."""

_SELF_CONTAINED: Final = {".stl", ".glb", ".ply"}
_MAGIC: Final = b"simkit\x005"
_LARGEST_HEADER: Final = 1 << 22
_LARGEST_ENTRY: Final = 1 << 31  # [bytes]


@dataclass(frozen=True)
class ConvertedMesh:
    """Conversion of one mesh file.

    Attributes:
        notes: one sentence for each omitted element.
        companions: (size, modification time) of each requested companion file by path; None for a missing one.
    """

    parts: tuple[MeshPart, ...]
    notes: tuple[str, ...] = ()
    companions: Mapping[str, tuple[int, int] | None] = field(default_factory=dict)


def cache_directory() -> Path:
    """Return `SIMKIT_CACHE_DIR`, else the platform's cache folder."""
    return _directory(*map(os.environ.get, ("SIMKIT_CACHE_DIR", "XDG_CACHE_HOME", "LOCALAPPDATA", "HOME")))


@lru_cache(maxsize=8)
def _directory(chosen: str | None, caches: str | None, windows: str | None, _home: str | None) -> Path:
    if chosen:
        return Path(chosen)
    if sys.platform == "win32":
        return Path(windows or home_folder()) / "simkit"
    if sys.platform == "darwin":
        return home_folder() / "Library" / "Caches" / "simkit"
    return Path(caches if caches is not None else home_folder() / ".cache") / "simkit"


def mesh_key(file: Path, content: bytes) -> str:
    """Return the cache key of this content; for formats with companion files, the folder is part of the key."""
    suffix = file.suffix.lower()
    folder = "" if suffix in _SELF_CONTAINED else str(file.parent)
    digest = hashlib.sha256(f"{FORMAT}\n{suffix}\n{folder}\n".encode("utf-8", "surrogateescape"))
    digest.update(content)
    return digest.hexdigest()[:40]


def load_converted(key: str) -> ConvertedMesh | None:
    """Return the conversion stored under `key`; None if it is missing, incomplete or out of date."""
    stored = load_arrays("meshes", key)
    if stored is None:
        return None
    header, arrays = stored
    try:
        companions = {p: None if v is None else (int(v[0]), int(v[1])) for p, v in header["companions"].items()}
        if any(_stat(path) != known for path, known in companions.items()):
            return None
        parts = tuple(_part_from(arrays, i, entry) for i, entry in enumerate(header["parts"]))
        return ConvertedMesh(parts, tuple(str(n) for n in header["notes"]), companions)
    except Exception:  # noqa: BLE001 -- after any error with a broken or foreign file, the mesh is converted again
        return None


def store_converted(key: str, converted: ConvertedMesh) -> None:
    """Store a conversion under `key`."""
    arrays: dict[str, npt.NDArray[np.generic]] = {}
    for i, part in enumerate(converted.parts):
        arrays[f"v{i}"], arrays[f"f{i}"] = part.vertices, part.faces
        if part.uv is not None:
            arrays[f"u{i}"] = part.uv
        if part.texture is not None:
            arrays[f"t{i}"] = part.texture
    keep = ("name", "colour", "specular", "emission", "aliases")
    header = {
        "parts": [
            {**{k: getattr(p, k) for k in keep}, "texture": "" if p.texture is None else content_digest(p.texture)}
            for p in converted.parts
        ],
        "notes": converted.notes,
        "companions": dict(converted.companions),
    }
    store_arrays("meshes", key, header, arrays)


def load_arrays(kind: str, key: str) -> tuple[JsonObject, dict[str, npt.NDArray[Any]]] | None:
    """Return the header and arrays stored under `key`, verified by a checksum; None if they are incomplete."""
    try:
        content = read_input(_file_of(kind, key), _LARGEST_ENTRY)
        length = int.from_bytes(content[8:16], "little")
        start = 24 + length
        if (
            content[:8] != _MAGIC
            or length > _LARGEST_HEADER
            or content[16:24] != _check_header(key, memoryview(content)[24:])
        ):
            return None
        header = json.loads(content[24:start])
        arrays = {}
        for name, dtype, shape, offset in header["arrays"]:
            kind_of = np.dtype(dtype)
            count = int(np.prod(shape, dtype=np.int64))
            arrays[name] = np.frombuffer(content, kind_of, count, start + offset).reshape(shape)
        return header["header"], arrays
    except Exception:  # noqa: BLE001 -- as above
        return None


def store_arrays(kind: str, key: str, header: JsonMapping, arrays: Mapping[str, npt.NDArray[np.generic]]) -> None:
    """Write a file under a temporary name and rename it."""
    body, listed, offset = io.BytesIO(), [], 0
    for name, array in arrays.items():
        flat = np.ascontiguousarray(array)
        listed.append((name, flat.dtype.str, flat.shape, offset))
        offset += body.write(flat.tobytes())
        offset += body.write(b"\0" * (-offset % 16))
    text = json.dumps({"header": header, "arrays": listed}).encode()
    text += b" " * (-len(text) % 16)
    rest = text + body.getvalue()
    content = _MAGIC + len(text).to_bytes(8, "little") + _check_header(key, rest) + rest
    # RuntimeError: a user without a home folder
    with contextlib.suppress(OSError, RuntimeError):
        target = _file_of(kind, key)
        target.parent.mkdir(parents=True, exist_ok=True)
        handle, temporary = tempfile.mkstemp(dir=target.parent, suffix=".tmp")
        try:
            with os.fdopen(handle, "wb") as stream:
                stream.write(content)
            Path(temporary).replace(target)
        except BaseException:
            with contextlib.suppress(OSError):
                Path(temporary).unlink()
            raise


def _check_header(key: str, content: bytes | memoryview) -> bytes:
    """Return a checksum of the key too: an entry that was copied to the name of another mesh is not valid."""
    return zlib.crc32(content, zlib.crc32(key.encode())).to_bytes(8, "little")


def _file_of(kind: str, key: str) -> Path:
    return Path(f"{cache_directory()}{os.sep}{kind}{os.sep}{key}.bin")


def _stat(path: str) -> tuple[int, int] | None:
    try:
        stat = os.stat(path)  # noqa: PTH116 -- faster for thousands of files
    except (OSError, ValueError):
        return None
    return stat.st_size, stat.st_mtime_ns


def _part_from(arrays: Mapping[str, npt.NDArray[Any]], i: int, entry: JsonMapping) -> MeshPart:
    colour = entry["colour"]
    return MeshPart(
        name=entry["name"],
        vertices=arrays[f"v{i}"],
        faces=arrays[f"f{i}"],
        uv=arrays.get(f"u{i}"),
        colour=None if colour is None else tuple(colour),
        texture=arrays.get(f"t{i}"),
        specular=entry["specular"],
        emission=entry["emission"],
        aliases=tuple(entry["aliases"]),
        texture_digest=entry["texture"],
    )
