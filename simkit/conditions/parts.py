"""Parts of an expression that are bound to a world: what each is now, and how that is told."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

from simkit.conditions.faults import Undecided
from simkit.conditions.kinds import NUMBER, TEXT, TRUTH, Kind
from simkit.conditions.syntax import Arithmetic, Comparison, Junction, Name, Node, Not, Number, Sign, Text

if TYPE_CHECKING:
    from simkit.conditions.feeds import Feed

_MOST_SHOWN = 6  # items of a list


@dataclass(frozen=True, slots=True)
class Part:
    """A part of an expression.

    Attributes:
        node: where it stands.
        kind: of its value.
        get: its value now; raises Undecided where it has none.
        below: the parts that it is made of.
        feed: where it comes from one topic's newest message and nothing else, that one.
        tell: more about its value, in words.
    """

    node: Node
    kind: Kind
    get: Callable[[], Any]
    below: tuple[Part, ...] = ()
    feed: Feed | None = None
    tell: Callable[[], str] | None = None


def shown(value: Any) -> str:
    """A value as a report has it."""
    if value is True or value is False:
        return "true" if value else "false"
    if isinstance(value, (int, float)):
        return f"{value:.6g}"
    if isinstance(value, str):
        return repr(value)
    if hasattr(value, "rpy"):
        return f"({_joined(value.position)}; {_joined(value.rpy)})"
    if hasattr(value, "__len__"):
        return f"({_joined(value)})" if len(value) <= _MOST_SHOWN else f"{len(value)} values"
    return f"a {getattr(value, '__msgtype__', type(value).__name__)}"


def _joined(values: Any) -> str:
    return ", ".join(shown(v.item() if hasattr(v, "item") else v) for v in values)


def findings(source: str, part: Part, *, wanted: bool = True) -> list[str]:
    """The values that make a condition hold or not: `min(scan('/scan')) was 0.098`.

    Args:
        source: the expression.
        part: true or false.
        wanted: what it should have been.
    """
    told: dict[str, None] = {}
    _find(source, part, wanted, told)
    if not told:  # nothing in it changes: `1 > 2`
        _tell(source, part, told)
    return list(told)


def _find(source: str, part: Part, wanted: bool, told: dict[str, None]) -> None:
    node = part.node
    if isinstance(node, Not):
        _find(source, part.below[0], not wanted, told)
    elif isinstance(node, Junction):
        # of what has to hold all together only what does not is of interest; else all of it
        is_all = (node.word == "and") == wanted
        for operand in part.below:
            if not is_all or _now(operand) is not wanted:
                _find(source, operand, wanted, told)
    elif isinstance(node, Comparison):
        for operand in part.below:
            if not _is_plain(operand.node):
                _tell(source, operand, told)
    else:
        _tell(source, part, told)


def _tell(source: str, part: Part, told: dict[str, None]) -> None:
    text = part.node.span.text(source)
    try:
        told[f"{text} was {shown(part.get())}{part.tell() if part.tell is not None else ''}"] = None
    except Undecided as reason:
        told[f"{text} is not known: {reason}"] = None


def _now(part: Part) -> Any:
    try:
        return part.get()
    except Undecided:
        return None


def _is_plain(node: Node) -> bool:
    """Whether it stands there as it is."""
    if isinstance(node, Sign):
        return _is_plain(node.operand)
    if isinstance(node, Arithmetic):
        return _is_plain(node.left) and _is_plain(node.right)
    return isinstance(node, (Number, Text)) or (isinstance(node, Name) and node.name not in ("time", "tick"))


def is_scalar(kind: Kind) -> bool:
    """Whether two values of a kind can be equal."""
    return kind in (NUMBER, TRUTH, TEXT)
