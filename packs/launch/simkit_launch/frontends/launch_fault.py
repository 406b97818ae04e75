"""Error in one element of a launch file; the reader records it at the place of the element and goes on."""

from __future__ import annotations

from simkit.loaders.xacro.expansion_limits import ExpansionError


class LaunchFault(ExpansionError):
    """Error in one element of a launch file. It is an ExpansionError, so that an evaluator passes it on.

    Attributes:
        code: code of the diagnostic.
        hint: remedy; may be empty.
    """

    def __init__(self, code: str, message: str, hint: str = "") -> None:
        super().__init__(message)
        self.code, self.hint = code, hint
