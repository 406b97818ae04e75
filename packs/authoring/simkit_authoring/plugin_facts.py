"""Description of a plugin class, found in its source: parameters with units, topics, services and actions."""

from __future__ import annotations

import re
from collections.abc import Iterable
from dataclasses import dataclass, replace

_NARROWER = ("", "block", "text")  # in the order of rank; all other kinds are more specific than these


@dataclass(frozen=True)
class Parameter:
    """Element (or attribute, `@name`) that a plugin reads.

    Attributes:
        path: names of the elements from the outermost to this one, below `<plugin>`.
        kind: "number", "integer", "boolean", "text", "vector", "pose", "choice", "block", or empty for an element
            without a value.
        default: value if the file does not have the element; a text may contain placeholders such as `{model}`.
        instead: names of the elements that are read if this element is missing.
        required: whether the file must have the element.
        minimum, maximum: bounds of a number.
        choices: allowed words.
        size: number of values in a vector.
        repeated: whether the element may occur several times.
        live: whether the parameter may change while the simulation runs.
        says: description from the plugin's source.
        unit: SI unit; empty if the unit is unknown or the parameter has none.
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
        name: name in the source; `~` is the plugin's own name, and a placeholder is in braces.
        types: ROS types; the list of topics shows the first of them.
        published: true if the plugin publishes the topic, false if it subscribes to the topic.
        latched: whether a new subscriber receives the last message.
        elements: parameters that change the name.
    """

    name: str
    types: tuple[str, ...]
    published: bool
    latched: bool = False
    elements: tuple[str, ...] = ()


@dataclass(frozen=True)
class Service:
    """Service or action of a plugin; `name` and `elements` have the same meaning as in `Topic`."""

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
    """Merge all parameters with the same path, in the order of reading; the most specific kind is used."""
    by_path: dict[tuple[str, ...], Parameter] = {}
    for parameter in read:
        if not parameter.path or "*" in parameter.path:  # the plugin reads all elements, with any name
            continue
        before = by_path.get(parameter.path)
        by_path[parameter.path] = parameter if before is None else _both(before, parameter)
    for path in list(by_path):
        for depth in range(1, len(path)):
            above = by_path.get(path[:depth])
            if above is None or not above.kind:
                repeated = above.repeated if above else False
                by_path[path[:depth]] = Parameter(path[:depth], "block", repeated=repeated)
    order = sorted(by_path, key=lambda p: [list(by_path).index(p[: d + 1]) for d in range(len(p))])
    return tuple(by_path[path] for path in order)


def _both(earlier: Parameter, later: Parameter) -> Parameter:
    first, second = (earlier, later) if _rank(earlier.kind) >= _rank(later.kind) else (later, earlier)
    same_kind = first.kind == second.kind
    return replace(
        first,
        default=first.default if first.default is not None or not same_kind else second.default,
        instead=tuple(dict.fromkeys((*first.instead, *(second.instead if same_kind else ())))),
        # a plugin may read an optional element first, and read it again with required=True in some cases
        required=first.required or second.required,
        repeated=first.repeated or second.repeated,
        live=first.live or second.live,
        says=first.says or second.says,
        choices=tuple(dict.fromkeys((*first.choices, *second.choices))),
    )


def merged_topics(topics: Iterable[Topic]) -> tuple[Topic, ...]:
    """Merge all entries of the same topic to one entry with all parameters that may change the topic's name."""
    table: dict[tuple[str, tuple[str, ...], bool], Topic] = {}
    for topic in topics:
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
# Each row is a unit and the names that imply the unit. A name matches if the element's name contains all its words. The
# first row with a match is used.
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
    """Return the unit of a parameter from its description, from a comment or from its name.

    Args:
        name: name of the element, such as `wheelSeparation` or `wheel_separation`.
        kind: kind of the parameter; only a number, vector or pose has a unit.
        says: description from the plugin's source, such as `distance of the wheels [m]`.
        line: source line that reads the parameter; a comment in this line may contain the unit.
    """
    if kind == "pose":
        return "m, rad"
    if kind not in {"number", "integer", "vector"}:
        return ""
    comment = line.split("#", 1)[1] if "#" in line else ""
    for text in (says, comment):
        said = _SAID.search(text)
        if said:
            return said[1]
        word = text.strip().split(" ")[0].rstrip(",;:.") if text is comment else ""
        if word in _UNITS:
            return word
    words = {word.lower() for word in _WORD.findall(name)}
    return next((unit for unit, names in _RULES if any(words.issuperset(name.split()) for name in names)), "")
