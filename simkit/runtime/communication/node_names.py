"""Names of the ROS nodes to which plugins and sensors correspond."""

from __future__ import annotations

import re


def node_of(owner: object) -> str:
    """Return the node of a plugin or a sensor without live parameters; empty for no owner."""
    if owner is None:
        return ""
    scoped, name = str(getattr(owner, "scoped", "")), str(getattr(owner, "name", ""))
    parts = scoped.split("::") if scoped else []
    if not parts or parts[-1] != name:
        parts.append(name)
    words = [name_part(part) for part in parts if part]
    return "/" + "/".join(words) if words else ""


def name_part(text: str) -> str:
    """Convert a text to one component of a ROS name."""
    return re.sub(r"[^A-Za-z0-9_]+", "_", text).strip("_") or "_"
