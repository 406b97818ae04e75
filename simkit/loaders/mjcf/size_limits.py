"""What a file may ask for: numbers that are numbers, and counts within memory.

MuJoCo allocates whatever a count says, so a short file can ask for all memory there is; and it takes a NaN with no
more than a message in a log file.
"""

from __future__ import annotations

import math
from collections.abc import Iterator
from typing import Final

from simkit.diagnostics import Diagnostics
from simkit.params import Params

MOST_ELEMENTS: Final = 100_000
"""Elements after every replication."""

_MILLION: Final = 1_000_000
_MAX_COUNTS: Final[dict[tuple[str, str], int]] = {
    ("numeric", "size"): _MILLION,
    ("user", "dim"): 100_000,
    ("contact", "num"): 10_000,
    ("size", "njmax"): 10 * _MILLION,
    ("size", "nconmax"): 10 * _MILLION,
    ("size", "nstack"): 1 << 29,
    ("size", "nuserdata"): _MILLION,
    ("size", "nkey"): 10_000,
    ("texture", "width"): 16_384,
    ("texture", "height"): 16_384,
    ("texture", "nchannel"): 4,
    ("hfield", "nrow"): 10_000,
    ("hfield", "ncol"): 10_000,
    ("option", "iterations"): 100_000,
    ("option", "ls_iterations"): 100_000,
    ("option", "noslip_iterations"): 100_000,
    ("option", "ccd_iterations"): 100_000,
    ("option", "sdf_iterations"): 10_000,
    ("option", "sdf_initpoints"): 10_000,
    ("global", "offwidth"): 16_384,
    ("global", "offheight"): 16_384,
    ("quality", "shadowsize"): 16_384,
    ("quality", "offsamples"): 64,
    ("quality", "numslices"): 10_000,
    ("quality", "numstacks"): 10_000,
    ("quality", "numquads"): 1_000,
    ("camera", "resolution"): 16_384,
    ("mesh", "params"): 1_000,
    ("mesh", "maxhullvert"): 10 * _MILLION,
    ("lengthrange", "inttotal"): 1_000,
    ("lengthrange", "interval"): 1_000,
    ("general", "actdim"): 10_000,
    ("plugin", "actdim"): 10_000,
}
_MAX_COUNTS_ANYWHERE: Final[dict[str, int]] = {
    "nsample": 100_000,
    "count": 10_000,
    "cellcount": 1_000,
    "group": 1_000,
    **{f"nuser_{what}": 1_000 for what in ("body", "jnt", "geom", "site", "cam", "tendon", "actuator", "sensor")},
}
_MOST_PRODUCT: Final[dict[tuple[str, str], int]] = {
    ("hfield", "nrow"): 25 * _MILLION,
    ("texture", "width"): 64 * _MILLION,
    ("camera", "resolution"): 64 * _MILLION,
    ("mesh", "params"): 4 * _MILLION,
}
_TEXTS: Final = frozenset((
    "name", "class", "childclass", "prefix", "model", "key", "value", "data", "file", "content_type", "mesh",
    "material", "texture", "hfield", "joint", "joint1", "joint2", "body", "body1", "body2", "geom", "geom1",
    "geom2", "site", "site1", "site2", "frame", "camera", "tendon", "tendon1", "tendon2", "actuator", "flex",
    "target", "objname", "refname", "objtype", "reftype", "instance", "plugin", "refsite", "cranksite",
    "slidersite", "sidesite", "jointinparent", "node", "type",
))  # fmt: skip
"""Attributes that hold names, in which `nan` and `inf` are words like any other."""

_SHORTEST_STEP: Final = 1e-3
_LONGEST_STEP: Final = 100.0
_MEMORY_MOST: Final = 16 << 30


def check_bounds(root: Params, diagnostics: Diagnostics) -> None:
    """Records an error for each number that is none, and for each count beyond what is allowed."""
    counted = 0
    for element, times in _elements(root):
        counted += times
        if counted > MOST_ELEMENTS * 10 or times > MOST_ELEMENTS:
            _report_excess(element, "count", f"{times} copies", f"{MOST_ELEMENTS} elements in all", diagnostics)
            return
        for name, text in element.attributes.items():
            _check(element, name, text, diagnostics)


def _elements(root: Params) -> Iterator[tuple[Params, int]]:
    """Every element and how often replication makes it."""
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
    found = []
    for part in text.split():
        try:
            found.append(float(part))
        except ValueError:
            return []
    return found


def _check(element: Params, name: str, text: str, diagnostics: Diagnostics) -> None:
    if name in _TEXTS or name.startswith("file"):
        return
    if (element.name, name) == ("size", "memory"):
        _check_memory(element, text, diagnostics)
        return
    numbers = _numbers(text)
    bad = next((n for n in numbers if math.isnan(n)), None)
    if bad is not None or any(math.isinf(n) for n in numbers):
        diagnostics.error(
            "SK-MJCF-004",
            f"<{element.name} {name}={text!r}>: every number must be finite",
            element.where,
            "leave the attribute out where there is no limit",
        )
        return
    if (element.name, name) == ("lengthrange", "timestep") and numbers and numbers[0] < _SHORTEST_STEP:
        _report_excess(element, name, text, f"at least {_SHORTEST_STEP:g} s", diagnostics)
        return
    if (element.name, name) == ("option", "timestep") and numbers and not 1e-9 <= numbers[0] <= _LONGEST_STEP:
        _report_excess(element, name, text, f"1e-9 to {_LONGEST_STEP:g} s", diagnostics)
        return
    most = _MAX_COUNTS.get((element.name, name), _MAX_COUNTS_ANYWHERE.get(name))
    if most is not None and numbers and max(numbers) > most:
        _report_excess(element, name, text, f"at most {most}", diagnostics)
        return
    product = _MOST_PRODUCT.get((element.name, name))
    if product is not None:
        values = [*numbers, *_numbers(element.attribute({"nrow": "ncol", "width": "height"}.get(name, "")))]
        if math.prod(max(1.0, v) for v in values) > product:
            _report_excess(element, name, " x ".join(f"{v:g}" for v in values), f"{product} in all", diagnostics)


def _check_memory(element: Params, text: str, diagnostics: Diagnostics) -> None:
    digits, unit = text.strip()[:-1], text.strip()[-1:].upper()
    scale = {"K": 10, "M": 20, "G": 30, "T": 40, "P": 50, "E": 60}.get(unit)
    number = _numbers(text if scale is None else digits)
    if number and number[0] * float(1 << (scale or 0)) > _MEMORY_MOST:
        _report_excess(element, "memory", text, f"at most {_MEMORY_MOST >> 30}G", diagnostics)


def _report_excess(element: Params, name: str, found: str, allowed: str, diagnostics: Diagnostics) -> None:
    diagnostics.error("SK-MJCF-005", f"<{element.name} {name}>: found {found}, allowed is {allowed}", element.where)
