"""Parameters of a ROS node from a YAML file: values, lists of names or numbers, and blocks."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from typing import Literal, TypeVar

from simkit.diagnostics import Diagnostics, Where, did_you_mean
from simkit.number_text import counted
from simkit.params import Params

T = TypeVar("T")
Form = Literal["value", "nothing", "list", "block"]

_FORM_NAMES: Mapping[Form, str] = {"value": "a value", "nothing": "nothing", "list": "a list", "block": "a block"}


class ParameterBlock(Params):
    """Block of a parameter file that checks the form of each parameter: value, list or block.

    An unexpected form is an error at the line of the parameter, and the default is used. `Params` alone does not check
    this, because an XML element can contain both a text and a block. In YAML, `gains: 5` for a block is a mistake.

    Attributes:
        forms: form and location of each parameter, by name.
        is_block: whether this element is a block, not a value.
    """

    __slots__ = ("forms", "is_block")
    empty_is_default = False

    def __init__(
        self,
        name: str,
        text: str,
        children: Sequence[Params],
        where: Where,
        diagnostics: Diagnostics,
        forms: Mapping[str, tuple[Form, Where]],
        *,
        is_block: bool,
    ) -> None:
        super().__init__(name, text, children=children, where=where, diagnostics=diagnostics)
        self.forms, self.is_block = forms, is_block

    def joined(self, params: Params) -> ParameterBlock:
        """Return these parameters together with elements of other names."""
        names = {child.name for child in self.children}
        others = [child for child in params.children if child.name not in names]
        children = [*self.children, *others]
        return ParameterBlock(
            params.name, params.value, children, params.where, self.diagnostics, self.forms, is_block=True
        )

    def block(self, name: str) -> Params:
        if self._has_form(name, "a block of names with values", ("nothing", "block")):
            return super().block(name)
        self.child(name)
        return Params(name, where=self.where, diagnostics=self.diagnostics)

    def all(self, name: str) -> list[Params]:
        items = super().all(name)
        if not self._has_form(name, "a list", ("value", "nothing", "list")):
            for item in items:
                item.mark_all_read()
            return []
        for item in items:
            if isinstance(item, ParameterBlock) and item.is_block:
                self._bad(f"a block in the list {name!r}", "a value", item.where)
                item.mark_all_read()
        return [item for item in items if not (isinstance(item, ParameterBlock) and item.is_block)]

    def number(
        self,
        name: str,
        default: float | None = None,
        required: bool = False,
        minimum: float | None = None,
        maximum: float | None = None,
        finite: bool = True,
    ) -> float:
        if not self._is_single(name, "a number"):
            return 0.0 if default is None else default
        return super().number(name, default, required, minimum, maximum, finite)

    def vector(
        self, name: str, size: int, default: Sequence[float] | None = None, required: bool = False
    ) -> tuple[float, ...]:
        if self.forms.get(name, ("", None))[0] != "list":
            return super().vector(name, size, default, required)
        joined = " ".join(item.value for item in self.all(name))
        joined_item = Params(name, joined, where=self.forms[name][1], diagnostics=self.diagnostics)
        alone = Params(self.name, children=[joined_item], where=self.where, diagnostics=self.diagnostics)
        return alone.vector(name, size, default, required)

    def _numeral(self, found: Params, text: str) -> str:
        return text  # ROS refuses a truth value for a number

    def _as_written(self, name: str, value: str) -> str:
        return f"{name}: {value}" if value else f"{name} without a value"

    def _value(
        self, name: str, default: T | None, fallback: T, required: bool, parse: Callable[[Params], T], allowed: str
    ) -> T:
        if not self._is_single(name, allowed):
            return fallback if default is None else default
        return super()._value(name, default, fallback, required, parse, allowed)

    def _is_single(self, name: str, allowed: str) -> bool:
        if self._has_form(name, allowed, ("value", "nothing")):
            return True
        for item in self.children:
            if item.name == name:
                item.mark_all_read()
        return False

    def _has_form(self, name: str, allowed: str, expected: tuple[Form, ...]) -> bool:
        """Check whether a parameter is missing or has one of the expected forms; any other form is an error."""
        form, where = self.forms.get(name, (expected[0], self.where))
        if form in expected:
            return True
        description = _FORM_NAMES[form]
        if form == "value":
            description = repr(next(child.value for child in self.children if child.name == name))
        self._bad(f"{description} for {name!r}", allowed, where)
        return False


def read_numbers(params: Params, name: str, default: Sequence[float], minimum: float | None = None) -> list[float]:
    """Return the numbers of a list; if its length differs from the default's, report an error and use the default."""
    items = params.each(name)
    if not any(child.value for item in items for child in item.children):
        return list(default)
    numbers = [item.number(name, minimum=minimum) for item in items]
    if len(numbers) == len(default):
        return numbers
    items[0].error("SK-PARAM-002", f"found {counted(len(numbers), 'number')} in {name!r}; expected {len(default)}")
    return list(default)


def read_names(params: Params, name: str, *, required: bool = False, code: str = "SK-PARAM-002") -> list[str]:
    """Return the texts of a list; a duplicate is an error and is left out.

    Args:
        params: block that contains the list.
        name: name of the list.
        required: whether a missing or empty list is an error.
        code: code of the error about a duplicate.
    """
    before = params.diagnostics.error_count
    named = [item for item in params.all(name) if item.value or item.children]
    for k, item in enumerate(named):
        if item.value in [other.value for other in named[:k]]:
            item.error(code, f"{item.value!r} occurs twice in {name!r}; expected each name once")
    if required and not named and params.diagnostics.error_count == before:
        near = did_you_mean(name, [item.name for item in params.children if item.name != name])
        params.error("SK-PARAM-001", f"<{params.name}> needs <{name}>: a list of names", near)
    return list(dict.fromkeys(item.value for item in named))
