"""Codes of mesh files and of their conversion."""

from __future__ import annotations

from simkit.codes import Code
from simkit.codes.sketch import INERTIAL, link, model, python, shape

_TETRAHEDRON = "v 0 0 0\nv 1 0 0\nv 0 1 0\nv 0 0 1\nusemtl red\nf 1 3 2\nf 1 2 4\nf 2 3 4\nf 1 4 3\n"
_LINE = "v 0 0 0\nv 1 0 0\nv 2 0 0\nf 1 2 3\n"
_PRISM = """from math import cos, pi, sin
from pathlib import Path
import simkit
lines, n = [], 24
for i in range(n):
    x, y, j = 0.1 * cos(2 * pi * i / n), 0.1 * sin(2 * pi * i / n), (i + 1) % n
    lines += [f"v {x} {y} -0.02", f"v {x} {y} 0.02", f"f {2 * i + 1} {2 * j + 1} {2 * j + 2} {2 * i + 2}"]
lines += ["f " + " ".join(str(2 * i + k) for i in range(n)) for k in (1, 2)]
Path("wheel.obj").write_text("\\n".join(lines))
for problem in simkit.check("cart.sdf"):
    print(problem)
"""
_CART = f"""<link name="base">{INERTIAL}</link>
<link name="wheel">
  {INERTIAL}
  <collision name="tyre"><geometry><mesh><uri>wheel.obj</uri></mesh></geometry></collision>
</link>
<joint name="axle" type="continuous">
  <parent>base</parent><child>wheel</child>
  <axis><xyz>0 0 1</xyz></axis>
</joint>"""

CODES: tuple[Code, ...] = (
    Code(
        "SK-MESH-012",
        "warning",
        "a mesh file names a material library, buffer or texture that is missing, unreadable or outside of its model",
        "put it beside the mesh or into its model's folder; what is not found is drawn without",
        shape(
            "<mesh><uri>nose.obj</uri></mesh>",
            files={"nose.obj": "mtllib nose.mtl\n" + _TETRAHEDRON},
        ),
    ),
    Code(
        "SK-MESH-013",
        "note",
        "a part of a drawn mesh has no triangle with area and is left out",
        "",
        link(
            '<visual name="look"><geometry><mesh><uri>line.obj</uri></mesh></geometry></visual>',
            files={"line.obj": _LINE},
        ),
    ),
    Code(
        "SK-MESH-014",
        "warning",
        "a mesh that should be decomposed into convex pieces is not, and collides as without the request",
        "pip install 'simkit-robotics[decompose]'",
        without="it takes an installation without CoACD, or a mesh that CoACD breaks down on",
    ),
    Code(
        "SK-MESH-015",
        "warning",
        "an unknown word in a mesh's `optimization`",
        "convex_hull or convex_decomposition",
        shape(
            '<mesh optimization="convex_decompositoin"><uri>nose.obj</uri></mesh>',
            files={"nose.obj": _TETRAHEDRON.replace("usemtl red\n", "")},
        ),
    ),
    Code(
        "SK-MESH-016",
        "note",
        "a collision mesh that is round about the joint on which its link turns without limits collides as a cylinder "
        "of the radius of its corners, so that it does not roll over its edges: at least 16 sides, not more than 1 % "
        "of the radius beside the axis, and bevelled by 1.5 % of the volume at most; other meshes stay as they are",
        "",
        python(_PRISM, {"cart.sdf": model(_CART).text}),
    ),
)
