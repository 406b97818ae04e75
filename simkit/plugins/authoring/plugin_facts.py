"""Facts about a plugin class from its code: parameters with units, topics, services and actions."""

from __future__ import annotations

import re
from collections.abc import Iterable
from dataclasses import dataclass, replace

_NARROWER = ("", "block", "text")  # from vague to specific; any other kind is more specific


@dataclass(frozen=True)
class Parameter:
    """Element (or attribute, `@name`) that a plugin reads.

    Attributes:
        path: names of the elements, from the plugin down.
        kind: "number", "integer", "boolean", "text", "vector", "pose", "choice", "block", or empty for an element
            without a value.
        default: value if the file has none; a text may have placeholders such as `{model}`.
        instead: elements that are read if this element is missing.
        required: whether the file must have the element.
        minimum, maximum: bounds of a number.
        choices: allowed words.
        size: number of values in a vector.
        repeated: whether the element may occur several times.
        live: whether the parameter may change while the simulation runs.
        says: description by the author.
        unit: SI unit; empty if unknown or without unit.
    """

    path: tuple[str, ...]
    kind: str
    default: object = None
    instead: tuple[str, ...] = ()
    required: bool = False
    minimum: float | None = None
    maximum: float | None = None
    choices: tuple[str, ...] = ()
    size: int | None = None
    repeated: bool = False
    live: bool = False
    says: str = ""
    unit: str = ""

    @property
    def name(self) -> str:
        """Path as text, such as `odometry_noise/radius`."""
        return "/".join(self.path)


@dataclass(frozen=True)
class Topic:
    """Topic of a plugin.

    Attributes:
        name: name in the code; `~` is the plugin's own name, placeholders are in braces.
        types: ROS types; the first is the type that is listed.
        published: whether the plugin publishes the topic; otherwise it subscribes.
        latched: whether a later subscriber gets the last message.
        elements: parameters that change the name.
    """

    name: str
    types: tuple[str, ...]
    published: bool
    latched: bool = False
    elements: tuple[str, ...] = ()


@dataclass(frozen=True)
class Service:
    """Service or action of a plugin; see `Topic`."""

    name: str
    type: str
    elements: tuple[str, ...] = ()
    is_action: bool = False


@dataclass(frozen=True)
class Facts:
    """Parameters, topics, services and actions of a plugin class."""

    parameters: tuple[Parameter, ...] = ()
    topics: tuple[Topic, ...] = ()
    services: tuple[Service, ...] = ()


def merged(read: Iterable[Parameter]) -> tuple[Parameter, ...]:
    """Merge parameters to one entry per element, in the order of reading; the most specific type wins."""
    found: dict[tuple[str, ...], Parameter] = {}
    for parameter in read:
        if not parameter.path or "*" in parameter.path:  # the plugin reads all elements, whatever their names
            continue
        before = found.get(parameter.path)
        found[parameter.path] = parameter if before is None else _both(before, parameter)
    for path in list(found):
        for depth in range(1, len(path)):
            above = found.get(path[:depth])
            if above is None or not above.kind:
                repeated = above.repeated if above else False
                found[path[:depth]] = Parameter(path[:depth], "block", repeated=repeated)
    order = sorted(found, key=lambda p: [list(found).index(p[: d + 1]) for d in range(len(p))])
    return tuple(found[path] for path in order)


def _both(earlier: Parameter, later: Parameter) -> Parameter:
    first, second = (earlier, later) if _rank(earlier.kind) >= _rank(later.kind) else (later, earlier)
    same_kind = first.kind == second.kind
    return replace(
        first,
        default=first.default if first.default is not None or not same_kind else second.default,
        instead=tuple(dict.fromkeys((*first.instead, *(second.instead if same_kind else ())))),
        # a second read with required=True, after the element was found missing, makes it required
        required=first.required or second.required,
        repeated=first.repeated or second.repeated,
        live=first.live or second.live,
        says=first.says or second.says,
        choices=tuple(dict.fromkeys((*first.choices, *second.choices))),
    )


def merged_topics(found: Iterable[Topic]) -> tuple[Topic, ...]:
    """Merge topics to one entry each, with all the parameters that may change its name."""
    table: dict[tuple[str, tuple[str, ...], bool], Topic] = {}
    for topic in found:
        key = (topic.name, topic.types, topic.published)
        before = table.get(key, topic)
        elements = tuple(dict.fromkeys((*before.elements, *topic.elements)))
        table[key] = replace(before, elements=elements, latched=before.latched or topic.latched)
    return tuple(table.values())


def _rank(kind: str) -> int:
    return _NARROWER.index(kind) if kind in _NARROWER else len(_NARROWER)


_SAID = re.compile(r"\[\s*([^\]\d'\"\[][^\]'\"\[]{0,15}?)\s*\]")
_KNOWN = "m cm mm s ms Hz kg N N·m rad deg m/s rad/s m/s² rad/s² m/s^2 rad/s^2 K Pa V A W J T % m² 1/s °C lx"
_UNITS = frozenset(_KNOWN.split())
_WORD = re.compile(r"[A-Z]+(?=[A-Z][a-z])|[A-Z]?[a-z]+|[A-Z]+|\d+")
# Each row is a unit and the names that imply it; an element must contain all words of a name. The first match wins.
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
    """Return the unit of a parameter.

    Args:
        name: name of the element, `wheelSeparation` or `wheel_separation`.
        kind: type of the parameter; only numbers have a unit.
        says: description by the author, `distance of the wheels [m]`.
        line: source line that reads the parameter; its comment may state the unit.
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
