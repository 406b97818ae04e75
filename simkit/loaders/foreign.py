"""Files that are no world and no model: what each looks like, so that the message says more than a parser can."""

from __future__ import annotations

from typing import Final

from simkit.diagnostics import Diagnostics, Where

ALLOWED: Final = "a world or model file is XML that begins with <sdf>, <robot> (URDF, xacro) or <mujoco> (MJCF)"

_STARTS: Final[tuple[tuple[bytes, str], ...]] = (
    (b"\x1f\x8b", "a gzip file; unpack it first"),
    (b"PK\x03\x04", "a zip archive; unpack it first"),
    (b"BZh", "a bzip2 file; unpack it first"),
    (b"\xfd7zXZ", "an xz file; unpack it first"),
    (b"\x28\xb5\x2f\xfd", "a zstd file; unpack it first"),
    (b"\x89PNG", "a PNG picture"),
    (b"\xff\xd8\xff", "a JPEG picture"),
    (b"GIF8", "a GIF picture"),
    (b"glTF", "a glTF mesh"),
    (b"solid ", "an STL mesh"),
    (b"ply\n", "a PLY mesh"),
    (b"\x7fELF", "a program"),
    (b"MZ", "a program"),
    (b"\x89MCAP", "an MCAP recording"),
    (b"#ROSBAG", "a ROS 1 bag"),
    (b"SQLite format 3", "an SQLite file, perhaps a ROS 2 bag"),
    (b"%PDF", "a PDF document"),
    (b"version https://git-lfs", "a pointer of Git LFS; the content was not fetched (git lfs pull)"),
    (b"#!", "a script"),
)
_ROOTS: Final = {
    "COLLADA": "a mesh (COLLADA); name it in the <uri> of a <mesh>",
    "launch": "a ROS launch file; name the world or robot that it loads",
    "package": "a package.xml; name a model in its folder",
    "model": "a model without its <sdf>, or a model.config; put <sdf version='1.9'> around it, or name its folder",
    "world": "a world without the <sdf> around it; put <sdf version='1.9'> around it",
    "sdformat": "it is spelt <sdf>",
    "mujocoinclude": "a part of an MJCF file; name the file that includes it",
    "svg": "a drawing (SVG)",
    "html": "a web page",
    "OpenDRIVE": "a road map (OpenDRIVE)",
    "osm": "a map (OpenStreetMap)",
    "srdf": "a semantic description; name the URDF that it belongs to",
}


def is_foreign(data: bytes, where: Where, diagnostics: Diagnostics) -> bool:
    """Whether a file cannot be XML at all; an error then says what it looks like and what is allowed."""
    seems = _seems(data)
    if seems:
        diagnostics.error("SK-XML-005", f"this is not XML, it looks like {seems}", where, ALLOWED)
    return bool(seems)


def said_of_root(name: str) -> str:
    """What a file that begins with an element of another format is; empty where that is not known."""
    return _ROOTS.get(name, "")


def _seems(data: bytes) -> str:
    head = data[:4096].removeprefix(b"\xef\xbb\xbf").lstrip()
    if not head:
        return "an empty file"
    if head.startswith(b"<") or data.startswith((b"\xff\xfe", b"\xfe\xff", b"<\0", b"\0<")):
        return ""
    for start, name in _STARTS:
        if head.startswith(start):
            return name
    if _is_binary_stl(data):
        return "an STL mesh"
    if head.startswith((b"{", b"[")):
        return "JSON"
    if head.startswith((b"v ", b"o ", b"mtllib ", b"# Blender")) or b"\nv " in head:
        return "an OBJ mesh"
    if head.startswith(b"world: ") or b"\nworld: " in head:
        return "a scenario; simkit golden record, certify, bundle and grade take one"
    if b"\0" in head:
        return "a binary file"
    if b"<" not in data:
        return "a text without any element"
    return ""


def _is_binary_stl(data: bytes) -> bool:
    return len(data) >= 84 and len(data) == 84 + 50 * int.from_bytes(data[80:84], "little")
