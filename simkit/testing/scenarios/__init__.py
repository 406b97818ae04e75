"""Scenarios: a world, what is done in it, what is looked at, and what must hold; in one small file."""

from __future__ import annotations

from simkit.run_spec import NO_FILE_POSITION, Check, CheckKind, Scenario, Tolerance

__all__ = ["NO_FILE_POSITION", "Check", "CheckKind", "Scenario", "Tolerance"]
