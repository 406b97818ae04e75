"""Substitution that is a fixed text."""

from __future__ import annotations

from simkit_launch.launch_modules.launch.substitution import TextSubstitution

__all__ = ["TextSubstitution"]
