"""The unit of a parameter: what its author says of it in brackets, else what the words of its name say."""

from __future__ import annotations

import re

_SAID = re.compile(r"\[\s*([^\]\d'\"\[][^\]'\"\[]{0,15}?)\s*\]")
_KNOWN = "m cm mm s ms Hz kg N N·m rad deg m/s rad/s m/s² rad/s² m/s^2 rad/s^2 K Pa V A W J T % m² 1/s °C lx"
_UNITS = frozenset(_KNOWN.split())
_WORD = re.compile(r"[A-Z]+(?=[A-Z][a-z])|[A-Z]?[a-z]+|[A-Z]+|\d+")
# Each row is a unit and the names that stand for it; all words of a name must be there. The first row that fits counts.
_RULES: tuple[tuple[str, tuple[str, ...]], ...] = (
    ("", ("error", "gain", "covariance", "count", "samples", "number", "factor", "ratio", "scale")),
    ("rad/s³", ("angular jerk",)),
    ("m/s³", ("jerk",)),
    ("rad/s²", ("angular acceleration",)),
    ("m/s²", ("wheel acceleration", "linear acceleration")),
    ("", ("acceleration",)),
    ("rad/s", ("angular velocity", "angular vel")),
    ("m/s", ("linear velocity", "linear vel")),
    ("rad", ("steering angle",)),
    ("Hz", ("hz", "rate", "frequency")),
    ("N·m", ("torque",)),
    ("N", ("force",)),
    ("kg", ("mass",)),
    ("m", ("separation", "radius", "diameter", "wheelbase", "wheel base", "length", "width", "height", "distance")),
    ("m", ("altitude",)),
    ("deg", ("latitude", "longitude")),
    ("s", ("timeout", "duration", "delay", "period", "time")),
    ("K", ("temperature", "temp")),
    ("m", ("xyz",)),
    ("rad", ("rpy", "yaw", "pitch", "roll", "angle")),
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
    return next((unit for unit, names in _RULES if any(words.issuperset(name.split()) for name in names)), "")
