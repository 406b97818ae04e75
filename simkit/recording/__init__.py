"""Recording and playback of runs: bags, charts, pictures, exported tables and scripted commands.

Files are written completely or not at all. Recording never changes the measurements. This package does not depend on
sensor types, plugins or simkit's commands. The modules are imported on first use.
"""

from __future__ import annotations

from typing import TYPE_CHECKING

from simkit.lazy_names import lazy_attributes

if TYPE_CHECKING:
    from simkit.recording.bags.recorder import Recorder
    from simkit.recording.export import ExportOptions, export_bag

__all__ = ["ExportOptions", "Recorder", "export_bag"]

_MODULES = {
    "simkit.recording.bags.recorder": ("Recorder",),
    "simkit.recording.export": ("ExportOptions", "export_bag"),
}

__getattr__, __dir__ = lazy_attributes(__name__, _MODULES)
