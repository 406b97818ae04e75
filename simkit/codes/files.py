"""Files that are no world and no model at all."""

from __future__ import annotations

from simkit.codes import Code, Example

CODES: tuple[Code, ...] = (
    Code(
        "SK-XML-005",
        "error",
        "the file is not XML; the message says what it looks like (empty, packed, a mesh, a picture, JSON, ...)",
        "name an SDF, URDF, xacro or MJCF file; a packed one has to be unpacked first",
        Example('{"name": "world"}\n'),
    ),
)
