"""Types of remappings, for annotations."""

from __future__ import annotations

from typing import Any

__all__ = ["RemapRule", "RemapRules", "SomeRemapRule", "SomeRemapRules"]

RemapRule = RemapRules = SomeRemapRule = SomeRemapRules = Any
