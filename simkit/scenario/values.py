"""Plain values of a document: texts, truths and numbers; what is none is told with its line."""

from __future__ import annotations

import math
from collections.abc import Mapping
from typing import Any

from simkit.scenario.document import Document, shown
from simkit.sinks.yaml_text import finite_number


class Values:
    """Reads plain values of a document.

    Args:
        document: it is told what is wrong.
        said: its values at the top, by key.
    """

    def __init__(self, document: Document, said: Mapping[str, Any]) -> None:
        self._document, self._said = document, said

    def _wrong(self, value: Any, allowed: str, *keys: Any) -> None:
        label = ".".join(str(key) for key in keys)
        self._document.error("SK-SCEN-003", f"{label}: found {shown(value)}, allowed is {allowed}", *keys)

    def _text(self, key: str, default: str) -> str:
        value = self._said.get(key, default)
        if isinstance(value, str) and (value.strip() or value == default):
            return value
        self._wrong(value, "a text", key)
        return default

    def _flag(self, key: str, default: bool) -> bool:
        value = self._said.get(key, default)
        if isinstance(value, bool):
            return value
        self._wrong(value, "true or false", key)
        return default

    def _number(
        self, key: str, default: float | None, *, least: float = -math.inf, above: float = -math.inf
    ) -> float | None:
        return self._number_of(self._said.get(key, default), default, (key,), least=least, above=above)

    def _number_of(
        self,
        value: Any,
        default: float | None,
        keys: tuple[Any, ...],
        *,
        least: float = -math.inf,
        above: float = -math.inf,
    ) -> float | None:
        if value is default:  # nothing was said
            return None if value is None else float(value)
        number = finite_number(value)
        if number is not None and number >= least and number > above:
            return number
        bound = f" of at least {least:g}" if least > -math.inf else f" above {above:g}" if above > -math.inf else ""
        self._wrong(value, f"a number{bound}", *keys)
        return default

    def _whole(self, key: str, default: int, least: int) -> int:
        value = self._said.get(key, default)
        if isinstance(value, int) and not isinstance(value, bool) and value >= least:
            return value
        self._wrong(value, f"a whole number of at least {least}", key)
        return default

    def _texts(self, key: str) -> tuple[str, ...]:
        value = self._said.get(key, ())
        listed = [value] if isinstance(value, str) else value
        if isinstance(listed, (list, tuple)) and all(isinstance(one, str) and one.strip() for one in listed):
            return tuple(listed)
        self._wrong(value, "a text, or a list of them", key)
        return ()

    def _mapping(self, key: str) -> dict[str, Any]:
        value = self._said.get(key, {})
        if isinstance(value, dict) and all(isinstance(one, str) for one in value):
            return value
        self._wrong(value, "a mapping with texts before the colons", key)
        return {}
