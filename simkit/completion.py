"""Names that completion in a shell or a notebook lists for an object."""

from __future__ import annotations

from typing import ClassVar


class Completed:
    """Base class of objects with methods for simkit's own code, which completion and the reference leave out."""

    __slots__ = ()

    _internal_names: ClassVar[frozenset[str]] = frozenset()

    def __dir__(self) -> list[str]:
        return sorted({*super().__dir__()} - self._internal_names)
