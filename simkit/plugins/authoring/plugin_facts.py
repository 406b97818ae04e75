"""What a plugin class reads, publishes, listens to and offers, as its code says, and the units of its parameters."""

from __future__ import annotations

import re
from collections.abc import Iterable
from dataclasses import dataclass, replace

_NARROWER = ("", "block", "text")  # any other kind is narrower still


@dataclass(frozen=True)
class Parameter:
    """One element (or attribute, `@name`) that a plugin reads.

    Attributes:
        path: names of the elements, from the plugin down.
        kind: "number", "integer", "boolean", "text", "vector", "pose", "choice", "block", or empty where the element
            is taken without a value.
        default: what holds where the file says nothing; a text may have holes such as `{model}`.
        instead: elements that are taken where this one is not there.
        required: whether the file must have it.
        minimum, maximum: bounds of a number.
        choices: the words allowed.
        size: how many numbers a vector has.
        repeated: whether every element of that name counts.
        live: whether it may be changed while the simulation runs.
        says: what its author says of it.
        unit: SI unit; empty where it has none or nothing tells it.
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
        """`odometry_noise/radius`."""
        return "/".join(self.path)


@dataclass(frozen=True)
class Topic:
    """A topic of a plugin.

    Attributes:
        name: as the code names it; `~` is the plugin's own name, holes are in braces.
        types: ROS types; the first is the listed one.
        published: whether it goes out; else it is listened to.
        latched: whether a later subscriber gets the last message.
        elements: the parameters that change the name.
    """

    name: str
    types: tuple[str, ...]
    published: bool
    latched: bool = False
    elements: tuple[str, ...] = ()


@dataclass(frozen=True)
class Service:
    """A service or an action of a plugin; see `Topic`."""

    name: str
    type: str
    elements: tuple[str, ...] = ()
    is_action: bool = False


@dataclass(frozen=True)
class Facts:
    """What the code of a plugin class says."""

    parameters: tuple[Parameter, ...] = ()
    topics: tuple[Topic, ...] = ()
    services: tuple[Service, ...] = ()


def merged(read: Iterable[Parameter]) -> tuple[Parameter, ...]:
    """One entry for each element, in the order of reading: what is read twice is known by its narrower type."""
    found: dict[tuple[str, ...], Parameter] = {}
    for parameter in read:
        if not parameter.path or "*" in parameter.path:  # whatever is there: no name to be told
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


def _both(one: Parameter, other: Parameter) -> Parameter:
    first, second = (one, other) if _rank(one.kind) >= _rank(other.kind) else (other, one)
    same_kind = first.kind == second.kind
    return replace(
        first,
        default=first.default if first.default is not None or not same_kind else second.default,
        instead=tuple(dict.fromkeys((*first.instead, *(second.instead if same_kind else ())))),
        # asked for once more where it turned out to be missing, it is required either way
        required=first.required or second.required,
        repeated=first.repeated or second.repeated,
        live=first.live or second.live,
        says=first.says or second.says,
        choices=tuple(dict.fromkeys((*first.choices, *second.choices))),
    )


def merged_topics(found: Iterable[Topic]) -> tuple[Topic, ...]:
    """Each topic once, with all the parameters that may name it."""
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
