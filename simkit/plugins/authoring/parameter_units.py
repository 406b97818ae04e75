"""The unit of a parameter: what its author says of it in brackets, else what the words of its name say."""

from __future__ import annotations

import re

_SAID = re.compile(r"\[\s*([^\]\d'\"\[][^\]'\"\[]{0,15}?)\s*\]")
_UNITS = frozenset(
    [
        "m",
        "cm",
        "mm",
        "s",
        "ms",
        "Hz",
        "kg",
        "N",
        "N·m",
        "rad",
        "deg",
        "m/s",
        "rad/s",
        "m/s²",
        "rad/s²",
        "m/s^2",
        "rad/s^2",
        "K",
        "Pa",
        "V",
        "A",
        "W",
        "J",
        "T",
        "%",
        "m²",
        "1/s",
        "°C",
        "lx",
    ]
)
_WORD = re.compile(r"[A-Z]+(?=[A-Z][a-z])|[A-Z]?[a-z]+|[A-Z]+|\d+")
# The first rule that fits counts: words of the name, all of which must be there, and the unit they stand for.
_RULES: tuple[tuple[tuple[str, ...], str], ...] = (
    (("error",), ""),
    (("gain",), ""),
    (("covariance",), ""),
    (("count",), ""),
    (("samples",), ""),
    (("number",), ""),
    (("factor",), ""),
    (("ratio",), ""),
    (("scale",), ""),
    (("angular", "jerk"), "rad/s³"),
    (("jerk",), "m/s³"),
    (("angular", "acceleration"), "rad/s²"),
    (("wheel", "acceleration"), "m/s²"),
    (("linear", "acceleration"), "m/s²"),
    (("acceleration",), ""),
    (("angular", "velocity"), "rad/s"),
    (("angular", "vel"), "rad/s"),
    (("linear", "velocity"), "m/s"),
    (("linear", "vel"), "m/s"),
    (("steering", "angle"), "rad"),
    (("hz",), "Hz"),
    (("rate",), "Hz"),
    (("frequency",), "Hz"),
    (("torque",), "N·m"),
    (("force",), "N"),
    (("mass",), "kg"),
    (("separation",), "m"),
    (("radius",), "m"),
    (("diameter",), "m"),
    (("wheelbase",), "m"),
    (("wheel", "base"), "m"),
    (("length",), "m"),
    (("width",), "m"),
    (("height",), "m"),
    (("distance",), "m"),
    (("altitude",), "m"),
    (("latitude",), "deg"),
    (("longitude",), "deg"),
    (("timeout",), "s"),
    (("duration",), "s"),
    (("delay",), "s"),
    (("period",), "s"),
    (("time",), "s"),
    (("temperature",), "K"),
    (("temp",), "K"),
    (("xyz",), "m"),
    (("rpy",), "rad"),
    (("yaw",), "rad"),
    (("pitch",), "rad"),
    (("roll",), "rad"),
    (("angle",), "rad"),
)


def unit_of(name: str, kind: str, says: str = "", line: str = "") -> str:
    """The unit of a parameter.

    Args:
        name: of the element, `wheelSeparation` or `wheel_separation`.
        kind: its type; what is no number has no unit.
        says: what its author says of it, `distance of the wheels [m]`.
        line: the source line it is read at, whose comment may tell it.
    """
    if kind == "pose":
        return "m, rad"
    if kind not in {"number", "integer", "vector"}:
        return ""
    comment = line.split("#", 1)[1] if "#" in line else ""
    for text in (says, comment):
        found = _SAID.search(text)
        if found:
            return found[1]
        word = text.strip().split(" ")[0].rstrip(",;:.") if text is comment else ""
        if word in _UNITS:
            return word
    words = {word.lower() for word in _WORD.findall(name)}
    return next((unit for wanted, unit in _RULES if words.issuperset(wanted)), "")
