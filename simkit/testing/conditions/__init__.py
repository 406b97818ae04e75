"""Conditions: expressions over a running simulation, and checks that must hold while it runs.

The text of an expression and a simulation enter; values, and results of checks with the reason, leave. No part of
Python reads or runs an expression, and whoever looks changes no bits.
"""

from __future__ import annotations

from simkit.testing.conditions.checks import CheckResult
from simkit.testing.conditions.condition_watch import Watch
from simkit.testing.conditions.parser import parse

__all__ = ["CheckResult", "Watch", "parse"]
