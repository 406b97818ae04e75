"""Converted meshes on disk, keyed by content. Optional: any failure to read or write only costs time."""

from __future__ import annotations

import contextlib
import hashlib
import json
import os
import sys
import tempfile
from collections.abc import Sequence
from pathlib import Path
from typing import Any, Final

import numpy as np

from simkit.compiler.mesh_part import MeshPart

_FORMAT: Final = "simkit mesh 2"
_COMPANIONS: Final = {".mtl", ".bin", ".png", ".jpg", ".jpeg", ".tga", ".bmp", ".gif", ".tif", ".tiff"}
_SELF_CONTAINED: Final = {".stl", ".glb", ".ply"}


def cache_directory() -> Path:
    """`SIMKIT_CACHE_DIR`, else the platform's own place for caches."""
    given = os.environ.get("SIMKIT_CACHE_DIR")
    if given:
        return Path(given)
    if sys.platform == "win32":
        return Path(os.environ.get("LOCALAPPDATA", str(Path.home()))) / "simkit"
    if sys.platform == "darwin":
        return Path.home() / "Library" / "Caches" / "simkit"
    return Path(os.environ.get("XDG_CACHE_HOME", str(Path.home() / ".cache"))) / "simkit"


def mesh_key(file: Path, submesh: str) -> str:
    """A name for the conversion of this file's content (and of the textures and materials beside it)."""
    digest = hashlib.sha256(f"{_FORMAT}\n{file.suffix.lower()}\n{submesh}\n".encode())
    digest.update(file.read_bytes())
    if file.suffix.lower() not in _SELF_CONTAINED:
        digest.update(str(file.parent).encode())
        for beside in sorted(p for p in file.parent.iterdir() if p.suffix.lower() in _COMPANIONS):
            stat = beside.stat()
            digest.update(f"{beside.name} {stat.st_size} {stat.st_mtime_ns}\n".encode())
    return digest.hexdigest()


def load_cached(key: str) -> list[MeshPart] | None:
    """The parts stored under `key`, or None."""
    try:
        with np.load(_file_of(key), allow_pickle=False) as archive:
            header = json.loads(str(archive["header"]))
            return [_part_from(archive, i, entry) for i, entry in enumerate(header)]
    except Exception:  # noqa: BLE001 -- whatever a broken or foreign file does, the mesh is simply converted again
        return None


def store(key: str, parts: Sequence[MeshPart]) -> None:
    """Writes a file of its own and renames it into place, so that concurrent processes never see half of one."""
    arrays: dict[str, Any] = {
        "header": np.array(json.dumps([{"name": p.name, "colour": p.colour} for p in parts])),
    }
    for i, part in enumerate(parts):
        arrays[f"v{i}"], arrays[f"f{i}"] = part.vertices, part.faces
        if part.uv is not None:
            arrays[f"u{i}"] = part.uv
        if part.texture is not None:
            arrays[f"t{i}"] = part.texture
    # RuntimeError: a user without a home folder
    with contextlib.suppress(OSError, RuntimeError):
        target = _file_of(key)
        target.parent.mkdir(parents=True, exist_ok=True)
        handle, temporary = tempfile.mkstemp(dir=target.parent, suffix=".tmp")
        try:
            with os.fdopen(handle, "wb") as stream:
                np.savez(stream, **arrays)
            Path(temporary).replace(target)
        except BaseException:
            with contextlib.suppress(OSError):
                Path(temporary).unlink()
            raise


def _file_of(key: str) -> Path:
    return cache_directory() / "meshes" / f"{key}.npz"


def _part_from(archive: Any, i: int, entry: dict[str, Any]) -> MeshPart:
    colour = entry["colour"]
    return MeshPart(
        name=entry["name"],
        vertices=archive[f"v{i}"],
        faces=archive[f"f{i}"],
        uv=archive.get(f"u{i}"),
        colour=None if colour is None else tuple(colour),
        texture=archive.get(f"t{i}"),
    )
