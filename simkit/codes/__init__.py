"""The catalogue of diagnostic codes: what each means, what helps, and an input that brings it about.

One module an area, each with `CODES: tuple[Code, ...]`; `docs/diagnostics.md` is written from them, `simkit explain`
prints one, and a test runs every example. A code keeps its meaning for ever and is never given to another.
"""

from __future__ import annotations

import importlib
import pkgutil
from collections.abc import Mapping
from dataclasses import dataclass, field
from functools import lru_cache
from types import MappingProxyType
from typing import Literal

Kind = Literal["xml", "command", "python"]


@dataclass(frozen=True, slots=True)
class Example:
    """An input that brings a code about.

    Attributes:
        text: `xml`: a file that `simkit check` is given (SDF, URDF, ...); `command`: a line for the shell, beginning
            with `simkit`, run in an empty folder that holds `files`; `python`: a script run there, which prints the
            code, lets the error that carries it pass, or leaves it in a simulation called `sim`.
        kind: how `text` is run.
        files: further files by relative path, text or bytes.
        suffix: of the file that `text` becomes, for `xml`.
    """

    text: str
    kind: Kind = "xml"
    files: Mapping[str, str | bytes] = field(default_factory=dict)
    suffix: str = ".sdf"


@dataclass(frozen=True, slots=True)
class Code:
    """One diagnostic code.

    Attributes:
        code: `SK-AREA-NNN`.
        severity: "error", "warning", "note" or "stop"; two joined by ", " where it depends.
        meaning: what was found, in general.
        helps: what helps; may be empty.
        example: None only where nothing that a user could write brings it about; `without` then says why.
        without: why there is no example.
    """

    code: str
    severity: str
    meaning: str
    helps: str = ""
    example: Example | None = None
    without: str = ""

    @property
    def area(self) -> str:
        """The middle of the code: `SDF` of `SK-SDF-004`."""
        return self.code.split("-")[1]


@lru_cache(maxsize=1)
def catalogue() -> Mapping[str, Code]:
    """Every code, in order of area and number.

    Raises:
        RuntimeError: a code has two entries.
    """
    found: dict[str, Code] = {}
    for info in pkgutil.iter_modules(__path__):
        if info.name.startswith("_"):
            continue
        codes: tuple[Code, ...] = getattr(importlib.import_module(f"{__name__}.{info.name}"), "CODES", ())
        for code in codes:
            if code.code in found:
                raise RuntimeError(f"{code.code} has two entries; one of them is in simkit/codes/{info.name}.py")
            found[code.code] = code
    return MappingProxyType(dict(sorted(found.items())))
