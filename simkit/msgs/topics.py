"""Topic names."""

from __future__ import annotations

import re


def valid_topic(name: str) -> str:
    """`name` as an absolute topic the way gz-transport makes one: spaces become `_`, other bad characters go.

    What that leaves empty between two slashes goes too.
    """
    kept = re.sub(r"[^A-Za-z0-9_/.:-]|:=", "", name.replace(" ", "_"))
    return "/" + re.sub("/{2,}", "/", kept).strip("/")
