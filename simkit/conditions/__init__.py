"""Conditions without code: expressions over a running simulation, and checks that must hold while it runs."""

from __future__ import annotations

from simkit.conditions.parser import parse
from simkit.conditions.results import CheckResult
from simkit.conditions.watch import Watch

__all__ = ["CheckResult", "Watch", "parse"]
