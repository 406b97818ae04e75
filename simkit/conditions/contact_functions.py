"""Functions of who touches whom."""

from __future__ import annotations

from typing import TYPE_CHECKING, Final

from simkit.conditions.function import Function, text_argument
from simkit.conditions.kinds import NUMBER, TRUTH
from simkit.conditions.parts import Part
from simkit.conditions.syntax import Call

if TYPE_CHECKING:
    from simkit.conditions.binding import Binder
    from simkit.conditions.touching import Touching


def _touching(binder: Binder, call: Call) -> Touching:
    from simkit.conditions.touching import Touching

    nodes = [
        text_argument(binder, call, place, "the name of a model or a link") for place in range(len(call.arguments))
    ]
    names = [binder.view.scoped(node.value, binder.source, node.span) for node in nodes]
    return Touching(binder.view.sim, *names)


def _contact(binder: Binder, call: Call) -> Part:
    touching = _touching(binder, call)

    def tell() -> str:
        found = touching.describe()
        return f" ({found})" if found else ""

    return Part(call, TRUTH, lambda: bool(touching.now()), tell=tell)


def _contacts(binder: Binder, call: Call) -> Part:
    touching = _touching(binder, call)
    return Part(call, NUMBER, lambda: float(len(touching.now())))


def _contact_force(binder: Binder, call: Call) -> Part:
    return Part(call, NUMBER, _touching(binder, call).force)


CONTACT_FUNCTIONS: Final[dict[str, Function]] = {
    "contact": Function("contact('model or link'[, 'another'])", 1, 2, _contact),
    "contacts": Function("contacts('model or link'[, 'another'])", 1, 2, _contacts),
    "contact_force": Function("contact_force('model or link'[, 'another'])", 1, 2, _contact_force),
}
