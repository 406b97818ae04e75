"""Small mesh files for tests, made of text and numbers."""

from __future__ import annotations

import base64
import json
import struct
from pathlib import Path
from typing import Any

import numpy as np

QUAD = ((0.0, 0.0, 0.0), (1.0, 0.0, 0.0), (1.0, 0.0, 1.0), (0.0, 0.0, 1.0))
QUAD_UV = ((0.0, 0.0), (1.0, 0.0), (1.0, 1.0), (0.0, 1.0))
TETRAHEDRON = ((0.0, 0.0, 0.0), (1.0, 0.0, 0.0), (0.0, 2.0, 0.0), (0.0, 0.0, 3.0))
TETRAHEDRON_FACES = ((0, 2, 1), (0, 1, 3), (1, 2, 3), (0, 3, 2))
L_SHAPE = ((0.0, 0.0), (1.0, 0.0), (1.0, 0.3), (0.3, 0.3), (0.3, 1.0), (0.0, 1.0))


def collada(
    scene: str, *, geometry: str = "", library: str = "", unit: str = "1", images: str = "", diffuse: str = "1 0 0 1"
) -> str:
    """A file with a tetrahedron `G` of a red material `M`; `scene` holds the nodes."""
    points = " ".join(f"{c:g}" for p in TETRAHEDRON for c in p)
    faces = " ".join(str(i) for f in TETRAHEDRON_FACES for i in f)
    return f"""<COLLADA xmlns="http://www.collada.org/2005/11/COLLADASchema" version="1.4.1">
<asset><unit meter="{unit}"/><up_axis>Y_UP</up_axis></asset>{images}
<library_effects><effect id="E"><profile_COMMON><technique sid="t"><phong>
<diffuse><color>{diffuse}</color></diffuse></phong></technique></profile_COMMON></effect></library_effects>
<library_materials><material id="M"><instance_effect url="#E"/></material></library_materials>
<library_geometries><geometry id="G" name="tetra"><mesh>
<source id="P"><float_array id="PA" count="12">{points}</float_array><technique_common>
<accessor source="#PA" count="4" stride="3"/></technique_common></source>
<vertices id="V"><input semantic="POSITION" source="#P"/></vertices>
<triangles count="4" material="S"><input semantic="VERTEX" source="#V" offset="0"/><p>{faces}</p></triangles>
</mesh></geometry>{geometry}</library_geometries>{library}
<library_visual_scenes><visual_scene id="W">{scene}</visual_scene></library_visual_scenes>
<scene><instance_visual_scene url="#W"/></scene></COLLADA>"""


PLACED = """<instance_geometry url="#G"><bind_material><technique_common>
<instance_material symbol="S" target="#M"/></technique_common></bind_material></instance_geometry>"""


def gltf(nodes: list[dict[str, Any]], **more: Any) -> dict[str, Any]:
    """A document with a textured quad as mesh 0 (upright in x, z), its buffer inside."""
    uv = np.array([(u, 1.0 - v) for u, v in QUAD_UV], "<f4")
    buffer = np.array(QUAD, "<f4").tobytes() + uv.tobytes() + np.array([0, 1, 2, 0, 2, 3], "<u2").tobytes()
    document: dict[str, Any] = {
        "asset": {"version": "2.0"},
        "scene": 0,
        "scenes": [{"nodes": [0]}],
        "nodes": nodes,
        "meshes": [
            {
                "name": "quad",
                "primitives": [{"attributes": {"POSITION": 0, "TEXCOORD_0": 1}, "indices": 2, "material": 0}],
            }
        ],
        "materials": [{"pbrMetallicRoughness": {"baseColorFactor": [0.2, 0.4, 0.6, 1.0]}}],
        "accessors": [
            {"bufferView": 0, "componentType": 5126, "count": 4, "type": "VEC3"},
            {"bufferView": 1, "componentType": 5126, "count": 4, "type": "VEC2"},
            {"bufferView": 2, "componentType": 5123, "count": 6, "type": "SCALAR"},
        ],
        "bufferViews": [
            {"buffer": 0, "byteOffset": 0, "byteLength": 48},
            {"buffer": 0, "byteOffset": 48, "byteLength": 32},
            {"buffer": 0, "byteOffset": 80, "byteLength": 12},
        ],
        "buffers": [{"byteLength": len(buffer), "uri": "data:;base64," + base64.b64encode(buffer).decode()}],
    }
    document.update(more)
    return document


def write_gltf(file: Path, document: dict[str, Any]) -> Path:
    file.write_text(json.dumps(document))
    return file


def write_glb(file: Path, document: dict[str, Any]) -> Path:
    """The same as a binary container: the first buffer becomes its binary chunk."""
    binary = base64.b64decode(document["buffers"][0]["uri"].partition(",")[2])
    inner = {**document, "buffers": [{"byteLength": len(binary)}]}
    text = json.dumps(inner).encode()
    text += b" " * (-len(text) % 4)
    binary += b"\0" * (-len(binary) % 4)
    chunks = struct.pack("<I4s", len(text), b"JSON") + text + struct.pack("<I4s", len(binary), b"BIN\0") + binary
    file.write_bytes(struct.pack("<4sII", b"glTF", 2, 12 + len(chunks)) + chunks)
    return file


def binary_stl(triangles: Any, header: bytes = b"", promised: int | None = None) -> bytes:
    """A binary STL of triangles, shape (m, 3, 3)."""
    corners = np.asarray(triangles, "<f4").reshape(-1, 3, 3)
    body = b"".join(b"\0" * 12 + t.tobytes() + b"\0\0" for t in corners)
    return header.ljust(80, b"\0")[:80] + struct.pack("<I", len(corners) if promised is None else promised) + body


def picture(file: Path, top: tuple[int, int, int], bottom: tuple[int, int, int], side: int = 8) -> Path:
    """A square picture, its upper half of one colour and its lower half of another."""
    from PIL import Image

    image = Image.new("RGB", (side, side), bottom)
    image.paste(top, (0, 0, side, side // 2))
    image.save(file)
    return file
