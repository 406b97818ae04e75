"""What became of a check."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any, Final

ENDINGS: Final = {
    "duration": "",
    "until": "",
    "timeout": "",
    "wall_timeout": "the run was given up after its wall time",
}
"""How a run ends -> in words, where it did not come to its end."""


@dataclass(frozen=True)
class CheckResult:
    """What became of one check.

    Attributes:
        check: a `simkit.scenario.Check`.
        passed: whether it held.
        message: in words, with the numbers found: why not, or when it was reached.
        time: when it was decided [s] of simulated time.
    """

    check: Any
    passed: bool
    message: str
    time: float


def cut_short(reason: str) -> str:
    """Why a run did not come to its end; empty where it did."""
    return ENDINGS.get(reason, f"the run ended with {reason}")


def clock(time: float) -> str:
    """A simulated time as a report has it."""
    return f"t = {time:.6g} s"
