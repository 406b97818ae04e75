"""What a plugin asks of its parameters, and what it opens to the world: the calls that are looked for."""

from __future__ import annotations

from collections.abc import Callable
from typing import TYPE_CHECKING, Any, Final

from simkit.plugins.authoring.abstract_values import Block, Either, Given, Hole, alternatives, either, noun, text_of
from simkit.plugins.authoring.plugin_facts import Parameter, Service, Topic, plain_default, topic_name

if TYPE_CHECKING:
    from simkit.plugins.authoring.source_interpreter import Interpreter

_READS: Final = {"text", "number", "integer", "boolean", "vector", "vector3", "pose", "choice"}
_OF_GZ: Final = {
    "get_string": "text",
    "get_bool": "boolean",
    **dict.fromkeys(("get_int", "get_uint", "get_uint64"), "integer"),
    **dict.fromkeys(("get_double", "get_float", "get_angle"), "number"),
    **dict.fromkeys(("get_vector2d", "get_vector2i", "get_vector3d", "get_quaterniond", "get_color"), "vector"),
    "get_pose": "pose",
}
"""How systems of gz read, and the types of that."""
OPENS: Final = {"advertise", "listen", "offer", "act", "declare"}


class Asked:
    """Notes reads, topics and services.

    Args:
        reader: where they are noted.
        product_types: gives the types that sensors publish, by the names of their products.
    """

    def __init__(self, reader: Interpreter, product_types: Callable[[], dict[str, tuple[str, ...]]]) -> None:
        self._reader, self._product_types = reader, product_types

    def of_params(self, block: Block, name: str, args: list[Any], named: dict[str, Any], line: str) -> Any:
        """A typed read of a `Params`."""
        asked = args[0] if args else named.get("name", "…")
        if isinstance(asked, Either):
            return either(*(self.of_params(block, name, [one, *args[1:]], named, line) for one in asked.values))
        element = text_of(asked)
        path = (*block.path, element)
        if name in _OF_GZ:
            read = self._read(block, _OF_GZ[name], path, args[1:], named, line) if args else Given(block.path, None)
            return (read, Hole("value")) if len(args) > 1 else read
        if name in {"find_element", "get_element", "has_element"}:
            name = "block" if name != "has_element" else "has"
        if name in _READS:
            return self._read(block, name, path, args[1:], named, line)
        if name == "each":
            return [Block(block.path, many=True)]
        if name in {"child", "block", "all", "has"}:
            many = name == "all" or block.many
            self.note(Parameter(path, "", repeated=name == "all", line=line))
            inside = Block(path, many)
            return [inside] if name == "all" else (Hole("value") if name == "has" else inside)
        if name == "attribute":
            default = args[1] if len(args) > 1 else named.get("default", "")
            self.note(Parameter((*block.path, f"@{element}"), "text", plain_default(default)[0], line=line))
            return Given((*block.path, f"@{element}"), default)
        if name == "as_pose":
            self.note(Parameter(block.path, "pose", repeated=block.many, line=line))
        if name == "first_of":
            self.note(Parameter(block.path, "vector", size=_whole(args[:1]), repeated=block.many, line=line))
        return Hole("value")

    def _read(
        self, block: Block, kind: str, path: tuple[str, ...], args: list[Any], named: dict[str, Any], line: str
    ) -> Any:
        is_plain = kind == "vector" and args and not isinstance(args[0], int)
        order = _ORDER.get("pose" if is_plain else kind, ("default", "required", "minimum", "maximum"))
        said = {**dict(zip(order, args, strict=False)), **named}
        default, instead = plain_default(said.get("default"))
        size = 3 if kind == "vector3" else _whole([said.get("size")])
        allowed = said.get("allowed", ())
        choices = tuple(map(text_of, allowed)) if isinstance(allowed, (list, tuple)) else ()
        self.note(
            Parameter(
                path,
                "vector" if kind == "vector3" else kind,
                default,
                instead,
                said.get("required") is True,
                _bound(said.get("minimum")),
                _bound(said.get("maximum")),
                choices,
                size,
                block.many and not block.path,
                line=line,
            )
        )
        return Given(path, said.get("default"))

    def unknown(self, label: str, args: list[Any], named: dict[str, Any]) -> Any:
        """A call of something that only a run has; what it is called tells whether it opens something."""
        name = label.rsplit(".", 1)[-1]
        opens = {
            "advertise": self._advertise,
            "listen": self._listen,
            "offer": self._offer,
            "act": self._offer,
            "declare": self._declare,
            "publish_on": self.publish_on,
        }
        if name in opens:
            return opens[name](name, args, named)
        if name == "topic" and args:
            return args[0]
        return Hole(noun(name))

    def _advertise(self, _: str, args: list[Any], named: dict[str, Any]) -> Any:
        topic, kind = _two(args, named, "topic", "type_name")
        for one in alternatives(topic):
            name, changed = topic_name(one)
            types = tuple(text_of(k) for k in alternatives(kind))
            self._reader.topics.append(Topic(name, types, True, named.get("latched") is True, changed))
        return Hole("publisher")

    def _listen(self, _: str, args: list[Any], named: dict[str, Any]) -> Any:
        topic, kind = _two(args, named, "topic", "types")
        kinds = kind if isinstance(kind, (tuple, list)) else alternatives(kind)
        for one in alternatives(topic):
            name, changed = topic_name(one)
            self._reader.topics.append(Topic(name, tuple(map(text_of, kinds)), False, False, changed))
        return Hole("listener")

    def publish_on(self, _: str, args: list[Any], named: dict[str, Any]) -> Any:
        """A sensor is told where to publish."""
        for product, topic in args[0].items() if args and isinstance(args[0], dict) else ():
            for one in alternatives(topic):
                name, changed = topic_name(one)
                self._reader.topics.append(Topic(name, self._product_types().get(product, ()), True, False, changed))

    def _offer(self, what: str, args: list[Any], named: dict[str, Any]) -> Any:
        service, kind = _two(args, named, "action" if what == "act" else "service", "type_name")
        for one in alternatives(service):
            name, changed = topic_name(one)
            self._reader.services.append(Service(name, text_of(kind), changed, what == "act"))
        return Hole("service")

    def _declare(self, _: str, args: list[Any], named: dict[str, Any]) -> Any:
        said = {**dict(zip(("name", "default"), args, strict=False)), **named}
        default, instead = plain_default(said.get("default"))
        value = said.get("default")
        while isinstance(value, Given):
            value = value.default
        kinds = ((bool, "boolean"), (int, "integer"), (float, "number"), (tuple, "vector"), (str, "text"))
        kind = next((kind for type_, kind in kinds if isinstance(value, type_)), "number")
        choices = said.get("choices", ())
        self.note(
            Parameter(
                (text_of(said.get("element") or said.get("name", "…")),),
                "choice" if choices and kind == "text" else kind,
                default,
                instead,
                minimum=_bound(said.get("minimum")),
                maximum=_bound(said.get("maximum")),
                choices=tuple(map(text_of, choices)) if isinstance(choices, (list, tuple)) else (),
                size=len(value) if isinstance(value, tuple) else None,
                live=True,
                says=text_of(said.get("description", "")),
            )
        )
        return Hole("parameter")

    def note(self, parameter: Parameter) -> None:
        self._reader.parameters.append(parameter)


_ORDER: Final[dict[str, tuple[str, ...]]] = {
    "vector": ("size", "default", "required"),
    "choice": ("allowed", "default", "required"),
    "pose": ("default",),
}


def _two(args: list[Any], named: dict[str, Any], first: str, second: str) -> tuple[Any, Any]:
    """The first two arguments, by place or by name."""
    given = {**named, **dict(zip((first, second), args, strict=False))}
    return given.get(first), given.get(second)


def _whole(values: list[Any]) -> int | None:
    return values[0] if values and isinstance(values[0], int) else None


def _bound(value: Any) -> float | None:
    return float(value) if isinstance(value, (int, float)) and not isinstance(value, bool) else None
