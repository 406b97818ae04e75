"""What a function of the language is."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from typing import TYPE_CHECKING, Final

from simkit.conditions.parts import Part
from simkit.conditions.syntax import Call, Name, Text

if TYPE_CHECKING:
    from simkit.conditions.binding import Binder

Maker = Callable[["Binder", Call], Part]
MANY: Final = 100
"""Arguments of a function that takes any number of them."""


@dataclass(frozen=True)
class Function:
    """One function.

    Attributes:
        usage: how it is written.
        least, most: arguments that it takes.
        make: binds a call of it.
    """

    usage: str
    least: int
    most: int
    make: Maker


def text_argument(binder: Binder, call: Call, place: int, what: str) -> Text:
    """An argument that is a name in quotes.

    Raises:
        InputError: SK-COND-004 it is something else.
    """
    node = call.arguments[place]
    if isinstance(node, Text):
        return node
    source = node.span.text(binder.source)
    hint = f"names stand in quotes: {call.name}('{source}')" if isinstance(node, Name) else ""
    message = f"{call.name} wants {what} in quotes, and is given {source}"
    raise binder.fault("SK-COND-004", message, node.span, hint)
