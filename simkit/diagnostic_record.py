"""Record of one problem of an input: its code, severity, message, file and line."""

from __future__ import annotations

from dataclasses import asdict, dataclass, field
from typing import Final, Literal

from simkit import hidden_text

TEXT_SOURCE: Final = "world given as text"
"""Name of XML that was passed as text, instead of a file name."""
_PYTHON_SOURCE: Final = "given in Python"  # a plugin that was passed as an object has neither file nor line

Severity = Literal["error", "warning", "note"]


@dataclass(frozen=True, slots=True)
class Where:
    """Position in an input file; `file` is None for XML that was passed as text.

    Attributes:
        serial: number of the element in the file, counted from the top; needed to order elements on the same line.
    """

    file: str | None = None
    line: int | None = None
    serial: int = field(default=0, compare=False, repr=False)

    def __str__(self) -> str:
        return f"{self.file or TEXT_SOURCE}:{self.line}" if self.line else (self.file or _PYTHON_SOURCE)


NOWHERE = Where()


@dataclass(frozen=True, slots=True)
class Diagnostic:
    """One problem of an input.

    Attributes:
        code: `SK-AREA-NNN`; never renumbered.
        severity: "error" stops the load, "warning" may change the meaning, "note" is a known conversion.
        message: the problem and the allowed values.
        file: file of the problem, `TEXT_SOURCE` for XML that was passed as text; None if the problem has no place.
        line: line in the file.
        hint: remedy; may be empty.
    """

    code: str
    severity: Severity
    message: str
    file: str | None = None
    line: int | None = None
    hint: str = ""

    def __post_init__(self) -> None:
        if hidden_text.hides(self.message, self.file):
            file, line = hidden_text.place_without_text(self.file, self.line)
            message, hint = hidden_text.message_without_text(self.code)
            for name, value in (("message", message), ("hint", hint), ("file", file), ("line", line)):
                object.__setattr__(self, name, value)

    def __str__(self) -> str:
        place = f"{Where(self.file, self.line)}: " if self.file or self.line else ""
        text = f"{place}{self.severity} {self.code}: {self.message}"
        return f"{text}\n    help: {self.hint}" if self.hint else text

    def as_dict(self) -> dict[str, object]:
        """Return the record as plain data, as `inspect --json` prints it."""
        return asdict(self)
