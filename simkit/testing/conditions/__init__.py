"""Conditions: expressions over a running simulation, and checks that must hold while it runs.

The inputs are the text of an expression and a simulation. The results are values and check results with their reasons.
Expressions are never parsed or run as Python code. Evaluating an expression does not change the simulation.
"""

from __future__ import annotations

from simkit.testing.conditions.checks import CheckResult
from simkit.testing.conditions.condition_watch import Watch
from simkit.testing.conditions.parser import parse

__all__ = ["CheckResult", "Watch", "parse"]
