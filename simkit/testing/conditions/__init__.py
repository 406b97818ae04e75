"""Conditions without code: expressions over a running simulation, and checks that must hold while it runs."""

from __future__ import annotations

from simkit.testing.conditions.checks import CheckResult
from simkit.testing.conditions.parser import parse
from simkit.testing.conditions.watch import Watch

__all__ = ["CheckResult", "Watch", "parse"]
