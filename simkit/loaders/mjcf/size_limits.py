"""Limits of an MJCF file: all numbers must be finite, and all counts must fit into memory.

MuJoCo allocates memory for every count, so a short file can request all available memory. MuJoCo also accepts a NaN,
with only a message in a log file.
"""

from __future__ import annotations

import csv
import functools
import itertools
import math
from collections.abc import Iterator
from pathlib import Path
from typing import Final

from simkit.params import Params

MOST_ELEMENTS: Final = 100_000
"""Maximum number of elements after all replications."""

_TEXTS: Final = frozenset((
    "name", "class", "childclass", "prefix", "model", "key", "value", "data", "file", "content_type", "mesh",
    "material", "texture", "hfield", "joint", "joint1", "joint2", "body", "body1", "body2", "geom", "geom1",
    "geom2", "site", "site1", "site2", "frame", "camera", "tendon", "tendon1", "tendon2", "actuator", "flex",
    "target", "objname", "refname", "objtype", "reftype", "instance", "plugin", "refsite", "cranksite",
    "slidersite", "sidesite", "jointinparent", "node", "type",
))  # fmt: skip
"""Attributes that hold names, in which `nan` and `inf` are ordinary words."""

_SHORTEST_STEP: Final = 1e-3
_LONGEST_STEP: Final = 100.0
_MEMORY_MOST: Final = 16 << 30


def check_bounds(root: Params) -> None:
    """Record an error for each number that is NaN or infinite, and for each count above its limit."""
    counted = 0
    for element, times in _elements(root):
        counted += times
        if counted > MOST_ELEMENTS * 10 or times > MOST_ELEMENTS:
            _report_excess(element, "count", f"{times} copies", f"at most {MOST_ELEMENTS} elements in total")
            return
        for name, text in element.attributes.items():
            _check(element, name, text)


def _elements(root: Params) -> Iterator[tuple[Params, int]]:
    """Yield every element with the number of copies that `<replicate>`, `<composite>` and `<flexcomp>` create of it."""
    stack = [(root, 1)]
    while stack:
        element, times = stack.pop()
        if element.name in ("replicate", "composite", "flexcomp"):
            for number in _numbers(element.attribute("count", "1")):
                times *= max(1, min(int(number), 1 << 40)) if math.isfinite(number) else 1
            times = min(times, 1 << 40)
        yield element, times
        stack += [(child, times) for child in reversed(element.children)]


def _numbers(text: str) -> list[float]:
    numbers = []
    for part in text.split():
        try:
            numbers.append(float(part))
        except ValueError:
            return []
    return numbers


def _check(element: Params, name: str, text: str) -> None:
    if name in _TEXTS or name.startswith("file"):
        return
    if (element.name, name) == ("size", "memory"):
        _check_memory(element, text)
        return
    numbers = _numbers(text)
    if not all(map(math.isfinite, numbers)):
        message = f"<{element.name} {name}={text!r}>: every number must be finite"
        element.error("SK-MJCF-004", message, "to set no limit, remove the attribute")
        return
    if (element.name, name) == ("lengthrange", "timestep") and numbers and numbers[0] < _SHORTEST_STEP:
        _report_excess(element, name, text, f"at least {_SHORTEST_STEP:g} s")
        return
    if (element.name, name) == ("option", "timestep") and numbers and not 1e-9 <= numbers[0] <= _LONGEST_STEP:
        _report_excess(element, name, text, f"1e-9 to {_LONGEST_STEP:g} s")
        return
    limits = _size_limits()
    most, most_product = limits.get((element.name, name)) or limits.get(("*", name)) or (None, None)
    if most is not None and numbers and max(numbers) > most:
        _report_excess(element, name, text, f"at most {most}")
    elif most_product is not None:
        values = [*numbers, *_numbers(element.attribute({"nrow": "ncol", "width": "height"}.get(name, "")))]
        if math.prod(max(1.0, v) for v in values) > most_product:
            _report_excess(element, name, " x ".join(f"{v:g}" for v in values), f"at most {most_product} in total")


@functools.cache
def _size_limits() -> dict[tuple[str, str], tuple[int, int | None]]:
    """Return the limits by element (`*`: any element) and attribute: largest number, and largest product of numbers.

    The two factors for a height field are `nrow` and `ncol`, and for a texture `width` and `height`.
    """
    with Path(__file__).with_name("size_limits.csv").open(encoding="utf-8", newline="") as file:
        rows = itertools.islice(csv.reader(file), 1, None)
        return {
            (element, name): (int(most), int(product) if product else None) for element, name, most, product in rows
        }


def _check_memory(element: Params, text: str) -> None:
    digits, unit = text.strip()[:-1], text.strip()[-1:].upper()
    scale = {"K": 10, "M": 20, "G": 30, "T": 40, "P": 50, "E": 60}.get(unit)
    number = _numbers(text if scale is None else digits)
    if number and number[0] * float(1 << (scale or 0)) > _MEMORY_MOST:
        _report_excess(element, "memory", text, f"at most {_MEMORY_MOST >> 30}G")


def _report_excess(element: Params, name: str, excess: str, allowed: str) -> None:
    element.error("SK-MJCF-005", f"<{element.name} {name}>: found {excess}; expected {allowed}")
