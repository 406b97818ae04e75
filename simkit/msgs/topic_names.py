"""Conversion of names to valid topic names."""

from __future__ import annotations

import re


def valid_topic(name: str) -> str:
    """Convert a name to an absolute topic as gz-transport does.

    Spaces become `_`; other invalid characters and empty parts between slashes are removed.
    """
    valid = re.sub(r"[^A-Za-z0-9_/.:-]|:=", "", name.replace(" ", "_"))
    return "/" + re.sub("/{2,}", "/", valid).strip("/")
