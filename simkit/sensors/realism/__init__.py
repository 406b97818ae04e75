"""Realism of a run: one option sets all sensors of a world to ideal ones, to their data sheets, or to those of a file.

Input is a world as its file describes it, with all overrides. Output is the same world with other elements in its
`<sensor>`s and plugins. `--set` has priority over all of these elements.
"""

from __future__ import annotations

from simkit.sensors.realism.choice import IDEAL_OR_DATASHEET, Realism, read_realism, realism_sets

__all__ = ["IDEAL_OR_DATASHEET", "Realism", "read_realism", "realism_sets"]
