"""Text of a robot's URDF, as programs of ROS read it from `/robot_description`."""

from __future__ import annotations

from html import escape
from pathlib import Path

from simkit.params import Params


def urdf_text(root: Params, *, absolute: bool = True) -> str:
    """Return the URDF of a robot after the expansion of xacro.

    Args:
        root: root element.
        absolute: true to write relative file names as `file://` URIs.
    """
    return '<?xml version="1.0"?>\n' + "\n".join(_lines(root, 0, absolute)) + "\n"


def _lines(element: Params, depth: int, absolute: bool) -> list[str]:
    indent = "  " * depth
    attributes = "".join(
        f' {name}="{escape(_file_uri(element, value) if absolute and name == "filename" else value)}"'
        for name, value in element.attributes.items()
    )
    opening = f"{indent}<{element.name}{attributes}"
    text = escape(element.value, quote=False)
    if not element.children:
        return [f"{opening}>{text}</{element.name}>" if text else f"{opening}/>"]
    inner = [line for child in element.children for line in _lines(child, depth + 1, absolute)]
    return [f"{opening}>{text}", *inner, f"{indent}</{element.name}>"]


def _file_uri(element: Params, name: str) -> str:
    """Return the URI of a mesh or texture file beside the robot's file; plugins and URIs stay as they are."""
    if element.name not in ("mesh", "texture") or "://" in name or not element.where.file:
        return name
    return (Path(element.where.file).resolve().parent / name).as_uri()
