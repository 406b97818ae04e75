"""Texts that describe changes: names as in the file, and numbers with units and only as many digits as needed."""

from __future__ import annotations

import math
import re
import tomllib
from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import Any

from simkit.testing.golden.cause.first_tick import distinct_digits
from simkit.testing.golden.compare.world_edits import ABSENT, Edit, entity_kind, scoped_name

_SHORTENED_PREFIXES = re.compile(r"^(params\.|geometry\.|inertial\.|surface\.|surroundings\.)")
_WORDS = tomllib.loads(Path(__file__).with_name("change_words.toml").read_text(encoding="utf-8"))
_UNITS: Mapping[str, str] = {name: unit for unit, names in _WORDS["units"].items() for name in names}
_CONTENT = re.compile(r"^[0-9a-f]{16} \((\d+) bytes\)$")
_LONGEST = 100  # maximum length of a value in characters


def attribute_name(attribute: str) -> str:
    """Return the name of an attribute in world files."""
    text = re.sub(r"^axes\[(\d+)\]\.", lambda m: "" if m[1] == "0" else f"axis {int(m[1]) + 1} ", attribute)
    text = _SHORTENED_PREFIXES.sub("", text).replace("@", " ").strip()
    found: str = _WORDS["names_in_files"].get(text, text)
    return found


def entity_title(owner: str) -> str:
    """Return the kind and the name of an entity: `link robot::wheel`."""
    return f"{entity_kind(owner)} {scoped_name(owner)}".strip()


def owner_title(edit: Edit) -> str:
    """Return the kind and the name of the entity whose value an edit changes."""
    return entity_title(edit.owner)


def list_names(names: Sequence[str], most: int = 4) -> str:
    """Join names with commas; of a long list, show the first names and the number of further names."""
    shown_ = list(names[: most if len(names) > most + 1 else len(names)])
    more = len(names) - len(shown_)
    return ", ".join(shown_) + (f" and {more} more" if more else "")


def edit_text(edit: Edit, leaves: Mapping[str, object]) -> str:
    """Describe an edit: `collision robot::wheel::tyre: radius 0.033 → 0.0333 m (+1 %)`.

    Args:
        edit: Edit.
        leaves: All values of the new run's world; the unit of some values depends on other values.
    """
    attribute = edit.attribute
    name = attribute_name(attribute)
    last = re.split(r"[. ]", attribute.rpartition("@")[2])[-1]
    unit = world_unit(edit, last, leaves)
    return f"{owner_title(edit)}: {name} {values_text(edit.golden, edit.run, last, unit)}"


def world_unit(edit: Edit, last: str, leaves: Mapping[str, object]) -> str:
    """Return the unit of a number in a world; empty if it has none or the unit is unknown."""
    attribute = edit.attribute
    if last in ("lower", "upper", "spring_ref", "velocity") and attribute.startswith("axes["):
        is_linear = leaves.get(f"{edit.owner}.type") == "prismatic"
        base = "m" if is_linear else "rad"
        return base + "/s" if last == "velocity" else base
    if last in ("min", "max"):
        return "rad" if ".scan" not in attribute and "angle" in attribute else "m" if ".range" in attribute else ""
    if ".image." in attribute:
        return ""  # pixels
    return _UNITS.get(last, "")


def values_text(golden: Any, run: Any, last: str = "", unit: str = "") -> str:
    """Describe two values: `0.033 → 0.0333 m (+1 %)`, `y 1 → 1.01 m`, `is new: 5`."""
    behind = f" {unit}" if unit else ""
    if golden is ABSENT:
        return f"is new: {single_value_text(run)}{behind}"
    if run is ABSENT:
        return f"is gone (it was {single_value_text(golden)}{behind})"
    if isinstance(golden, list) and isinstance(run, list) and len(golden) == len(run) and _flat(golden) and _flat(run):
        return _components(golden, run, last, behind)
    if _is_number(golden) and _is_number(run):
        return f"{distinct_digits(golden, run)}{behind}{_percent_change(golden, run)}"
    a, b = _CONTENT.match(str(golden)), _CONTENT.match(str(run))
    if a and b:
        size = f" ({a[1]} → {b[1]} bytes)" if a[1] != b[1] else f" (still {b[1]} bytes)"
        return "has different content" + size
    return f"{single_value_text(golden)} → {single_value_text(run)}{behind}"


def _components(golden: list[object], run: list[object], last: str, unit: str) -> str:
    names = _WORDS["components"].get(last) or ("xyz" if len(golden) == 3 else [f"[{i}]" for i in range(len(golden))])
    differing = [i for i, (a, b) in enumerate(zip(golden, run, strict=True)) if a != b]
    if len(differing) > 6:
        first = differing[0]
        return f"{len(differing)} of {len(golden)} numbers, the first {_pair(golden[first], run[first], unit)}"
    return ", ".join(f"{names[i] if i < len(names) else f'[{i}]'} {_pair(golden[i], run[i], unit)}" for i in differing)


def _pair(a: Any, b: Any, unit: str) -> str:
    return (
        distinct_digits(a, b) + unit + _percent_change(a, b)
        if _is_number(a) and _is_number(b)
        else f"{single_value_text(a)} → {single_value_text(b)}"
    )


def _percent_change(golden: float, run: float) -> str:
    """Return the change in per cent; empty for integers, other signs and changes of 100 % or more."""
    if isinstance(golden, int) and isinstance(run, int):
        return ""  # a count or a seed
    if not golden or not math.isfinite(golden) or not math.isfinite(run) or golden * run < 0:
        return ""
    percent = (run / golden - 1) * 100
    return f" ({percent:+.3g} %)" if abs(percent) < 100 else ""


def _flat(value: list[object]) -> bool:
    return not any(isinstance(v, list) for v in value)


def _is_number(value: object) -> bool:
    return isinstance(value, (int, float)) and not isinstance(value, bool)


def single_value_text(value: object) -> str:
    """Format one value; shorten a long one."""
    if isinstance(value, bool):
        return str(value).lower()
    if isinstance(value, float):
        return f"{value:.6g}"
    if isinstance(value, (list, tuple)):
        text = " ".join(single_value_text(v) for v in value) if _flat(list(value)) else str(value)
    elif isinstance(value, str):
        text = value if value else '""'
    else:
        text = str(value)
    text = " ".join(text.split())
    return text if len(text) <= _LONGEST else text[: _LONGEST - 3] + "..."
