"""Diagnostic codes of the fit of parameters; `simkit explain CODE` describes each."""

from typing import Final

INVALID_PARAMETER: Final = "SK-FIT-001"
UNKNOWN_PATH: Final = "SK-FIT-002"
NO_COMMANDS: Final = "SK-FIT-003"
NOTHING_COMMON: Final = "SK-FIT-004"
NO_EFFECT: Final = "SK-FIT-005"
NOT_CONVERGED: Final = "SK-FIT-006"
AT_BOUND: Final = "SK-FIT-007"
RUNS_FAILED: Final = "SK-FIT-008"
NOT_TOLD_APART: Final = "SK-FIT-009"
INVALID_OPTION: Final = "SK-FIT-010"
INVALID_MOTION: Final = "SK-FIT-011"
NOT_SMOOTH: Final = "SK-FIT-012"
