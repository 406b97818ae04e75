"""Topic names."""

from __future__ import annotations

import re


def valid_topic(name: str) -> str:
    """Convert `name` to an absolute topic as gz-transport does: spaces become `_`, other bad characters go.

    A part between two slashes that is then empty goes too.
    """
    kept = re.sub(r"[^A-Za-z0-9_/.:-]|:=", "", name.replace(" ", "_"))
    return "/" + re.sub("/{2,}", "/", kept).strip("/")
