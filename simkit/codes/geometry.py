"""Mesh files, textures and other shapes."""

from __future__ import annotations

from simkit.codes import Code
from simkit.codes.sketch import link, python, static


def _obj(vertices: str, faces: str) -> str:
    """An OBJ file: vertices split by commas, faces too (1-based)."""
    lines = [f"v {v.strip()}" for v in vertices.split(",")] + [f"f {f.strip()}" for f in faces.split(",")]
    return "\n".join(lines) + "\n"


_L_SHAPE = _obj(
    "0 0 0, 2 0 0, 2 1 0, 1 1 0, 1 2 0, 0 2 0, 0 0 1, 2 0 1, 2 1 1, 1 1 1, 1 2 1, 0 2 1",
    "1 4 2, 2 4 3, 1 6 4, 4 6 5, 7 8 10, 8 9 10, 7 10 12, 10 11 12, 1 2 8, 1 8 7, 2 3 9, 2 9 8, 3 4 10, 3 10 9, "
    "4 5 11, 4 11 10, 5 6 12, 5 12 11, 6 1 7, 6 7 12",
)
_FLAT = _obj("0 0 0, 1 0 0, 1 1 0, 0 1 0", "1 2 3, 1 3 4")
_SLIVER = _obj("0 0 0, 1 0 0, 2 0 0", "1 2 3")
_MESH = '<collision name="hull"><geometry><mesh><uri>{uri}</uri></mesh></geometry></collision>'
_HEIGHTS = (
    '<collision name="ground"><geometry><heightmap><uri>heights.png</uri><size>10 10 1</size></heightmap></geometry>'
    "</collision>"
)
_BOW_TIE = (
    '<collision name="hull"><geometry><polyline>\n  <point>0 0</point><point>1 0</point><point>2 0</point>'
    "<height>1</height>\n</polyline></geometry></collision>"
)
_FOLDED = """
from pathlib import Path

import simkit

# a sheet of 2 × 80 × 80 triangles, folded like an accordion
n = 80
lines = [f"v {i} {j} {i % 2}" for i in range(n + 1) for j in range(n + 1)]
for i in range(n):
    for j in range(n):
        a, b = i * (n + 1) + j + 1, (i + 1) * (n + 1) + j + 1
        lines += [f"f {a} {b} {b + 1}", f"f {a} {b + 1} {a + 1}"]
Path("sheet.obj").write_text("\\n".join(lines))
for problem in simkit.check("robot.sdf"):
    print(problem)
"""

CODES: tuple[Code, ...] = (
    Code(
        "SK-MESH-001",
        "error",
        "a mesh file that cannot be read",
        "",
        link(_MESH.format(uri="arm.stl"), files={"arm.stl": "this is no mesh\n"}),
    ),
    Code(
        "SK-MESH-002",
        "error",
        "a scale of zero, or not finite",
        without="the loaders refuse such a number first, with the line it stands in",
    ),
    Code(
        "SK-MESH-003",
        "warning",
        "a collision mesh whose triangles have no area; nothing collides for it",
        "",
        link(_MESH.format(uri="sliver.obj"), files={"sliver.obj": _SLIVER}),
    ),
    Code(
        "SK-MESH-004",
        "note, warning",
        "a moving mesh that is not convex collides as the convex hulls of its pieces; a warning where these have more "
        "than 1.1 times its volume",
        'give the collision simple shapes, or `<mesh optimization="convex_decomposition">`',
        link(_MESH.format(uri="corner.obj"), files={"corner.obj": _L_SHAPE}),
    ),
    Code(
        "SK-MESH-005",
        "warning",
        "a large static mesh is thinned out for contacts",
        "",
        python(_FOLDED, {"robot.sdf": static(_MESH.format(uri="sheet.obj")).text}),
    ),
    Code(
        "SK-MESH-006",
        "note",
        "a non-convex static mesh collides piece by piece",
        "",
        static(_MESH.format(uri="corner.obj"), files={"corner.obj": _L_SHAPE}),
    ),
    Code(
        "SK-MESH-007",
        "note",
        "a flat mesh collides as a thin plate",
        "",
        link(_MESH.format(uri="sheet.obj"), files={"sheet.obj": _FLAT}),
    ),
    Code(
        "SK-MESH-008",
        "warning",
        "a texture cannot be read",
        "",
        link(
            '<visual name="look">\n  <geometry><box><size>1 1 1</size></box></geometry>\n'
            "  <material><pbr><metal><albedo_map>wood.png</albedo_map></metal></pbr></material>\n</visual>",
            files={"wood.png": "this is no picture\n"},
        ),
    ),
    Code("SK-MESH-009", "error", "a polyline that encloses nothing", "", link(_BOW_TIE)),
    Code(
        "SK-MESH-010",
        "error",
        "a heightmap on a model that moves",
        "make it static",
        link(_HEIGHTS, files={"heights.png": "any picture\n"}),
    ),
    Code(
        "SK-MESH-011",
        "error",
        "a heightmap image that cannot be read",
        "",
        static(_HEIGHTS, files={"heights.png": "this is no picture\n"}),
    ),
)
