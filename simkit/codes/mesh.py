"""What mesh files bring along, and what becomes of them."""

from __future__ import annotations

from simkit.codes import Code
from simkit.codes.sketch import link, shape

_TETRAHEDRON = "v 0 0 0\nv 1 0 0\nv 0 1 0\nv 0 0 1\nusemtl red\nf 1 3 2\nf 1 2 4\nf 2 3 4\nf 1 4 3\n"
_LINE = "v 0 0 0\nv 1 0 0\nv 2 0 0\nf 1 2 3\n"

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
)
