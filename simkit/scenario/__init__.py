"""Scenarios: a world, what is done in it, what is looked at, and what must hold; in one small file."""

from __future__ import annotations

from simkit.scenario.scenario import NOWHERE, Check, CheckKind, Scenario, Tolerance

__all__ = ["NOWHERE", "Check", "CheckKind", "Scenario", "Tolerance"]
