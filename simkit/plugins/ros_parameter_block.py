"""Parameters of a ROS node as its YAML has them: values, lists of names or numbers, and blocks."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from typing import Literal, TypeVar

from simkit.diagnostics import Diagnostics, Where, did_you_mean
from simkit.params import Params

T = TypeVar("T")
Form = Literal["value", "nothing", "list", "block"]

_FORM_NAMES: Mapping[Form, str] = {"value": "a value", "nothing": "nothing", "list": "a list", "block": "a block"}


class ParameterBlock(Params):
    """One element of a parameter file, which knows in what form each of its names is written.

    A name in another form than its reader wants is an error at its line, and the default is taken: in XML an element
    can be both text and block, in YAML `gains: 5` is a mistake that nobody would see.

    Attributes:
        forms: in which form a name is written, and where.
        is_block: whether it is one itself.
    """

    __slots__ = ("forms", "is_block")

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

    def block(self, name: str) -> Params:
        if self._is_in("block", name, "a block of names with values", ("nothing", "block")):
            return super().block(name)
        self.child(name)
        return Params(name, where=self.where, diagnostics=self.diagnostics)

    def all(self, name: str) -> list[Params]:
        found = super().all(name)
        if not self._is_in("list", name, "a list", ("value", "nothing", "list")):
            for one in found:
                one.mark_all_read()
            return []
        for one in found:
            if isinstance(one, ParameterBlock) and one.is_block:
                self._bad(f"a block in the list {name!r}", "a value", one.where)
                one.mark_all_read()
        return [one for one in found if not (isinstance(one, ParameterBlock) and one.is_block)]

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
        joined = " ".join(one.value for one in self.all(name))
        whole = Params(name, joined, where=self.forms[name][1], diagnostics=self.diagnostics)
        alone = Params(self.name, children=[whole], where=self.where, diagnostics=self.diagnostics)
        return alone.vector(name, size, default, required)

    def _as_written(self, name: str, value: str) -> str:
        return f"{name}: {value}" if value else f"{name} without a value"

    def _value(
        self, name: str, default: T | None, fallback: T, required: bool, parse: Callable[[Params], T], allowed: str
    ) -> T:
        if not self._is_single(name, allowed):
            return fallback if default is None else default
        return super()._value(name, default, fallback, required, parse, allowed)

    def _is_single(self, name: str, allowed: str) -> bool:
        if self._is_in("value", name, allowed, ("value", "nothing")):
            return True
        for one in self.children:
            if one.name == name:
                one.mark_all_read()
        return False

    def _is_in(self, wanted: str, name: str, allowed: str, fitting: tuple[Form, ...]) -> bool:
        """Check whether a name is written in a form that fits (or not at all); what does not is reported."""
        form, where = self.forms.get(name, (fitting[0], self.where))
        if form in fitting:
            return True
        told = _FORM_NAMES[form]
        if form == "value":
            told = repr(next(one.value for one in self.children if one.name == name))
        self._bad(f"{told} for {name!r}", allowed, where)
        return False


def read_numbers(params: Params, name: str, default: Sequence[float], minimum: float | None = None) -> list[float]:
    """The numbers of a list; one of another length than the default's is an error, and the default is taken."""
    given = params.each(name)
    if not any(child.value for one in given for child in one.children):
        return list(default)
    found = [one.number(name, minimum=minimum) for one in given]
    if len(found) == len(default):
        return found
    message = f"found {len(found)} numbers in {name!r}, allowed are {len(default)}"
    params.diagnostics.error("SK-PARAM-002", message, given[0].where)
    return list(default)


def read_names(params: Params, name: str, *, required: bool = False, code: str = "SK-PARAM-002") -> list[str]:
    """The texts of a list; one that comes twice is an error, as two claims of one interface are.

    Args:
        params: where it stands.
        name: of the list.
        required: whether it is an error that there is none, or nothing in it.
        code: of the error about a name that comes twice.
    """
    before = params.diagnostics.error_count
    found = [one for one in params.all(name) if one.value or one.children]
    for k, one in enumerate(found):
        if one.value in [other.value for other in found[:k]]:
            message = f"{one.value!r} comes twice in {name!r}, allowed is each name once"
            params.diagnostics.error(code, message, one.where)
    if required and not found and params.diagnostics.error_count == before:
        near = did_you_mean(name, [one.name for one in params.children if one.name != name])
        params.error("SK-PARAM-001", f"<{params.name}> needs <{name}>: a list of names", near)
    return list(dict.fromkeys(one.value for one in found))
