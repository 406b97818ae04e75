"""Units of message fields."""

from __future__ import annotations

import re
import tomllib
from collections.abc import Sequence
from functools import cache
from pathlib import Path
from typing import Final

_INDEX = re.compile(r"\[[^\]]*\]|\.\d+(?=\.|$)")

TABLES: Final[dict[str, list[list[str]]]] = tomllib.loads(
    Path(__file__).with_name("field_units.toml").read_text(encoding="utf-8")
)
"""Rows of regular expressions for types and fields."""


def plain_path(field: str) -> str:
    """Remove indices and names in brackets from a path: `transforms[base].transform` gives `transforms.transform`."""
    return _INDEX.sub("", field)


@cache
def unit_of(type_name: str, field: str) -> str:
    """Return the SI unit of a field; empty for a number without a unit.

    Orientations are compared as angles, so their unit is rad. The position of a joint is in rad or m; the message does
    not state which.

    Args:
        type_name: ROS type of the message.
        field: Path of the field within the message; indices are ignored.
    """
    by_field = ([".*", of_field, unit] for of_field, unit in TABLES["by_field"])
    return first_match([*TABLES["by_type"], *by_field], type_name, field, "")


def first_match(rows: Sequence[Sequence[str]], type_name: str, field: str, otherwise: str) -> str:
    """Return the last column of the first row whose expressions match the type and the field."""
    path = plain_path(field)
    for of_type, of_field, value in rows:
        if re.fullmatch(of_type, type_name) and re.fullmatch(of_field, path):
            return value
    return otherwise
